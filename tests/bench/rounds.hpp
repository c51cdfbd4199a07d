// Command line argument ROUNDS of the benchmarks.
#pragma once

#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>

namespace glint::bench {

// Returns `usual` without an argument. Returns nothing, and prints one line on stderr, if the
// argument is no number of at least `least`.
[[nodiscard]] inline std::optional<int> rounds_of(int argc, char** argv, int usual, int least) {
  int rounds = usual;
  const bool given = argc == 2;
  const char* const end = given ? argv[1] + std::strlen(argv[1]) : nullptr;
  bool usable = argc <= 2;
  if (given) {
    const auto [last, error] = std::from_chars(argv[1], end, rounds);
    usable = error == std::errc{} && last == end && rounds >= least;
  }
  if (!usable) {
    std::fprintf(stderr, "%s: found ROUNDS %s, expected one number from %d\n", argv[0], argv[1],
                 least);
    return {};
  }
  return rounds;
}

}  // namespace glint::bench

// What a program of the project ends with: 0 done, 1 failed, 2 bad use or input, 3 a device is
// missing; its own verdict, where it comes that far. What went wrong goes to standard error.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>

#include "platform/input_error.hpp"

namespace glint {

// body(): parses by `app`, does the work and gives the program's own verdict.
template <class Body>
[[nodiscard]] int exit_code_of(const CLI::App& app, const char* program, const Body& body) {
  const auto fails = [&](const std::exception& error, int code) {
    std::fprintf(stderr, "%s: %s\n", program, one_line(error.what()).c_str());
    return code;
  };
  try {
    const int code = body();
    // A table that went to a full disk was not printed.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    std::fprintf(stderr, "%s: standard output: not all of it could be written\n", program);
    return std::max(code, 1);
  } catch (const CLI::ParseError& error) {
    // Help asked for is success; anything else is bad use, whatever CLI11 numbers it.
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    return fails(error, 2);
  } catch (const MissingDevice& error) {
    return fails(error, 3);
  } catch (const std::exception& error) {
    return fails(error, 1);
  }
}

}  // namespace glint

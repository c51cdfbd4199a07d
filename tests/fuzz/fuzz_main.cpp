// libFuzzer's entry points: --target=NAME selects the target, --list prints the names.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace glint::fuzz {
namespace {

const Target* chosen = nullptr;

std::array<std::span<const Target>, 4> all_targets() {
  return {text_targets(), file_targets(), recording_targets(), network_targets()};
}

}  // namespace

void expect(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace glint::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  using namespace glint::fuzz;
  std::string_view name;
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument.starts_with("--target=")) name = argument.substr(9);
    if (argument != "--list") continue;
    for (const auto& targets : all_targets()) {
      for (const Target& target : targets) std::printf("%s\n", target.name);
    }
    std::exit(0);
  }
  for (const auto& targets : all_targets()) {
    for (const Target& target : targets) {
      if (name == target.name) chosen = &target;
    }
  }
  if (chosen == nullptr) {
    std::fprintf(stderr, "glint_fuzz: no target \"%.*s\"; expected --target=NAME, see --list\n",
                 static_cast<int>(name.size()), name.data());
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    glint::fuzz::chosen->read({data, size});
  } catch (const glint::InputError& error) {
    const std::string_view message = error.what();
    glint::fuzz::expect(!message.empty() && glint::printable(message) == message,
                        "a message is one clean line");
  }
  return 0;
}

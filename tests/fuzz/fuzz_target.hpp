// A fuzz target: a name and a reader of bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glint::fuzz {

using Bytes = std::span<const std::uint8_t>;

struct Target {
  const char* name;
  // May throw InputError only; a crash, a leak or another exception is a finding.
  void (*read)(Bytes bytes);
};

[[nodiscard]] std::span<const Target> text_targets();
[[nodiscard]] std::span<const Target> file_targets();
[[nodiscard]] std::span<const Target> recording_targets();
[[nodiscard]] std::span<const Target> network_targets();

[[nodiscard]] inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// Aborts the program, which is a finding, unless `holds`.
void expect(bool holds, std::string_view what);

}  // namespace glint::fuzz

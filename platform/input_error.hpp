// Bad use or bad input (exit code 2), and a device or peer that is not there (exit code 3). The
// message names the file, the place in it, what was found and what was expected, in one line.
#pragma once

#include <stdexcept>
#include <string>

#include "platform/printable.hpp"

namespace glint {

// A message holds words of the file: it is cleaned here, so that no reader can forget to. Of a line
// that is too long for a screen the middle is left out.
[[nodiscard]] inline std::string one_line(const std::string& message) {
  constexpr std::size_t k_bytes_max = 2000, k_end = 400;
  if (message.size() <= k_bytes_max) return printable(message);
  return printable(message.substr(0, k_bytes_max - k_end)) + " ... " +
         printable(message.substr(message.size() - k_end));
}

struct InputError : std::runtime_error {
  explicit InputError(const std::string& message) : std::runtime_error(one_line(message)) {}
};

struct MissingDevice : std::runtime_error {
  explicit MissingDevice(const std::string& message) : std::runtime_error(one_line(message)) {}
};

}  // namespace glint

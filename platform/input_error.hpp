// Exceptions for bad use or bad input (exit code 2) and for a missing device or peer (exit code 3).
// The message is one line: the file, the position in it, what was found and what was expected.
#pragma once

#include <stdexcept>
#include <string>

#include "platform/printable.hpp"

namespace glint {

// Returns the message as one printable line, without the middle of a line above k_bytes_max. A
// message may contain text of a file; cleaning it here covers every reader.
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

// Hexadecimal text of frames and bytes, in the format of published test vectors.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/wire/can_frame.hpp"

namespace glint {

inline std::vector<std::uint8_t> bytes_of(std::string_view hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoul(std::string(hex.substr(i, 2)), nullptr, 16)));
  return bytes;
}

inline std::string hex_of(std::span<const std::uint8_t> bytes) {
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    hex += "0123456789ABCDEF"[byte >> 4];
    hex += "0123456789ABCDEF"[byte & 0xF];
  }
  return hex;
}

inline std::vector<std::uint8_t> bytes_of_text(std::string_view text) {
  return {text.begin(), text.end()};
}

// Returns the frame with one bit flipped.
inline CanFrame flipped(CanFrame frame, int bit) {
  auto& byte = frame.data[static_cast<std::size_t>(bit / 8)];
  byte = static_cast<std::uint8_t>(byte ^ 1U << bit % 8);
  return frame;
}

}  // namespace glint

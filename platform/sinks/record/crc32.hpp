// CRC-32 of MCAP, computed by zlib.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>

namespace glint {

// Continues from the result of an earlier call; start with 0.
[[nodiscard]] inline std::uint32_t crc32(std::uint32_t crc,
                                         std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.empty()) return crc;  // zlib would return the initial value for a null pointer
  return static_cast<std::uint32_t>(::crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace glint

// CRC-32 as MCAP uses it, by zlib.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>

namespace glint {

// A call continues where an earlier one ended: start with 0.
[[nodiscard]] inline std::uint32_t crc32(std::uint32_t crc,
                                         std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.empty()) return crc;  // zlib takes a null pointer for a start
  return static_cast<std::uint32_t>(::crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace glint

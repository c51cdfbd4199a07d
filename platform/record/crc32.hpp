// CRC-32 as zlib and MCAP use it. A call continues where an earlier one ended: start with 0.
// Cost: eight table look-ups for 8 bytes. Check value: "123456789" gives CBF43926.
// Source: ISO 3309, reflected polynomial EDB88320; eight bytes at once: Kounavis and Berry 2005.
#pragma once

#include <cstdint>
#include <span>

namespace glint {

[[nodiscard]] std::uint32_t crc32(std::uint32_t crc, std::span<const std::uint8_t> bytes) noexcept;

}  // namespace glint

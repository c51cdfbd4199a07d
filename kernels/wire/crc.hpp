// Cyclic redundancy checks (CRC-8, CRC-16) of AUTOSAR's end-to-end profiles and of CanTSyn.
//
// What:     table-driven CRC over bytes; a step continues from the result of an earlier one.
// Cost:     one table look-up a byte.
// Worst:    the longest frame, 64 bytes and a data identifier: 66 look-ups.
// Accuracy: exact; "123456789" gives 4B, DF and 29B1, see crc_test.cpp.
// Source:   AUTOSAR Specification of CRC Routines: SAE J1850 (polynomial 1D), 8H2F (2F) and
//           CCITT-FALSE (1021).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr std::uint8_t k_crc8_start = 0xFF;
inline constexpr std::uint8_t k_crc8_final_xor = 0xFF;
inline constexpr std::uint16_t k_crc16_start = 0xFFFF;

// Polynomial division without start value and final inversion, because profile 1 uses the first CRC
// without both. crc8_j1850_step(0xFF, bytes) ^ 0xFF is the named CRC.
[[nodiscard]] std::uint8_t crc8_j1850_step(
    std::uint8_t crc, std::span<const std::uint8_t> bytes) noexcept GLINT_NONBLOCKING;
[[nodiscard]] std::uint8_t crc8_h2f_step(
    std::uint8_t crc, std::span<const std::uint8_t> bytes) noexcept GLINT_NONBLOCKING;
[[nodiscard]] std::uint16_t crc16_ccitt_step(
    std::uint16_t crc, std::span<const std::uint8_t> bytes) noexcept GLINT_NONBLOCKING;

[[nodiscard]] std::uint8_t crc8_j1850(std::span<const std::uint8_t> bytes) noexcept
    GLINT_NONBLOCKING;
[[nodiscard]] std::uint8_t crc8_h2f(std::span<const std::uint8_t> bytes) noexcept GLINT_NONBLOCKING;
[[nodiscard]] std::uint16_t crc16_ccitt_false(std::span<const std::uint8_t> bytes) noexcept
    GLINT_NONBLOCKING;

}  // namespace glint

// AUTOSAR end-to-end protection (E2E profiles 1, 2 and 5) of frames by checksum and counter.
//
// It protects the path from here to the receiving program, nothing else.
//
// What:     protect: writes counter and checksum into a frame; check: verifies the checksum.
// Cost:     one CRC over the frame.
// Worst:    a 64-byte frame, 66 table look-ups.
// Accuracy: detects every single flipped bit (Hamming distance of the CRCs), see e2e_test.cpp.
// Source:   AUTOSAR E2E Protocol Specification, profiles P01, P02 and P05, offset 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"

namespace glint {

// How profile 1 includes its 16-bit data identifier.
enum class P01Mode : std::uint8_t {
  both,         // low byte, then high byte
  alternating,  // low byte when the counter is even, high byte when it is odd
  low,          // the low byte alone
  nibble,       // low byte, then a zero; the high byte's low nibble is in byte 1, bits 4..7
};

inline constexpr int k_p01_counters = 15;  // 0..14; 15 is never sent
inline constexpr int k_p02_counters = 16;
inline constexpr int k_p05_counters = 256;

// Byte 0: CRC-8 J1850 without start value and inversion. Byte 1, bits 0..3: counter modulo 15.
// protect_p01 leaves a frame shorter than two bytes unchanged; check_p01 returns false for it and
// for a counter of 15.
void protect_p01(std::span<std::uint8_t> frame, std::uint16_t data_id, P01Mode mode,
                 unsigned counter) noexcept GLINT_NONBLOCKING;
[[nodiscard]] bool check_p01(std::span<const std::uint8_t> frame, std::uint16_t data_id,
                             P01Mode mode) noexcept GLINT_NONBLOCKING;

// Byte 0: CRC-8H2F over bytes 1.. and then data_ids[counter]. Byte 1, bits 0..3: counter modulo 16.
using P02DataIds = std::array<std::uint8_t, k_p02_counters>;
void protect_p02(std::span<std::uint8_t> frame, const P02DataIds& data_ids,
                 unsigned counter) noexcept GLINT_NONBLOCKING;
[[nodiscard]] bool check_p02(std::span<const std::uint8_t> frame,
                             const P02DataIds& data_ids) noexcept GLINT_NONBLOCKING;

// Bytes 0..1: CRC-16 CCITT-FALSE, little endian, over bytes 2.. and then the data identifier, low
// byte first. Byte 2: counter modulo 256. protect_p05 leaves a frame shorter than three bytes
// unchanged; check_p05 returns false for it.
void protect_p05(std::span<std::uint8_t> frame, std::uint16_t data_id,
                 unsigned counter) noexcept GLINT_NONBLOCKING;
[[nodiscard]] bool check_p05(std::span<const std::uint8_t> frame,
                             std::uint16_t data_id) noexcept GLINT_NONBLOCKING;

}  // namespace glint

// SHA-256 hash, used to identify a run's output records.
// Cost: 64 rounds per 64 bytes; no allocation while bytes are added.
// Source: FIPS 180-4, sections 4.1.2, 5.1.1 and 6.2; its test vectors are in sha256_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace glint {

class Sha256 {
 public:
  void add(std::span<const std::uint8_t> bytes) noexcept;
  // Digest of all bytes added so far; more may be added afterwards.
  [[nodiscard]] std::array<std::uint8_t, 32> digest() const noexcept;
  [[nodiscard]] std::string hex() const;  // 64 lower-case digits

 private:
  void compress(const std::uint8_t* block) noexcept;

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace glint

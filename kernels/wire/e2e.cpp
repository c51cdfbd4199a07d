#include "kernels/wire/e2e.hpp"

#include "kernels/wire/crc.hpp"

namespace glint {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t k_p01_header = 2;
constexpr std::size_t k_p05_header = 3;

std::uint8_t low_byte(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); }
std::uint8_t high_byte(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); }
unsigned low_nibble(std::uint8_t byte) { return byte & 0x0FU; }

std::uint8_t with_low_nibble(std::uint8_t byte, unsigned nibble) {
  return static_cast<std::uint8_t>((byte & 0xF0U) | nibble);
}

std::uint8_t p01_crc(Bytes frame, std::uint16_t data_id, P01Mode mode) {
  const std::uint8_t low = low_byte(data_id);
  const std::uint8_t high = high_byte(data_id);
  std::array<std::uint8_t, 2> prefix{low, high};
  std::size_t prefix_length = 2;
  switch (mode) {
    case P01Mode::both:
      break;
    case P01Mode::alternating:
      prefix[0] = low_nibble(frame[1]) % 2 == 0 ? low : high;
      prefix_length = 1;
      break;
    case P01Mode::low:
      prefix_length = 1;
      break;
    case P01Mode::nibble:
      prefix[1] = 0;
      break;
  }
  const std::uint8_t crc = crc8_j1850_step(0, Bytes(prefix).first(prefix_length));
  return crc8_j1850_step(crc, frame.subspan(1));
}

std::uint8_t p02_crc(Bytes frame, const P02DataIds& data_ids) {
  const std::uint8_t crc = crc8_h2f_step(k_crc8_start, frame.subspan(1));
  return crc8_h2f_step(crc, Bytes(&data_ids[low_nibble(frame[1])], 1)) ^ k_crc8_final_xor;
}

std::uint16_t p05_crc(Bytes frame, std::uint16_t data_id) {
  const std::array<std::uint8_t, 2> suffix{low_byte(data_id), high_byte(data_id)};
  return crc16_ccitt_step(crc16_ccitt_step(k_crc16_start, frame.subspan(2)), suffix);
}

}  // namespace

void protect_p01(std::span<std::uint8_t> frame, std::uint16_t data_id, P01Mode mode,
                 unsigned counter) noexcept {
  if (frame.size() < k_p01_header) return;
  frame[1] = with_low_nibble(frame[1], counter % k_p01_counters);
  if (mode == P01Mode::nibble)
    frame[1] =
        static_cast<std::uint8_t>((low_nibble(high_byte(data_id)) << 4) | low_nibble(frame[1]));
  frame[0] = p01_crc(frame, data_id, mode);
}

bool check_p01(std::span<const std::uint8_t> frame, std::uint16_t data_id, P01Mode mode) noexcept {
  if (frame.size() < k_p01_header || low_nibble(frame[1]) >= k_p01_counters) return false;
  const bool nibble_fits = mode != P01Mode::nibble ||
                           (frame[1] >> 4) == static_cast<int>(low_nibble(high_byte(data_id)));
  return nibble_fits && frame[0] == p01_crc(frame, data_id, mode);
}

void protect_p02(std::span<std::uint8_t> frame, const P02DataIds& data_ids,
                 unsigned counter) noexcept {
  if (frame.size() < k_p01_header) return;
  frame[1] = with_low_nibble(frame[1], counter % k_p02_counters);
  frame[0] = p02_crc(frame, data_ids);
}

bool check_p02(std::span<const std::uint8_t> frame, const P02DataIds& data_ids) noexcept {
  return frame.size() >= k_p01_header && frame[0] == p02_crc(frame, data_ids);
}

void protect_p05(std::span<std::uint8_t> frame, std::uint16_t data_id, unsigned counter) noexcept {
  if (frame.size() < k_p05_header) return;
  frame[2] = static_cast<std::uint8_t>(counter % k_p05_counters);
  const std::uint16_t crc = p05_crc(frame, data_id);
  frame[0] = low_byte(crc);
  frame[1] = high_byte(crc);
}

bool check_p05(std::span<const std::uint8_t> frame, std::uint16_t data_id) noexcept {
  if (frame.size() < k_p05_header) return false;
  const std::uint16_t crc = p05_crc(frame, data_id);
  return frame[0] == low_byte(crc) && frame[1] == high_byte(crc);
}

}  // namespace glint

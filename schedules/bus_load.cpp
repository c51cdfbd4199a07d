#include "schedules/bus_load.hpp"

#include <algorithm>
#include <cstdio>

namespace glint {
namespace {

// Five equal bits are followed by a stuff bit, which may start the next five: 1 + (n - 1) / 4.
constexpr int stuff_bits(int bits) { return (bits - 1) / 4; }

// Fields of a classic frame.
constexpr int k_classic_stuffed = 34;           // SOF, identifier, RTR, IDE, r0, DLC, CRC-15
constexpr int k_classic_stuffed_extended = 54;  // 29-bit identifier, SRR, r1 besides
constexpr int k_classic_fixed = 13;  // CRC delimiter, ACK slot and delimiter, EOF 7, intermission 3

// Fields of an FD frame.
constexpr int k_fd_arbitration = 17;           // SOF, identifier, RRS, IDE, FDF, res, BRS
constexpr int k_fd_arbitration_extended = 36;  // 29-bit identifier, SRR besides
constexpr int k_fd_control = 5;                // ESI, DLC
constexpr int k_fd_stuff_count = 4;            // with its parity
constexpr int k_fd_crc_short = 17;             // up to 16 bytes of data
constexpr int k_fd_crc_long = 21;
constexpr int k_fd_short_bytes = 16;
constexpr int k_fd_fixed = 15;  // as classic; CRC delimiter and ACK slot may each be two bits long

CanFrameBits classic_bits(const CanFrameShape& shape) {
  const int stuffed =
      (shape.extended ? k_classic_stuffed_extended : k_classic_stuffed) + 8 * shape.data_bytes;
  return {stuffed + stuff_bits(stuffed) + k_classic_fixed, 0};
}

CanFrameBits fd_bits(const CanFrameShape& shape) {
  const int arbitration = shape.extended ? k_fd_arbitration_extended : k_fd_arbitration;
  const int before_crc = k_fd_control + 8 * shape.data_bytes;
  const int slow_stuff = stuff_bits(arbitration);
  const int fast_stuff = stuff_bits(arbitration + before_crc) - slow_stuff;
  const int checked =
      k_fd_stuff_count + (shape.data_bytes <= k_fd_short_bytes ? k_fd_crc_short : k_fd_crc_long);
  const int fixed_stuff = 1 + checked / 4;  // one before, then one after every four bits
  const int slow = arbitration + slow_stuff + k_fd_fixed;
  const int fast = before_crc + fast_stuff + checked + fixed_stuff;
  return shape.bit_rate_switch ? CanFrameBits{slow, fast} : CanFrameBits{slow + fast, 0};
}

}  // namespace

CanFrameShape shape_of(const CanMessageLayout& message) noexcept {
  const bool fd = is_fd(message.format);
  return {message.bytes, false, fd, fd};
}

CanFrameBits worst_case_bits(const CanFrameShape& shape) noexcept {
  CanFrameShape possible = shape;
  possible.data_bytes = std::clamp(shape.data_bytes, 0, shape.fd ? 64 : 8);
  return shape.fd ? fd_bits(possible) : classic_bits(possible);
}

double worst_case_seconds(const CanFrameShape& shape, const CanBitRates& rates) noexcept {
  const CanFrameBits bits = worst_case_bits(shape);
  return bits.nominal / rates.nominal + (bits.data > 0 ? bits.data / rates.data : 0);
}

CanLoad bus_load(const CanTraffic& traffic, const CanBitRates& rates) noexcept {
  CanLoad load;
  for (const CanMessageLayout& message : k_can_messages) {
    if (!message.sent_in(traffic.format) || message.period_ms == k_can_on_event) continue;
    const double seconds = worst_case_seconds(shape_of(message), rates);
    const bool pose = message.rule == CanIdentifierRule::of_tool;
    const double hz =
        message.period_ms == k_can_each_tick ? traffic.tick_hz : 1e3 / message.period_ms;
    const double frames_hz = pose ? traffic.tools * hz : hz;
    if (pose) load.pose_seconds += seconds;
    load.frames_per_second += frames_hz;
    load.fraction += frames_hz * seconds;
  }
  return load;
}

std::optional<std::string> check_bus_load(const CanTraffic& traffic, const CanBitRates& rates) {
  const bool fd = is_fd(traffic.format);
  if (!(rates.nominal > 0) || (fd && !(rates.data > 0)))
    return "CAN: a bit rate of 0 or less; expected bits per second, e.g. 1000000";
  const CanLoad load = bus_load(traffic, rates);
  if (load.fraction <= 1) return {};
  char text[300];
  std::snprintf(
      text, sizeof text,
      "CAN: %d tool%s at %g Hz in %s frames need %.0f %% of the bus (%.1f ms of each tick's %.1f "
      "ms); expected at most 100 %%: use fewer tools, a lower tick_hz, a higher bit rate%s",
      traffic.tools, traffic.tools == 1 ? "" : "s", traffic.tick_hz, fd ? "FD" : "classic",
      100 * load.fraction, 1e3 * load.fraction / traffic.tick_hz, 1e3 / traffic.tick_hz,
      fd ? "" : " or FD frames");
  return text;
}

}  // namespace glint

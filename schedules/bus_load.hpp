// How long a frame holds the CAN bus at worst, and how much of the bus a cell takes.
//
// What:     bits of a frame with the most stuff bits its fields allow, times the bit rates.
// Cost:     closed form, no loop.
// Worst:    that is what it computes: every stuff bit that can occur does, the intermission counts.
// Accuracy: exact for classic frames; FD is an upper bound (all stuff bits that may fall into the
//           slow phase are put there). Errors and retransmissions are not in it.
// Source:   ISO 11898-1:2015, 10.4 (frames) and 10.5 (stuffing); for classic frames this is Davis,
//           Burns, Bril, Lukkien 2007, eq. (1): 135 bits for 8 bytes and an 11-bit identifier.
#pragma once

#include <optional>
#include <string>

#include "kernels/wire/can_frame.hpp"

namespace glint {

struct CanBitRates {
  double nominal = 1'000'000;  // bit/s: arbitration, and all of a classic frame
  double data = 4'000'000;     // bit/s: the data phase of an FD frame with bit rate switch
};

struct CanFrameShape {
  int data_bytes = 8;     // 0..8, FD to 64
  bool extended = false;  // 29-bit identifier
  bool fd = false;
  bool bit_rate_switch = false;  // FD only
};

struct CanFrameBits {
  int nominal = 0;  // sent at the nominal rate, intermission included
  int data = 0;     // sent at the data rate
};

[[nodiscard]] CanFrameBits worst_case_bits(const CanFrameShape& shape) noexcept;
[[nodiscard]] double worst_case_seconds(const CanFrameShape& shape,
                                        const CanBitRates& rates) noexcept;

// A cell's regular traffic: the poses of its tools at the tick rate, the heartbeat at 10 Hz and the
// pair of time frames at 1 Hz. Emergencies, at changes of state only, are not in it.
struct CanTraffic {
  int tools = 1;
  double tick_hz = 250;
  CanFormat format = CanFormat::classic;
};

struct CanLoad {
  double fraction = 0;  // of the bus' time; above 1 it cannot be sent
  double frames_per_second = 0;
  double pose_seconds = 0;  // from the first to the last bit of one tool's pose on a free bus
};

[[nodiscard]] CanLoad bus_load(const CanTraffic& traffic, const CanBitRates& rates) noexcept;

// Nothing, or why the bus cannot carry the traffic, in one line with the figures and what would
// help. Refused are a load above 100 % and a bit rate that is not positive.
[[nodiscard]] std::optional<std::string> check_bus_load(const CanTraffic& traffic,
                                                        const CanBitRates& rates);

}  // namespace glint

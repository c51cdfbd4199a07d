// Worst-case transmission time of a CAN frame, and the bus load of a cell.
//
// What:     the number of bits with maximum bit stuffing, divided by the bit rates.
// Cost:     closed form; the load: one pass over the table of messages.
// Worst:    computed here: every possible stuff bit occurs, and the intermission counts.
// Accuracy: exact for classic frames; an upper bound for FD (stuff bits that may fall into the slow
//           phase are counted there). Errors and retransmissions are not included.
// Source:   ISO 11898-1:2015, 10.4 (frames) and 10.5 (stuffing); for classic frames this is Davis,
//           Burns, Bril, Lukkien 2007, eq. (1): 135 bits for 8 bytes and an 11-bit identifier.
#pragma once

#include <optional>
#include <string>

#include "kernels/wire/can_messages.hpp"

namespace glint {

struct CanBitRates {
  double nominal = 1'000'000;  // bit/s: arbitration, and the whole classic frame
  double data = 4'000'000;     // bit/s: the data phase of an FD frame with bit rate switch
};

struct CanFrameShape {
  int data_bytes = 8;     // 0..8, FD to 64
  bool extended = false;  // 29-bit identifier
  bool fd = false;
  bool bit_rate_switch = false;  // FD only
};

[[nodiscard]] CanFrameShape shape_of(const CanMessageLayout& message) noexcept;

struct CanFrameBits {
  int nominal = 0;  // sent at the nominal rate, intermission included
  int data = 0;     // sent at the data rate
};

[[nodiscard]] CanFrameBits worst_case_bits(const CanFrameShape& shape) noexcept;
[[nodiscard]] double worst_case_seconds(const CanFrameShape& shape,
                                        const CanBitRates& rates) noexcept;

// Periodic traffic of a cell: the messages of can_messages.hpp that have a period, of each tool at
// the tick rate. Excludes emergency frames, which are sent only at state changes.
struct CanTraffic {
  int tools = 1;
  double tick_hz = 250;
  CanFormat format = CanFormat::classic;
};

struct CanLoad {
  double fraction = 0;  // bus utilisation; above 1 the traffic cannot be sent
  double frames_per_second = 0;
  double pose_seconds = 0;  // first to last bit of one tool's pose on an idle bus
};

[[nodiscard]] CanLoad bus_load(const CanTraffic& traffic, const CanBitRates& rates) noexcept;

// Returns nothing if the bus can carry the traffic. Otherwise returns one line with the values and
// a remedy: for a load above 100 % or a bit rate that is not positive.
[[nodiscard]] std::optional<std::string> check_bus_load(const CanTraffic& traffic,
                                                        const CanBitRates& rates);

}  // namespace glint

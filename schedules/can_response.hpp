// How late each frame on a CAN bus may be, from its nominal release to its last bit.
//
// What:     arbitration by identifier, frames that cannot be interrupted. For a node that always
//           offers its most urgent frame, the q-th frame of a level-m busy period begins after
//             w = B_m + q C_m + sum over more urgent k of ceil((w + J_k + f_k + t_bit) / T_k) C_k
//           and R = max over q of J_m + w - q T_m + C_m; B_m is the longest less urgent frame.
//           A node with a first-in first-out queue is taken as one stream at the level L of its
//           least urgent frame: a frame that comes `a` into a level-L busy period begins after
//             w = B_L + (all that came into the queue by a) - C_m + more urgent frames of others
//           and R = max over a of J_m + w - a + C_m. How long a frame may wait behind others of
//           its queue, f_k = max(w - a), is release jitter to everyone else.
// Cost:     fixed points inside fixed points, each with a declared maximum; then "no bound".
// Worst:    a bus near full load with long queues.
// Accuracy: exact for priority queues but for at most one frame; safe for queues. Errors and
//           retransmissions are not in it.
// Source:   Davis, Burns, Bril, Lukkien 2007, eqs. (3) and (6) to (12); Davis, Kollmann, Pollex,
//           Slomka 2011, section 4 (a queue at the level of its least urgent frame, buffering time
//           f). Where they let no frame wait for the one before it of its own (deadline <= period),
//           `a` runs through the busy period instead, so that no such condition is needed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schedules/bus_load.hpp"

namespace glint {

struct CanMessage {
  std::string name;
  std::uint32_t identifier = 0;
  CanFrameShape shape;
  std::int64_t period_ns = 0;  // or the least gap
  std::int64_t jitter_ns = 0;
  std::int64_t deadline_ns = 0;
  int node = 0;       // who sends it
  bool fifo = false;  // its node sends in the order of queueing; all of the node's are alike
  std::int64_t frame_ns = 0;  // holds the bus so long; 0: from the shape and the bit rates
};

struct CanResponse {
  std::optional<std::int64_t> response_ns;  // nothing: there is no bound
  std::int64_t frame_ns = 0;
  std::int64_t queued_ns = 0;  // f: at most so long behind others of its own queue
};

inline constexpr int k_can_steps_max = 2'000'000;  // of all fixed points of one bus together
inline constexpr int k_can_rounds_max = 100;       // until the queues' waits no longer grow

// Larger is more urgent: the order in which identifiers win arbitration (ISO 11898-1: the first 11
// bits, then a frame with a short identifier before one with a long one, then the rest).
[[nodiscard]] std::uint64_t urgency_of(const CanMessage& message);

// In the order of `messages`.
[[nodiscard]] std::vector<CanResponse> can_responses(const std::vector<CanMessage>& messages,
                                                     const CanBitRates& rates);

[[nodiscard]] double load_of(const std::vector<CanMessage>& messages, const CanBitRates& rates);

}  // namespace glint

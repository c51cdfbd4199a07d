// Worst-case response time of each CAN frame, from its nominal release to its last bit.
//
// What:     non-preemptive arbitration by identifier. For a node that always offers its
//           highest-priority frame, the q-th frame of a level-m busy period starts after
//             w = B_m + q C_m + sum over k in hp(m) of ceil((w + J_k + f_k + t_bit) / T_k) C_k
//           and R = max over q of J_m + w - q T_m + C_m. hp(m): frames of higher priority; B_m:
//           the longest frame of lower priority. A node with a first-in first-out queue is one
//           stream at the level L of its lowest-priority frame. A frame that arrives at `a` in a
//           level-L busy period starts after
//             w = B_L + (all frames queued up to a) - C_m + frames of others in hp(L)
//           and R = max over a of J_m + w - a + C_m. The queueing delay f_k = max(w - a) behind
//           frames of the same queue is release jitter to all other frames.
// Cost:     nested fixed points, each with a declared maximum; beyond it "no bound".
// Worst:    a bus near full load with long queues.
// Accuracy: exact for priority queues but for at most one frame; safe for FIFO queues. Errors and
//           retransmissions are not included.
// Source:   Davis, Burns, Bril, Lukkien 2007, eqs. (3) and (6) to (12); Davis, Kollmann, Pollex,
//           Slomka 2011, section 4 (a queue at the level of its lowest-priority frame, buffering
//           time f). They require deadline <= period, so that no frame waits for its predecessor.
//           Here `a` runs through the busy period instead, and no such condition is needed.
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
  std::int64_t period_ns = 0;  // or the minimum gap
  std::int64_t jitter_ns = 0;
  std::int64_t deadline_ns = 0;
  int node = 0;               // sending node
  bool fifo = false;          // its node sends in FIFO order; the same for all frames of a node
  std::int64_t frame_ns = 0;  // transmission time; 0: from the shape and the bit rates
};

struct CanResponse {
  std::optional<std::int64_t> response_ns;  // nothing: no bound exists
  std::int64_t frame_ns = 0;
  std::int64_t queued_ns = 0;  // f: maximum queueing delay behind frames of its own queue
};

inline constexpr int k_can_steps_max = 2'000'000;  // sum over all fixed points of one bus
inline constexpr int k_can_rounds_max = 100;       // until the queueing delays no longer grow

// Arbitration priority; larger wins (ISO 11898-1: the first 11 bits, then a short identifier before
// a long one, then the rest).
[[nodiscard]] std::uint64_t arbitration_priority(const CanMessage& message);

// In the order of `messages`.
[[nodiscard]] std::vector<CanResponse> can_responses(const std::vector<CanMessage>& messages,
                                                     const CanBitRates& rates);

[[nodiscard]] double load_of(const std::vector<CanMessage>& messages, const CanBitRates& rates);

}  // namespace glint

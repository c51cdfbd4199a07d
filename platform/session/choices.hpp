// The rate groups' numbers, and a release as the recording keeps it.
#pragma once

#include <cstdint>

#include "graph/overrun.hpp"
#include "graph/rate_group.hpp"
#include "graph/ring.hpp"
#include "kernels/image/frame.hpp"
#include "nodes/tokens.hpp"
#include "platform/record/choice_record.hpp"

namespace glint {

inline constexpr std::uint8_t k_frame_group = 0;
inline constexpr std::uint8_t k_tick_group = 1;
inline constexpr std::uint8_t k_background_group = 2;  // of traces; nothing of it is recorded

struct OverrunNote {
  std::uint8_t group = k_frame_group;
  graph::OverrunDecision decision;
};
// From the frame group to the tick group, which sends at most one each tick.
using OverrunNotes = graph::Ring<OverrunNote, 64>;

// What is known of a frame without looking at it; in a run and in its replay alike.
[[nodiscard]] FrameStamp overrun_stamp(const Frame& frame);

[[nodiscard]] ChoiceRecord as_record(const graph::Choice& choice, std::int64_t unix_offset_ns);
[[nodiscard]] graph::Choice as_choice(const ChoiceRecord& record);

}  // namespace glint

// Numbers of the rate groups, and conversion of a release to and from its recorded form.
#pragma once

#include <algorithm>
#include <cstdint>

#include "graph/overrun.hpp"
#include "graph/rate_group.hpp"
#include "graph/ring.hpp"
#include "kernels/image/frame.hpp"
#include "nodes/tokens.hpp"
#include "platform/sinks/record/choice_record.hpp"

namespace glint {

inline constexpr std::uint8_t k_frame_group = 0;
inline constexpr std::uint8_t k_tick_group = 1;
inline constexpr std::uint8_t k_background_group = 2;  // in traces only; not recorded

struct OverrunNote {
  std::uint8_t group = k_frame_group;
  graph::OverrunDecision decision;
};
// From the frame group to the tick group, which sends at most one per tick.
using OverrunNotes = graph::Ring<OverrunNote, 64>;

// Stamp of a frame whose pixels were not processed; the same in a run and in its replay.
[[nodiscard]] inline FrameStamp overrun_stamp(const Frame& frame) {
  return {frame.mid_exposure, frame.stamp_sigma, frame.arrival, frame.sequence, Reason::none};
}

[[nodiscard]] inline ChoiceRecord as_record(const graph::ReleaseInputs& choice,
                                            std::int64_t unix_offset_ns) {
  ChoiceRecord record;
  record.group = static_cast<std::uint8_t>(choice.group);
  record.activation = choice.activation;
  record.nominal = Time{choice.nominal_ns};
  record.version_count = static_cast<std::uint8_t>(choice.version_count);
  std::copy_n(choice.versions.begin(), std::min(choice.version_count, k_recorded_versions),
              record.versions.begin());
  record.unix_offset_ns = unix_offset_ns;
  return record;
}

[[nodiscard]] inline graph::ReleaseInputs as_choice(const ChoiceRecord& record) {
  graph::ReleaseInputs choice;
  choice.group = record.group;
  choice.activation = record.activation;
  choice.nominal_ns = record.nominal.nanoseconds;
  choice.version_count = std::min<int>(record.version_count, k_recorded_versions);
  std::copy_n(record.versions.begin(), choice.version_count, choice.versions.begin());
  return choice;
}

}  // namespace glint

// Why there is no result, or what is wrong with the one there is: one closed list for the whole
// core. It stands in output records and on CAN's error path, so a value never changes its meaning.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint {

enum class Reason : std::uint8_t {
  none = 0,                // all is well
  no_frame_yet = 1,        // nothing has been measured since the start
  too_few_markers = 2,     // fewer candidates in view than a pose needs
  no_labeling = 3,         // markers in view, but no set of them has the tool's distances
  taken_by_other = 4,      // every labeling needs a marker that another tool holds
  degenerate = 5,          // fewer than three distinct points
  collinear = 6,           // the rotation about their line is free
  bad_fit = 7,             // fitted, but the residual is beyond what the noise explains
  frame_late = 8,          // stamped before a frame already processed
  frame_doubled = 9,       // carries a stamp or sequence number already seen
  frame_invalid = 10,      // no usable pixels, size or stamp
  head_pose_missing = 11,  // the pose holds in the camera's frame only
  too_old = 12,            // the newest measurement is older than the limit
  runs_full = 13,          // more runs of bright pixels than the budget; the first ones count
  blobs_full = 14,         // more blobs, or pixels of theirs, than the budget; the best were kept
  search_full = 15,        // the hypothesis budget ended the search; the best so far was kept
  not_prepared = 16,       // the node or table it needs was never prepared
  out_of_range = 17,       // a value does not fit its field and is sent as invalid
  no_reference = 18,       // the robot's frame is not known yet
  // An activation was, or would have been, later than its deadline; by the chain's policy:
  overrun_skipped = 19,    // nothing left for it
  overrun_held = 20,       // what left last leaves again
  overrun_predicted = 21,  // the last known motion goes on
  overrun_stopped = 22,    // everything is declared lost
  tool_changed = 23,       // another tool, or none, is in its place since
  imprecise = 24,          // found, but its standard deviation is above the limit (once `unsure`)
  cloud_full = 25,         // more points or voxels than the capacity; the first ones were kept
  ambiguous = 26,          // found, but another labeling or pose explains the frame nearly as well
};
inline constexpr Reason k_last_reason = Reason::ambiguous;

// Whether it stands for a measurement that was not in time.
[[nodiscard]] constexpr bool is_overrun(Reason reason) {
  return reason >= Reason::overrun_skipped && reason <= Reason::overrun_stopped;
}

// The name as it stands in this list; "unknown" for a value that is not in it.
[[nodiscard]] constexpr std::string_view name_of(Reason reason) {
  constexpr std::string_view names[] = {
      "none",          "no_frame_yet",      "too_few_markers", "no_labeling",  "taken_by_other",
      "degenerate",    "collinear",         "bad_fit",         "frame_late",   "frame_doubled",
      "frame_invalid", "head_pose_missing", "too_old",         "runs_full",    "blobs_full",
      "search_full",   "not_prepared",      "out_of_range",    "no_reference", "overrun_skipped",
      "overrun_held",  "overrun_predicted", "overrun_stopped", "tool_changed", "imprecise",
      "cloud_full",    "ambiguous"};
  const auto i = static_cast<std::size_t>(reason);
  return i < sizeof names / sizeof names[0] ? names[i] : "unknown";
}

}  // namespace glint

// Reason codes: why there is no result, or what is wrong with the result. One closed list for the
// whole core. Output records and CAN error frames carry the value, so a value never changes its
// meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glint {

enum class Reason : std::uint8_t {
  none = 0,                        // no error
  no_frame_yet = 1,                // no measurement since the start
  too_few_markers = 2,             // fewer candidates in view than a pose needs
  no_labeling = 3,                 // markers in view, but no subset has the tool's distances
  markers_assigned_elsewhere = 4,  // every labeling needs a marker assigned to another tool
  degenerate = 5,                  // fewer than three distinct points
  collinear = 6,                   // the rotation about the markers' line is free
  bad_fit = 7,                     // fitted, but the residual fails the chi-square test
  frame_late = 8,                  // time stamp before that of a frame already processed
  frame_duplicate = 9,             // time stamp or sequence number already processed
  frame_invalid = 10,              // no usable pixels, size or time stamp
  head_pose_missing = 11,          // the pose is valid in the camera frame only
  too_old = 12,                    // the newest measurement is older than the limit
  runs_full = 13,     // more runs of pixels than the capacity; the first ones were kept
  blobs_full = 14,    // more blobs, or blob pixels, than the capacity; the best were kept
  search_full = 15,   // the search reached its budget; the best result so far was kept
  not_prepared = 16,  // the required node or table was not prepared
  out_of_range = 17,  // a value does not fit its field and is sent as invalid
  no_reference = 18,  // the robot frame is not estimated yet
  // An activation missed, or would have missed, its deadline. By the overrun policy of the chain:
  overrun_skipped = 19,    // no output
  overrun_held = 20,       // the previous output is published again
  overrun_predicted = 21,  // the last motion estimate is extrapolated
  overrun_stopped = 22,    // every tool is declared lost
  tool_changed = 23,       // the tool in this slot was replaced or removed
  imprecise = 24,          // found, but a standard deviation is above the limit (once `unsure`)
  cloud_full = 25,         // more points or voxels than the capacity; the first ones were kept
  ambiguous = 26,          // found, but another labeling or pose fits the frame nearly as well
};
inline constexpr Reason k_last_reason = Reason::ambiguous;
inline constexpr std::size_t k_reasons = static_cast<std::size_t>(k_last_reason) + 1;

// Returns true for a deadline overrun.
[[nodiscard]] constexpr bool is_overrun(Reason reason) {
  return reason >= Reason::overrun_skipped && reason <= Reason::overrun_stopped;
}

// Returns the enumerator's name; "unknown" for a value outside the list.
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

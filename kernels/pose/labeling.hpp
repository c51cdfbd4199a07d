// Which candidate marker is which of a tool's: the answer of the correspondence search.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct Labeling {
  // marker[i] is the index into Markers of the tool's marker i, -1 where it was not seen.
  std::array<std::int16_t, k_markers_per_tool_max> marker{};
  int count = 0;     // how many are seen, 3 at least
  double rms_m = 0;  // of the rigid fit over them
  // What it is worth that every marker lies where it was predicted, within the gate; else 0. Tools
  // that claim the same markers are compared by count rms^2 less this.
  double predicted_worth_m2 = 0;
  Pose T_camera_tool;  // that fit
};

// The tool's labelings, best first: more markers before fewer, then the smaller rms.
struct Labelings {
  std::array<Labeling, k_labelings_max> items;
  int count = 0;
  std::uint32_t hypotheses = 0;  // partial assignments tried
  Reason reason = Reason::none;  // why there is none, or search_full
};

}  // namespace glint

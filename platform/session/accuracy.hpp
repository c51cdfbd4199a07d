// How good the poses were, against the simulator's truth: at mid-exposure, in the camera's frame.
//
// A frame counts as trackable for a tool with 4 or more of its markers visible, or with 3 while a
// tracked frame is at most lost_after old. tracked_fraction is the part of these that gave a pose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nodes/tokens.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

// What a frame gave for one tool, kept small so that a whole run fits into memory set aside.
struct ToolOutcome {
  bool seen = false;
  Reason reason = Reason::none;
  std::uint8_t marker_mask = 0;
  Pose T_camera_tool;
  bool there = true;  // false: taken out of the set, so that nobody can expect it
};
struct FrameOutcome {
  Reason verdict = Reason::none;  // why the frame itself was refused
  std::array<ToolOutcome, k_tools_max> tools;
};

struct Accuracy {
  std::int64_t frames = 0;     // delivered
  std::int64_t refused = 0;    // late, doubled, invalid
  std::int64_t trackable = 0;  // tool and frame
  std::int64_t tracked = 0;    // of those
  std::int64_t poses = 0;      // all accepted poses, also of frames that were not trackable
  std::int64_t gross = 0;      // further than 20 mm or 15 deg from truth, or no tool there
  double tip_rms_m = 0;
  double tip_max_m = 0;
  double angle_rms_rad = 0;
  std::vector<double> tip_errors_m;  // one for each pose, for histograms
  std::vector<double> angle_errors_rad;
  // The first tool's tip in the true world, for plots: where it was and where it was seen.
  std::vector<Vector3> path_truth_m, path_seen_m;

  [[nodiscard]] double tracked_fraction() const {
    return trackable > 0 ? static_cast<double>(tracked) / static_cast<double>(trackable) : 0.0;
  }
};

// outcomes[i] and truths[i] belong to the i-th frame delivered.
[[nodiscard]] Accuracy judge(const std::vector<FrameOutcome>& outcomes,
                             const std::vector<sim::SimTruth>& truths, const ToolSet& tools,
                             Duration lost_after);

[[nodiscard]] FrameOutcome outcome_of(const Estimates& estimates);

}  // namespace glint

// Results of one method over an experiment: alignment, errors and timing.
#pragma once

#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "kernels/result.hpp"
#include "platform/lab/experiments/alignment.hpp"
#include "platform/lab/experiments/experiment.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

// What a method did in the frames of a run or of several.
struct MethodSamples {
  std::vector<double> position_mm, position_norm_mm, angle_deg, angle_norm_deg;
  // Tip positions in the reference's frame, one per judged frame of the last run; not finite
  // without a pose.
  std::vector<Vector3> path_m;
  double seconds = 0;
  int timed = 0, frames = 0, samples = 0, stated = 0, covered = 0;

  void add_run(const MethodSamples& run);
  [[nodiscard]] MethodFigures figures(const std::string& method) const;
};

// Records one run of one method.
class MethodRecord {
 public:
  // Judges the tool's tip against a reference tracker with noise of its own.
  MethodRecord(const Tool& tool, const sim::ReferenceSettings& reference);

  // Record the result of one frame, while aligning or afterwards: T_world_tip with its covariance
  // (zero if the method states none), or a reason.
  void take_aligning(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                     double seconds);
  void add_evaluated(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                     double seconds);

  [[nodiscard]] const MethodSamples& samples() const { return samples_; }

 private:
  [[nodiscard]] PosePair pair_of(const sim::SimFrame& frame, const Pose& T_world_tip) const;
  void take_time(double seconds);

  Pose T_tool_tip_;
  double reference_variance_m2_ = 0;  // of the tip, per axis
  std::vector<PosePair> aligning_;
  bool aligned_ = false;
  Pose T_reference_world_;
  MethodSamples samples_;
};

}  // namespace glint

// Results of one method over an experiment: alignment, errors and timing.
#pragma once

#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "kernels/result.hpp"
#include "platform/lab/experiments/alignment.hpp"
#include "platform/lab/experiments/experiment.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class MethodRecord {
 public:
  // Judges the tool's tip against a reference tracker with noise of its own.
  MethodRecord(std::string name, const Tool& tool, const sim::ReferenceSettings& reference);

  // Starts a new run with a new alignment.
  void begin_run();
  // Record the result of one frame, while aligning or afterwards: T_world_tip with its covariance
  // (zero if the method states none), or a reason.
  void take_aligning(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                     double seconds);
  void add_evaluated(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                     double seconds);

  [[nodiscard]] MethodFigures figures() const;
  // Tip positions in the reference's frame, one per judged frame of the current run; not finite
  // without a pose.
  [[nodiscard]] const std::vector<Vector3>& path_m() const { return path_m_; }

 private:
  [[nodiscard]] PosePair pair_of(const sim::SimFrame& frame, const Pose& T_world_tip) const;
  void take_time(double seconds);

  std::string name_;
  Pose T_tool_tip_;
  double reference_variance_m2_ = 0;  // of the tip, per axis
  std::vector<PosePair> aligning_;
  bool aligned_ = false;
  Pose T_reference_world_;
  std::vector<double> position_mm_, position_norm_mm_, angle_deg_, angle_norm_deg_;
  std::vector<Vector3> path_m_;
  double seconds_ = 0;
  int timed_ = 0, frames_ = 0, samples_ = 0, stated_ = 0, covered_ = 0;
};

}  // namespace glint

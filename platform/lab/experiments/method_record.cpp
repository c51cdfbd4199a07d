#include "platform/lab/experiments/method_record.hpp"

#include <limits>
#include <utility>

#include "kernels/angles.hpp"

namespace glint {
namespace {

constexpr double k_inside = 7.815;  // chi-square, 3 degrees of freedom, 95 %
constexpr double k_mm = 1000;

}  // namespace

MethodRecord::MethodRecord(std::string name, const Tool& tool,
                           const sim::ReferenceSettings& reference)
    : name_(std::move(name)), T_tool_tip_{Quaternion::Identity(), tool.tip_m} {
  const double by_angle = reference.angle_sigma_rad * tool.tip_m.norm();
  reference_variance_m2_ =
      reference.position_sigma_m * reference.position_sigma_m + by_angle * by_angle;
}

void MethodRecord::begin_run() {
  aligning_.clear();
  path_m_.clear();
  aligned_ = false;
}

PosePair MethodRecord::pair_of(const sim::SimFrame& frame, const Pose& T_world_tip) const {
  return {frame.reference.front() * T_tool_tip_, T_world_tip};
}

void MethodRecord::take_time(double seconds) {
  seconds_ += seconds;
  ++timed_;
}

void MethodRecord::take_aligning(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                                 double seconds) {
  take_time(seconds);
  if (answer && frame.head.valid) aligning_.push_back(pair_of(frame, answer.value.pose));
}

void MethodRecord::add_evaluated(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                                 double seconds) {
  take_time(seconds);
  ++frames_;
  if (!answer || !frame.head.valid) {
    path_m_.emplace_back(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    return;
  }
  if (!aligned_) {
    T_reference_world_ = align_worlds(aligning_);
    aligned_ = true;
  }
  ++samples_;
  const PosePair pair = pair_of(frame, answer.value.pose);
  const PoseError error = pose_error(T_reference_world_, pair);
  if (answer.value.covariance.trace() > 0) {
    const Matrix3 turn = T_reference_world_.rotation.toRotationMatrix();
    const Matrix3 covariance =
        turn * answer.value.covariance.topLeftCorner<3, 3>() * turn.transpose() +
        reference_variance_m2_ * Matrix3::Identity();
    ++stated_;
    covered_ += error.position_m.dot(covariance.inverse() * error.position_m) <= k_inside ? 1 : 0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    position_mm_.push_back(error.position_m[axis] * k_mm);
    angle_deg_.push_back(error.rotation_rad[axis] * k_degrees_per_radian);
  }
  position_norm_mm_.push_back(error.position_m.norm() * k_mm);
  angle_norm_deg_.push_back(error.rotation_rad.norm() * k_degrees_per_radian);
  path_m_.push_back((T_reference_world_ * pair.T_world_tip).translation);
}

MethodFigures MethodRecord::figures() const {
  MethodFigures figures;
  figures.name = name_;
  figures.position_mm = make_error_column(position_mm_, position_norm_mm_);
  figures.angle_deg = make_error_column(angle_deg_, angle_norm_deg_);
  figures.frames_per_s = seconds_ > 0 ? timed_ / seconds_ : 0;
  if (stated_ > 0) figures.covered = static_cast<double>(covered_) / stated_;
  figures.samples = samples_;
  figures.frames = frames_;
  return figures;
}

}  // namespace glint

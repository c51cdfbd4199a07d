#include "platform/lab/experiments/method_record.hpp"

#include <limits>
#include <utility>

#include "kernels/angles.hpp"

namespace glint {
namespace {

constexpr double k_inside = 7.815;  // chi-square, 3 degrees of freedom, 95 %
constexpr double k_mm = 1000;

}  // namespace

void MethodSamples::add_run(const MethodSamples& run) {
  const auto append = [](auto& all, const auto& some) {
    all.insert(all.end(), some.begin(), some.end());
  };
  append(position_mm, run.position_mm);
  append(position_norm_mm, run.position_norm_mm);
  append(angle_deg, run.angle_deg);
  append(angle_norm_deg, run.angle_norm_deg);
  path_m = run.path_m;
  seconds += run.seconds;
  timed += run.timed;
  frames += run.frames;
  samples += run.samples;
  stated += run.stated;
  covered += run.covered;
}

MethodFigures MethodSamples::figures(const std::string& method) const {
  MethodFigures figures;
  figures.name = method;
  figures.position_mm = make_error_column(position_mm, position_norm_mm);
  figures.angle_deg = make_error_column(angle_deg, angle_norm_deg);
  figures.frames_per_s = seconds > 0 ? timed / seconds : 0;
  if (stated > 0) figures.covered = static_cast<double>(covered) / stated;
  figures.samples = samples;
  figures.frames = frames;
  return figures;
}

MethodRecord::MethodRecord(const Tool& tool, const sim::ReferenceSettings& reference)
    : T_tool_tip_{Quaternion::Identity(), tool.tip_m} {
  const double by_angle = reference.angle_sigma_rad * tool.tip_m.norm();
  reference_variance_m2_ =
      reference.position_sigma_m * reference.position_sigma_m + by_angle * by_angle;
}

PosePair MethodRecord::pair_of(const sim::SimFrame& frame, const Pose& T_world_tip) const {
  return {frame.reference.front() * T_tool_tip_, T_world_tip};
}

void MethodRecord::take_time(double seconds) {
  samples_.seconds += seconds;
  ++samples_.timed;
}

void MethodRecord::take_aligning(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                                 double seconds) {
  take_time(seconds);
  if (answer && frame.head.valid) aligning_.push_back(pair_of(frame, answer.value.pose));
}

void MethodRecord::add_evaluated(const sim::SimFrame& frame, const Result<UncertainPose>& answer,
                                 double seconds) {
  take_time(seconds);
  ++samples_.frames;
  if (!answer || !frame.head.valid) {
    samples_.path_m.emplace_back(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    return;
  }
  if (!aligned_) {
    T_reference_world_ = align_worlds(aligning_);
    aligned_ = true;
  }
  ++samples_.samples;
  const PosePair pair = pair_of(frame, answer.value.pose);
  const PoseError error = pose_error(T_reference_world_, pair);
  if (answer.value.covariance.trace() > 0) {
    const Matrix3 turn = T_reference_world_.rotation.toRotationMatrix();
    const Matrix3 covariance =
        turn * answer.value.covariance.topLeftCorner<3, 3>() * turn.transpose() +
        reference_variance_m2_ * Matrix3::Identity();
    ++samples_.stated;
    samples_.covered +=
        error.position_m.dot(covariance.inverse() * error.position_m) <= k_inside ? 1 : 0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    samples_.position_mm.push_back(error.position_m[axis] * k_mm);
    samples_.angle_deg.push_back(error.rotation_rad[axis] * k_degrees_per_radian);
  }
  samples_.position_norm_mm.push_back(error.position_m.norm() * k_mm);
  samples_.angle_norm_deg.push_back(error.rotation_rad.norm() * k_degrees_per_radian);
  samples_.path_m.push_back((T_reference_world_ * pair.T_world_tip).translation);
}

}  // namespace glint

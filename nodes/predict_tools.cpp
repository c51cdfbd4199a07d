#include "nodes/predict_tools.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/motion/predict_motion.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// Transforms a pose, its velocities and its covariances from `base` to `frame`.
void express(const Pose& T_frame_base, MovingPose& moving, Matrix6& covariance,
             Matrix6& systematic) {
  moving.pose = T_frame_base * moving.pose;
  moving.velocity_m_s = T_frame_base.rotation * moving.velocity_m_s;
  moving.angular_velocity_rad_s = T_frame_base.rotation * moving.angular_velocity_rad_s;
  covariance = rotated_covariance(covariance, T_frame_base.rotation);
  systematic = rotated_covariance(systematic, T_frame_base.rotation);
}

double axis_sigma(const Matrix6& covariance, int first) {
  const double trace = covariance(first, first) + covariance(first + 1, first + 1) +
                       covariance(first + 2, first + 2);
  return std::sqrt(trace > 0 ? trace / 3.0 : 0.0);
}

}  // namespace

bool has_robot_pose(const RobotFrame& robot, const Estimates& estimates) noexcept {
  const bool registered =
      robot.state == RegistrationState::given || robot.state == RegistrationState::accepted;
  return registered && (!robot.in_reference || estimates.has_reference);
}

Pose robot_in_world(const RobotFrame& robot, const Estimates& estimates) noexcept {
  return robot.in_reference ? estimates.T_world_reference * robot.T_world_robot
                            : robot.T_world_robot;
}

void write_tip(const CentroidEstimate& centroid, const Pose* T_base_robot,
               const Matrix6& robot_covariance, const TipPosition& tip,
               PoseSample& sample) noexcept {
  MovingPose moving = centroid.moving;
  Matrix6 covariance = centroid.covariance;
  Vector6 twist;
  twist << moving.velocity_m_s, moving.angular_velocity_rad_s;
  sample.age_sigma_s = std::sqrt(centroid.stamp_s2);
  Matrix6 systematic =
      centroid.systematic + centroid.stamp_s2 * twist.lazyProduct(twist.transpose());
  if (T_base_robot != nullptr) {
    systematic +=
        moved_covariance(robot_covariance, moving.pose.translation - T_base_robot->translation);
    express(T_base_robot->inverse(), moving, covariance, systematic);
  }
  const Vector3 arm = moving.pose.rotation * tip.arm_m;
  systematic = tip.systematic_of(systematic, moving.pose.rotation);
  covariance = moved_covariance(covariance, arm) + systematic;
  sample.pose = {moving.pose.rotation, moving.pose.translation + arm};
  sample.velocity_m_s = moving.velocity_m_s + moving.angular_velocity_rad_s.cross(arm);
  sample.angular_velocity_rad_s = moving.angular_velocity_rad_s;
  sample.covariance = covariance;
  sample.systematic = systematic;
  sample.sigma_position_m = axis_sigma(covariance, 0);
  sample.sigma_orientation_rad = axis_sigma(covariance, 3);
}

void PredictTools::operator()(const Now& now, const graph::Latest<Estimates>& estimates,
                              const graph::Latest<RobotFrame>& robot,
                              const graph::Latest<PenButtons>& buttons,
                              PoseSamples& samples) noexcept {
  const Estimates& estimates_now = estimates.value();
  samples.count = std::min(estimates_now.tool_count, limits.tools);
  samples.any_frame = estimates.version() > 0;
  samples.newest_frame = estimates_now.verdict.stamp.arrival;
  counts_ = {{1, samples.count}};
  for (int t = 0; t < samples.count; ++t) {
    const Track& track = estimates_now.tracks[t];
    PoseSample& sample = samples.items[t];
    sample = PoseSample{};
    sample.tick = now.tick;
    sample.tick_number = now.number;
    sample.tool = static_cast<std::uint8_t>(t);
    sample.buttons = buttons.value().of_tool(t);
    sample.reason = track.reason;
    sample.registration = robot.value().state;
    sample.registration_rms_m = robot.value().rms_m;
    if (!track.alive || track.unconfirmed) {
      sample.state = track.reason == Reason::no_frame_yet ? TrackState::none : TrackState::lost;
      continue;
    }
    sample.measurement = track.newest.time;
    sample.frame_sequence = track.frame_sequence;
    const Duration age = now.tick - track.newest.time;
    if (age > settings.lost_after) {
      sample.state = TrackState::lost;
      if (sample.reason == Reason::none) sample.reason = Reason::too_old;
      continue;
    }
    const bool fresh =
        !is_overrun(track.reason) && 2 * age.nanoseconds <= 3 * settings.nominal_gap.nanoseconds;
    sample.state = fresh ? TrackState::measured : TrackState::predicted;
    sample.marker_mask = track.marker_mask;

    const Time when = now.tick + settings.actuation_delay;
    ++counts_[graph::loop_of<PredictTools>("poses")];
    CentroidEstimate centroid;
    centroid.moving = integrator_.after(track.motion, when - track.motion.time).value;
    centroid.covariance =
        predict_pose(track.motion, when, settings.motion, track.noise).covariance +
        track.head_covariance;
    centroid.systematic = track.calibration_covariance + track.correlated_covariance;
    const double clock_s = track.stamp_sigma.seconds();
    centroid.stamp_s2 = settings.stamp_sigma_s * settings.stamp_sigma_s + clock_s * clock_s;
    sample.frame = track.base;
    Pose T_world_robot;
    bool in_robot = false;
    if (track.base == ReferenceFrame::camera) {
      if (sample.reason == Reason::none) sample.reason = Reason::head_pose_missing;
    } else if (has_robot_pose(robot.value(), estimates_now)) {
      T_world_robot = robot_in_world(robot.value(), estimates_now);
      in_robot = true;
      sample.frame = ReferenceFrame::robot;
    } else if (sample.reason == Reason::none) {
      sample.reason = Reason::no_reference;
    }
    write_tip(centroid, in_robot ? &T_world_robot : nullptr, settings.robot_covariance,
              estimates_now.tips[static_cast<std::size_t>(t)], sample);
  }
}

}  // namespace glint

#include "nodes/predict_tools.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

struct Aged {
  Pose pose;  // T_base_tool at the actuation time
  Vector3 velocity_m_s = Vector3::Zero();
  Vector3 angular_velocity_rad_s = Vector3::Zero();
};

Aged at(const Track& track, Time when, Duration horizon) {
  Aged aged{track.newest.pose};
  if (!track.has_previous) return aged;
  aged.pose = extrapolate(track.previous, track.newest, when, horizon);
  const Velocity velocity = velocity_between(track.previous, track.newest);
  aged.velocity_m_s = velocity.linear_m_s;
  aged.angular_velocity_rad_s = velocity.angular_rad_s;
  return aged;
}

// Moves a pose and its covariance from base to the frame that `T_frame_base` leads to.
void express(const Pose& T_frame_base, Aged& aged, Matrix6& covariance) {
  aged.pose = T_frame_base * aged.pose;
  aged.velocity_m_s = T_frame_base.rotation * aged.velocity_m_s;
  aged.angular_velocity_rad_s = T_frame_base.rotation * aged.angular_velocity_rad_s;
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = T_frame_base.rotation.toRotationMatrix();
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  covariance = turn * covariance * turn.transpose();
}

double axis_sigma(const Matrix6& covariance, int first) {
  const double trace = covariance(first, first) + covariance(first + 1, first + 1) +
                       covariance(first + 2, first + 2);
  return std::sqrt(trace > 0 ? trace / 3.0 : 0.0);
}

// The tip's covariance `lead` seconds on: both poses that the velocity rests on are as uncertain as
// the newest, so position error grows to (1 + r)^2 + r^2 times its variance with r = lead / gap.
double growth(const Track& track, Time when) {
  if (!track.has_previous) return 1.0;
  const double gap = (track.newest.time - track.previous.time).seconds();
  const double r = gap > 0 ? (when - track.newest.time).seconds() / gap : 0.0;
  return r > 0 ? (1 + r) * (1 + r) + r * r : 1.0;
}

}  // namespace

void PredictTools::operator()(const Now& now, const graph::Latest<Estimates>& estimates,
                              const graph::Latest<RobotFrame>& robot,
                              PoseSamples& samples) noexcept {
  const Estimates& known = estimates.value();
  samples.count = std::min(known.tool_count, limits.tools);
  counts_ = {{1, samples.count}};
  for (int t = 0; t < samples.count; ++t) {
    const Track& track = known.tracks[t];
    PoseSample& sample = samples.items[t];
    sample = PoseSample{};
    sample.tick = now.tick;
    sample.tick_number = now.number;
    sample.tool = static_cast<std::uint8_t>(t);
    sample.reason = track.reason;
    sample.registration = robot.value().state;
    sample.registration_rms_m = robot.value().rms_m;
    if (!track.alive) {
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
    ++counts_[2];
    if (track.has_previous) ++counts_[3];
    Aged aged = at(track, when, settings.lost_after);
    Matrix6 covariance = track.covariance * growth(track, when);
    sample.frame = track.base;
    if (track.base == ReferenceFrame::camera) {
      if (sample.reason == Reason::none) sample.reason = Reason::head_pose_missing;
    } else if (robot.value().state == RegistrationState::given ||
               robot.value().state == RegistrationState::accepted) {
      express(robot.value().T_world_robot.inverse(), aged, covariance);
      sample.frame = ReferenceFrame::robot;
    } else if (sample.reason == Reason::none) {
      sample.reason = Reason::no_reference;
    }

    const Vector3 arm = aged.pose.rotation * known.tip_m[t];
    sample.pose = {aged.pose.rotation, aged.pose.translation + arm};
    sample.velocity_m_s = aged.velocity_m_s + aged.angular_velocity_rad_s.cross(arm);
    sample.angular_velocity_rad_s = aged.angular_velocity_rad_s;
    sample.covariance = covariance;
    sample.sigma_position_m = axis_sigma(covariance, 0);
    sample.sigma_orientation_rad = axis_sigma(covariance, 3);
  }
}

}  // namespace glint

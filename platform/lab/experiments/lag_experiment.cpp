#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/point_run.hpp"

namespace glint {
namespace {

constexpr double k_speed_m_s = 0.5, k_turn_rad_s = 90 / k_degrees_per_radian;
constexpr double k_lag_tilt_rad = 30 / k_degrees_per_radian;
constexpr int k_still_frames = 90;   // 2 s
constexpr int k_moving_frames = 28;  // 0.6 s: then the tool is at its least distance
constexpr int k_lag_runs = 1000, k_lag_quick_runs = 40;

// Error sums by frame after the start, in axes whose first is the run's direction of motion.
struct FrameErrors {
  Vector6 sum = Vector6::Zero(), squares = Vector6::Zero();
};
using LagErrors = std::array<FrameErrors, k_moving_frames>;

void one_start(const std::vector<Vector3>& model, const PointNoise& noise, LagErrors& errors) {
  const PointCamera camera;
  ToolMotion motion;
  motion.settings = EstimatorSettings{}.motion;
  const Pose start = held_pose(k_lag_tilt_rad, noise.seed, noise.run);
  const Vector3 ahead = direction(noise.seed, noise.run, 1);
  const Vector3 axis = direction(noise.seed, noise.run, 2);
  const Quaternion along = rotation_between(ahead, Vector3::UnitX());
  const Quaternion about = rotation_between(axis, Vector3::UnitX());
  for (int frame = 0; frame < k_still_frames + k_moving_frames; ++frame) {
    const int moving = frame - k_still_frames;
    const double seconds = std::max((frame_time(moving) - Time{}).seconds(), 0.0);
    const Pose truth{
        (from_rotation_vector(seconds * k_turn_rad_s * axis) * start.rotation).normalized(),
        start.translation + seconds * k_speed_m_s * ahead};
    Result<UncertainPose> measured =
        measure(camera, model, truth, noise, static_cast<std::uint64_t>(frame));
    if (!measured) continue;
    measured.value.time = frame_time(frame);
    if (motion.update(measured.value) != Reason::none || moving < 0) continue;
    const Vector6 fixed = pose_difference(motion.estimate().pose, truth);
    Vector6 error;
    error << along * fixed.head<3>(), about * fixed.tail<3>();
    errors[static_cast<std::size_t>(moving)].sum += error;
    errors[static_cast<std::size_t>(moving)].squares += error.cwiseAbs2();
  }
}

struct Worst {
  double mean_mm = 0, mean_deg = 0;  // length of the mean error: the lag
  double rms_mm = 0, rms_deg = 0;    // with the noise of each run
};

// Largest errors from `seconds` after the start on.
Worst worst_after(const LagErrors& errors, double seconds, int runs) {
  Worst worst;
  for (int frame = 0; frame < k_moving_frames; ++frame) {
    if ((frame_time(frame) - Time{}).seconds() < seconds) continue;
    const auto& [sum, squares] = errors[static_cast<std::size_t>(frame)];
    worst.mean_mm = std::max(worst.mean_mm, 1000 * sum.head<3>().norm() / runs);
    worst.mean_deg = std::max(worst.mean_deg, k_degrees_per_radian * sum.tail<3>().norm() / runs);
    worst.rms_mm = std::max(worst.rms_mm, 1000 * std::sqrt(squares.head<3>().sum() / runs));
    worst.rms_deg =
        std::max(worst.rms_deg, k_degrees_per_radian * std::sqrt(squares.tail<3>().sum() / runs));
  }
  return worst;
}

ExperimentCase start_case(const CaseOptions& options, const std::string& name, double noise_share,
                          double after_s, std::array<double, 2> limits) {
  const int runs = options.quick ? k_lag_quick_runs : k_lag_runs;
  const std::vector<Vector3> model = tool_8700339();
  const LagErrors errors = options.piece([&] {
    LagErrors sums;
    for (int run = 0; run < runs; ++run) {
      one_start(model, {noise_share, options.seed, static_cast<std::uint64_t>(run)}, sums);
      if (options.progress) options.progress(run + 1, runs);
    }
    return sums;
  });
  const Worst worst = worst_after(errors, after_s, runs);
  const auto bar = [&](double limit) {
    return options.quick && noise_share > 0 ? Bar::none() : Bar::at_most(limit);
  };
  return {name,
          "glint",
          runs,
          {{"mean_error", "mm", worst.mean_mm, bar(limits[0])},
           {"mean_rotation_error", "deg", worst.mean_deg, bar(limits[1])},
           {"error_rms", "mm", worst.rms_mm, {}},
           {"rotation_rms", "deg", worst.rms_deg, {}}}};
}

}  // namespace

CaseList run_lag(const CaseOptions& options) {
  CaseList list{"lag", {}, {}};
  list.cases.push_back(
      start_case(options, "1 mm, 0.3 s after the start or later", 1, 0.3, {0.5, 0.2}));
  list.cases.push_back(start_case(options, "noise-free, 0.5 s after or later", 0, 0.5, {0.2, 0.1}));
  return list;
}

}  // namespace glint

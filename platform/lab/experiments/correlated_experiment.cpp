// Experiment `correlated`: noise model of static real tools with correlated errors, and consistency
// of the filter's covariance under it.
//
// The relative poses of two static tools before a HoloLens 2 (hl2_real) give the model (`glint
// calibrate noise`). Judged are the model's Allan deviation; the filter on the series itself, whose
// mean is the ground truth; and the filter on series that the model generates, each against its
// ground truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "kernels/angles.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/formats/trajectory.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/noise.hpp"

namespace glint {
namespace {

constexpr int k_runs = 100, k_runs_quick = 4;
constexpr double k_run_s = 200, k_warm_up_s = 3;
constexpr double k_chi_square_95 = 7.814728;  // 3 degrees of freedom
// A white part of zero has no inverse.
constexpr double k_white_min_m = 1e-5, k_white_min_rad = 1e-5;
constexpr std::array<double, 4> k_judged_s = {0.2, 1, 5, 20};

struct StaticModel {
  NoiseCalibration noise;
  Matrix6 white = Matrix6::Zero();
  CorrelatedErrors correlated;

  explicit StaticModel(NoiseCalibration of) : noise(std::move(of)) {
    for (Eigen::Index k = 0; k < 6; ++k) {
      const AxisNoise& axis = noise.axes[static_cast<std::size_t>(k)];
      const double least = k < 3 ? k_white_min_m : k_white_min_rad;
      white(k, k) = std::max(axis.white * axis.white, least * least);
      correlated.fast(k, k) = axis.fast * axis.fast;
      correlated.slow(k, k) = axis.slow * axis.slow;
    }
  }
};

struct StaticErrors {
  std::int64_t n = 0, inside_position = 0, inside_rotation = 0;
  double nees = 0, square_m2 = 0, stated_m2 = 0;

  void add(const ToolMotion& motion, const Pose& truth) {
    const UncertainPose found = pose_of(motion.estimate());
    const Matrix6 total = found.covariance + motion.correlated_covariance();
    const Vector6 error = pose_difference(found.pose, truth);
    const Matrix3 position = total.topLeftCorner<3, 3>();
    const Matrix3 rotation = total.bottomRightCorner<3, 3>();
    ++n;
    nees += Cholesky<6>(total).squared_length(error) / 6;
    inside_position += Cholesky<3>(position).squared_length(error.head<3>()) <= k_chi_square_95;
    inside_rotation += Cholesky<3>(rotation).squared_length(error.tail<3>()) <= k_chi_square_95;
    square_m2 += error.head<3>().squaredNorm();
    stated_m2 += position.trace();
  }
  void add(const StaticErrors& other) {
    n += other.n;
    inside_position += other.inside_position;
    inside_rotation += other.inside_rotation;
    nees += other.nees;
    square_m2 += other.square_m2;
    stated_m2 += other.stated_m2;
  }
  [[nodiscard]] double percent(std::int64_t part) const {
    return 100 * static_cast<double>(part) / static_cast<double>(n);
  }
};

std::unique_ptr<ToolMotion> filter_for(const StaticModel& model) {
  auto motion = std::make_unique<ToolMotion>();
  motion->settings.rest.correlation = model.noise.correlation;
  return motion;
}

// Runs the filter on a static pose with errors and covariance of the model.
StaticErrors generated_run(const StaticModel& model, double period_s, std::uint64_t seed,
                           std::uint64_t run) {
  StaticErrors judged;
  const auto motion = filter_for(model);
  const sim::RandomKey key{seed, sim::Stream::reference, run};
  const Pose truth{Quaternion::Identity(), {0.1, 0.05, 0.5}};
  const int frames = static_cast<int>(k_run_s / period_s);
  const double keep_fast = std::exp(-period_s / model.noise.correlation.fast_s);
  const double keep_slow = std::exp(-period_s / model.noise.correlation.slow_s);
  std::array<double, k_pose_axes> fast{}, slow{};
  std::uint64_t drawn = 0;
  for (int frame = 0; frame < frames; ++frame) {
    Vector6 error;
    for (std::size_t k = 0; k < k_pose_axes; ++k) {
      const AxisNoise& axis = model.noise.axes[k];
      const auto step = [&](double keep, double& state) {
        const double next = sim::gaussian(key, drawn++);
        state = frame == 0 ? next : keep * state + std::sqrt(1 - keep * keep) * next;
        return state;
      };
      error(static_cast<Eigen::Index>(k)) = axis.fast * step(keep_fast, fast[k]) +
                                            axis.slow * step(keep_slow, slow[k]) +
                                            axis.white * sim::gaussian(key, drawn++);
    }
    const Time time{static_cast<std::int64_t>(1e9 * period_s * frame)};
    const Pose seen{from_rotation_vector(error.tail<3>()) * truth.rotation,
                    truth.translation + error.head<3>()};
    if (motion->update({time, seen, model.white}, model.correlated) != Reason::none) continue;
    if (frame * period_s > k_warm_up_s) judged.add(*motion, truth);
  }
  return judged;
}

// Mean pose of the series, from small deviations from its first pose.
Pose mean_pose(const std::vector<TimedPose>& poses) {
  Vector6 sum = Vector6::Zero();
  const Pose& first = poses.front().pose;
  for (const TimedPose& pose : poses) sum += pose_difference(pose.pose, first);
  sum /= static_cast<double>(poses.size());
  return {from_rotation_vector(sum.tail<3>()) * first.rotation, first.translation + sum.head<3>()};
}

Bar within_bars(double low, double high, double value) {
  return value < low ? Bar::at_least(low) : Bar::at_most(high);
}

ExperimentCase judged_case(const std::string& name, const StaticErrors& judged, bool of_coverage,
                           bool quick) {
  const double position = judged.percent(judged.inside_position);
  const double rotation = judged.percent(judged.inside_rotation);
  const double nees = judged.nees / static_cast<double>(judged.n);
  const auto coverage = [&](double value) {
    return of_coverage && !quick ? within_bars(92, 98, value) : Bar::none();
  };
  return {name,
          "glint",
          judged.n,
          {{"coverage_position", "%", position, coverage(position)},
           {"coverage_rotation", "%", rotation, coverage(rotation)},
           {"nees_by_6", "", nees, of_coverage ? Bar::none() : within_bars(0.3, 2, nees)},
           {"stated_by_rms", "", std::sqrt(judged.stated_m2 / judged.square_m2), {}}}};
}

// Allan deviation at the judged averaging times, each from the nearest window.
ExperimentCase allan_case(const NoiseCalibration& noise) {
  ExperimentCase out{"Allan deviation, model by measured", "glint", noise.poses, {}};
  for (const double seconds : k_judged_s) {
    const auto nearest = std::min_element(
        noise.allan.begin(), noise.allan.end(), [&](const AllanPoint& a, const AllanPoint& b) {
          return std::abs(std::log(a.seconds / seconds)) < std::abs(std::log(b.seconds / seconds));
        });
    double worst = 1;
    for (std::size_t k = 0; k < k_pose_axes; ++k) {
      const double factor = nearest->model[k] / nearest->measured[k];
      worst = std::max({worst, factor, 1 / factor});
    }
    char name[48];
    std::snprintf(name, sizeof name, "worst_factor_at_%g_s", seconds);
    out.figures.push_back({name, "", worst, Bar::at_most(1.5)});
  }
  return out;
}

}  // namespace

CaseList run_correlated(const CaseOptions& options) {
  const auto series = [&](const char* tool) {
    const Trajectory loaded =
        load_trajectory(options.data + "/hl2_real/rest_hl2_tool_" + tool + ".tum");
    std::vector<TimedPose> poses = loaded.samples;
    for (TimedPose& pose : poses) pose.time = loaded.begin + (pose.time - Time{});
    return poses;
  };
  std::vector<TimedPose> poses = relative_poses(series("a"), series("b"), milliseconds(20));
  const StaticModel model(calibrate_noise(poses, "hl2_real"));
  CaseList list{"correlated", {allan_case(model.noise)}, {}};

  StaticErrors real;
  const auto motion = filter_for(model);
  const Pose truth = mean_pose(poses);
  for (const TimedPose& pose : poses) {
    if (motion->update({pose.time, pose.pose, model.white}, model.correlated) == Reason::none)
      real.add(*motion, truth);
  }
  list.cases.push_back(judged_case("two real tools at rest", real, false, options.quick));

  const int runs = options.quick ? k_runs_quick : k_runs;
  int done = 0;
  for (const double period_s : {0.2, 1.0 / 45}) {
    StaticErrors judged;
    for (int run = 0; run < runs; ++run) {
      judged.add(options.piece([&] {
        return generated_run(model, period_s, options.seed, static_cast<std::uint64_t>(run));
      }));
      if (options.progress) options.progress(++done, 2 * runs);
    }
    char name[64];
    std::snprintf(name, sizeof name, "generated by the model, %.0f Hz", 1 / period_s);
    list.cases.push_back(judged_case(name, judged, true, options.quick));
  }
  return list;
}

}  // namespace glint

#include <array>
#include <cmath>
#include <string>

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/point_run.hpp"
#include "platform/sim/motion.hpp"

namespace glint {
namespace {

constexpr double k_stroke_m = 0.1, k_stroke_rad = 40 / k_degrees_per_radian, k_stroke_s = 0.7;
constexpr double k_stop_s = 1.0;
constexpr std::array<double, 2> k_after_s = {0.5, 2.0};
constexpr int k_rest_frames = 138;  // to just over 2 s after the stop
constexpr int k_rest_runs = 1000, k_rest_quick_runs = 40;

struct RestBars {
  double tilt_deg;
  std::array<double, 2> rotation_deg;
};
constexpr std::array<double, 2> k_position_mm = {0.15, 0.075};
constexpr std::array<RestBars, 3> k_cases = {
    {{0, {0.35, 0.20}}, {25, {0.25, 0.12}}, {45, {0.25, 0.12}}}};

struct Sums {
  double position = 0, rotation = 0;
  void add(const UncertainPose& estimate, const Pose& truth) {
    const Vector6 error = pose_difference(estimate.pose, truth);
    position += error.head<3>().squaredNorm();
    rotation += error.tail<3>().squaredNorm();
  }
  void add(const Sums& other) {
    position += other.position;
    rotation += other.rotation;
  }
  [[nodiscard]] double position_mm(int n) const { return 1000 * std::sqrt(position / n); }
  [[nodiscard]] double rotation_deg(int n) const {
    return k_degrees_per_radian * std::sqrt(rotation / n);
  }
};

struct Results {
  std::array<Sums, 2> glint;
  Sums single;  // the last frame alone

  void add(const Results& other) {
    for (std::size_t i = 0; i < glint.size(); ++i) glint[i].add(other.glint[i]);
    single.add(other.single);
  }
};

// One stroke that ends smoothly in the held pose, then rest.
Results one_run(const std::vector<Vector3>& model, double tilt_rad, const PointNoise& noise) {
  Results results;
  const PointCamera camera;
  ToolMotion motion;
  motion.settings = EstimatorSettings{}.motion;
  const Pose held = held_pose(tilt_rad, noise.seed, noise.run);
  const Vector3 from = k_stroke_m * direction(noise.seed, noise.run, 1);
  const Vector3 turned = k_stroke_rad * direction(noise.seed, noise.run, 2);
  std::size_t taken = 0;
  for (int frame = 0; frame < k_rest_frames; ++frame) {
    const Time time = frame_time(frame);
    const double seconds = (time - Time{}).seconds();
    const double left = 1 - sim::smooth_step(seconds, k_stop_s - k_stroke_s, k_stroke_s);
    const Pose truth{(from_rotation_vector(left * turned) * held.rotation).normalized(),
                     held.translation + left * from};
    Result<UncertainPose> measured =
        measure(camera, model, truth, noise, static_cast<std::uint64_t>(frame));
    if (!measured) continue;
    measured.value.time = time;
    if (motion.update(measured.value) != Reason::none) continue;
    if (taken == k_after_s.size() || seconds < k_stop_s + k_after_s[taken]) continue;
    results.glint[taken++].add(pose_of(motion.estimate()), truth);
    if (taken == k_after_s.size()) results.single.add(measured.value, truth);
  }
  return results;
}

}  // namespace

CaseList run_static_tool(const CaseOptions& options) {
  const int runs = options.quick ? k_rest_quick_runs : k_rest_runs;
  const std::vector<Vector3> model = tool_8700339();
  CaseList list{"rest", {}, {}};
  int done = 0;
  for (const RestBars& bars : k_cases) {
    Results results;
    for (int run = 0; run < runs; ++run) {
      results.add(options.piece([&] {
        return one_run(model, bars.tilt_deg / k_degrees_per_radian,
                       {1, options.seed, static_cast<std::uint64_t>(run)});
      }));
      if (options.progress) options.progress(++done, runs * static_cast<int>(k_cases.size()));
    }
    const std::string name =
        "8700339 at 0.5 m, 1 mm, tilt " + std::to_string(static_cast<int>(bars.tilt_deg)) + " deg";
    const auto bar = [&](double limit) {
      return options.quick ? Bar::none() : Bar::at_most(limit);
    };
    ExperimentCase glint{name, "glint", runs, {}};
    const char* const after[2] = {"_after_0.5_s", "_after_2_s"};
    for (std::size_t i = 0; i < 2; ++i) {
      glint.figures.push_back({std::string("centroid_rms") + after[i], "mm",
                               results.glint[i].position_mm(runs), bar(k_position_mm[i])});
      glint.figures.push_back({std::string("rotation_rms") + after[i], "deg",
                               results.glint[i].rotation_deg(runs), bar(bars.rotation_deg[i])});
    }
    list.cases.push_back(glint);
    list.cases.push_back({name,
                          "single frame",
                          runs,
                          {{"centroid_rms", "mm", results.single.position_mm(runs), {}},
                           {"rotation_rms", "deg", results.single.rotation_deg(runs), {}}}});
  }
  return list;
}

}  // namespace glint

#include "platform/lab/experiments/f2554.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kernels/motion/interpolate.hpp"
#include "platform/lab/experiments/glint_chain.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/tools/report/plots.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {
namespace {

constexpr int k_poses = 100;  // per part
constexpr int k_quick_poses = 15;
constexpr int k_held_frames = 3;       // per pose; the middle one is judged
constexpr double k_roll_rad = 0.4363;  // 25 degrees to either side
constexpr double k_grid_m = 0.05;      // spacing of the points, 3 x 3 x 2 of them

// Motion that holds one pose after the other, each for the same time.
class HeldPoses : public sim::Motion {
 public:
  HeldPoses(std::vector<Pose> poses, Duration each) : poses_(std::move(poses)), each_(each) {}
  [[nodiscard]] Pose pose(Time time) const override {
    const std::int64_t step = std::max<std::int64_t>(time.nanoseconds, 0) / each_.nanoseconds;
    return poses_[std::min(static_cast<std::size_t>(step), poses_.size() - 1)];
  }

 private:
  std::vector<Pose> poses_;
  Duration each_;
};

struct TipPair {
  Vector3 measured_m, true_m;  // camera frame
};

// Tip in the middle frame of each pose; skips frames without a pose.
std::vector<TipPair> measured(const std::vector<Pose>& poses, const CaseOptions& options,
                              const std::function<void()>& step) {
  sim::Scenario scenario = sim::still_run(hololens2_ahat());
  scenario.seed = options.seed;
  const Duration each = scenario.camera.period * k_held_frames;
  scenario.tools[0].motion = std::make_shared<HeldPoses>(poses, each);
  scenario.duration = each * static_cast<std::int64_t>(poses.size());
  const Tool tool = scenario.tools[0].tool;
  const sim::Simulator simulator(scenario);
  GlintChain chain(scenario.camera, tool, SearchArea::whole_frame);
  sim::SimFrame frame;
  std::vector<TipPair> tips;
  for (int i = k_held_frames / 2; i < simulator.frame_count(); i += k_held_frames) {
    simulator.render(i, frame);
    const Result<Pose> found = chain.process(frame.view(), frame.head);
    const Pose T_camera_tool =
        frame.truth.T_world_camera.inverse() * frame.truth.T_world_tool.front();
    if (found) tips.push_back({found.value * tool.tip_m, T_camera_tool * tool.tip_m});
    step();
  }
  return tips;
}

Pose static_pose() {
  const sim::Scenario scenario = sim::still_run(hololens2_ahat());
  return scenario.tools[0].motion->pose(Time{});
}

// The tool rotated about its tip, which stays at `tip_world`.
Pose rotated_about_tip(const Pose& rest, const Vector3& tip_tool, const Vector3& tip_world,
                       const Vector3& by_rad) {
  const Quaternion rotation = (rest.rotation * from_rotation_vector(by_rad)).normalized();
  return {rotation, tip_world - rotation * tip_tool};
}

Figure frames_without_pose(std::size_t poses, std::size_t found) {
  return {"frames_without_pose", "", static_cast<double>(poses - found)};
}

// Distances of the tips from their mean: the single point precision of F2554.
ExperimentCase point_case(const std::string& name, std::size_t poses,
                          const std::vector<TipPair>& tips, HistogramSeries* series) {
  Vector3 mean = Vector3::Zero();
  for (const TipPair& tip : tips) mean += tip.measured_m / static_cast<double>(tips.size());
  std::vector<double> off_mm, error_mm;
  for (const TipPair& tip : tips) {
    off_mm.push_back(1e3 * (tip.measured_m - mean).norm());
    error_mm.push_back(1e3 * (tip.measured_m - tip.true_m).norm());
  }
  if (series != nullptr) {
    *series = {name, make_histogram(off_mm, 0, std::max(1.0, percentile(off_mm, 0.99)), 30), {}};
  }
  const Summary off = summarize(off_mm), error = summarize(error_mm);
  return {name,
          "glint",
          static_cast<std::int64_t>(tips.size()),
          {{"precision_rms", "mm", off.rms},
           {"precision_p95", "mm", percentile(off_mm, 0.95)},
           {"precision_largest", "mm", off.maximum},
           {"error_rms", "mm", error.rms},
           {"error_largest", "mm", error.maximum},
           frames_without_pose(poses, tips.size())}};
}

ExperimentCase distance_case(std::size_t poses, const std::vector<TipPair>& tips) {
  std::vector<double> errors_mm, sizes_mm;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    for (std::size_t j = i + 1; j < tips.size(); ++j) {
      const double truth = (tips[i].true_m - tips[j].true_m).norm();
      if (truth < 0.5 * k_grid_m) continue;  // the same point twice
      errors_mm.push_back(1e3 * ((tips[i].measured_m - tips[j].measured_m).norm() - truth));
      sizes_mm.push_back(std::abs(errors_mm.back()));
    }
  }
  const Summary errors = summarize(errors_mm);
  return {"distances",
          "glint",
          static_cast<std::int64_t>(errors_mm.size()),
          {{"error_mean", "mm", errors.mean},
           {"error_rms", "mm", errors.rms},
           {"error_p95", "mm", percentile(sizes_mm, 0.95)},
           {"error_largest", "mm", percentile(sizes_mm, 1.0)},
           frames_without_pose(poses, tips.size())}};
}

// Evenly spaced angles from one side to the other.
double swing(int i, int count) { return k_roll_rad * (2.0 * i / std::max(count - 1, 1) - 1); }

Vector3 grid_point(int i) { return k_grid_m * Vector3(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 2 - 0.5); }

}  // namespace

CaseList run_f2554(const CaseOptions& options) {
  const int count = options.quick ? k_quick_poses : k_poses;
  const Pose rest = static_pose();
  const Tool tool = sim::still_run(hololens2_ahat()).tools[0].tool;
  const Vector3 tip_world = rest * tool.tip_m;
  int done = 0;
  const auto step = [&] {
    if (options.progress) options.progress(++done, 5 * count);
  };
  const auto run = [&](const std::vector<Pose>& poses) {
    return options.piece([&] { return measured(poses, options, step); });
  };

  CaseList list{"f2554", {}, {}};
  std::vector<HistogramSeries> plots(4);
  const sim::RandomKey key{options.seed, sim::Stream::hand, 0};
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const Vector3 by = 0.5 * k_roll_rad * sim::gaussian_vector(key, static_cast<std::uint64_t>(i));
    poses.push_back(rotated_about_tip(rest, tool.tip_m, tip_world, by));
  }
  list.cases.push_back(point_case("single point", poses.size(), run(poses), &plots[0]));
  const char* names[] = {"rotation about x", "rotation about y", "rotation about z"};
  for (int axis = 0; axis < 3; ++axis) {
    poses.clear();
    for (int i = 0; i < count; ++i) {
      poses.push_back(
          rotated_about_tip(rest, tool.tip_m, tip_world, swing(i, count) * Vector3::Unit(axis)));
    }
    const auto at = static_cast<std::size_t>(axis);
    list.cases.push_back(point_case(names[at], poses.size(), run(poses), &plots[at + 1]));
  }
  poses.clear();
  for (int i = 0; i < count; ++i) {
    const Vector3 by =
        0.2 * k_roll_rad * sim::gaussian_vector(key, static_cast<std::uint64_t>(1000 + i));
    poses.push_back(rotated_about_tip(rest, tool.tip_m, tip_world + grid_point(i), by));
  }
  list.cases.push_back(distance_case(poses.size(), run(poses)));

  list.plots.push_back(
      {options.out + "/f2554.svg",
       histogram_plot({"Tip on one point", "distance from the mean [mm]", "part a mm"}, plots)});
  return list;
}

}  // namespace glint

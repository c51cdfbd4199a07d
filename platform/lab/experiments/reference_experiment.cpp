#include "platform/lab/experiments/reference_experiment.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "platform/lab/experiments/reference_tries.hpp"
#include "platform/lab/experiments/robot_scenes.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/reference/find_reference.hpp"
#include "platform/tools/robot/sample_robot.hpp"

namespace glint {
namespace {

constexpr int k_seeds = 200, k_seeds_quick = 3;
constexpr int k_simulated = 60, k_simulated_quick = 3;

struct PoseDistance {
  double mm = 0, degrees = 0;
  [[nodiscard]] bool within(double most_mm, double most_degrees) const {
    return mm <= most_mm && degrees <= most_degrees;
  }
};

PoseDistance pose_distance(const Pose& a, const Pose& b) {
  return {
      1e3 * (a.translation - b.translation).norm(),
      k_degrees_per_radian * 2 * arc_cosine(std::min(1.0, std::abs(a.rotation.dot(b.rotation))))};
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// What is judged of one search.
struct ReferenceTry {
  ReferenceVerdict verdict = ReferenceVerdict::refused;
  PoseDistance off;      // from the best known pose
  PoseDistance off_fit;  // from the pose that fits these frames best
  double sigma_mm = 0, sigma_degrees = 0;
  double surface_mm = 0, inlier_share = 0;
};

ReferenceTry tried(const Reference& reference, const Pose& truth, const Pose& best_fit) {
  const ModelAlignment& alignment = reference.found.alignment;
  return {reference.verdict,
          pose_distance(alignment.T_world_base, truth),
          pose_distance(alignment.T_world_base, best_fit),
          1e3 * std::sqrt(alignment.covariance.topLeftCorner<3, 3>().trace()),
          k_degrees_per_radian * std::sqrt(alignment.covariance.bottomRightCorner<3, 3>().trace()),
          1e3 * reference.found.judgement.median_m,
          reference.found.judgement.inlier_share()};
}

// Converged poses relative to the best known pose, with their verdicts.
struct ReferenceTally {
  int runs = 0, accepted = 0, ambiguous = 0, right = 0, correct_rejected = 0, wrong_accepted = 0;
  std::vector<double> mm, degrees, sigma_mm, sigma_degrees;  // of all runs, against `truth`

  void add(const ReferenceTry& one) {
    ++runs;
    const bool is_accepted = one.verdict == ReferenceVerdict::accepted;
    accepted += is_accepted ? 1 : 0;
    ambiguous += one.verdict == ReferenceVerdict::ambiguous ? 1 : 0;
    const bool is_correct = one.off.within(20, 2);
    right += is_correct ? 1 : 0;
    correct_rejected += is_correct && !is_accepted ? 1 : 0;
    wrong_accepted += is_accepted && !one.off.within(40, 4) ? 1 : 0;
    mm.push_back(one.off.mm);
    degrees.push_back(one.off.degrees);
    sigma_mm.push_back(one.sigma_mm);
    sigma_degrees.push_back(one.sigma_degrees);
  }
  [[nodiscard]] double right_refused_share() const {
    return right > 0 ? 100.0 * correct_rejected / right : 0;
  }
  [[nodiscard]] std::vector<Figure> verdicts(Bar right_refused_bar = Bar::at_most(2)) const {
    return {{"wrong_accepted", "", static_cast<double>(wrong_accepted), Bar::at_most(0)},
            {"right_refused", "%", right_refused_share(), right_refused_bar},
            {"accepted", "%", 100.0 * accepted / std::max(1, runs)},
            {"ambiguous", "%", 100.0 * ambiguous / std::max(1, runs)},
            {"right", "%", 100.0 * right / std::max(1, runs)}};
  }
};

class Experiment {
 public:
  explicit Experiment(const CaseOptions& options)
      : options_(options),
        seeds_(options.quick ? k_seeds_quick : k_seeds),
        scan_(read_robot_scan(options.data)) {}

  CaseList run() {
    together("5 frames", scan_.frames);
    together("5 frames, masks", scan_.masked);
    far("5 frames, seeds +-40 cm, 40 deg", scan_.frames);
    left_out();
    cut_out();
    for (std::size_t i = 0; i < scan_.frames.size(); ++i) single(i);
    for (const char* robot : {"ur5", "panda"}) simulated(robot);
    straight_up();
    return std::move(list_);
  }

 private:
  ModelAlignment optimum(const std::vector<SceneFrame>& frames) const {
    FindReferenceSettings alone;
    alone.search_alternatives = false;
    return find_reference(frames, scan_.published, alone).found.alignment;
  }

  ReferenceTry try_scan(const std::vector<SceneFrame>& frames, const Pose& start,
                        const Pose& best_fit) const {
    return options_.piece(
        [&] { return tried(find_reference(frames, start, {}), scan_.published, best_fit); });
  }

  void together(const std::string& name, const std::vector<SceneFrame>& frames) {
    const Pose best = optimum(frames).T_world_base;
    ReferenceTally tally;
    int near_best = 0, near_published = 0;
    std::vector<double> surface, share;
    for (int i = 0; i < seeds_; ++i) {
      const ReferenceTry one = try_scan(frames, initial_pose(0.1, 10, i), best);
      tally.add(one);
      near_best += one.off_fit.within(5, 0.5) ? 1 : 0;
      near_published += one.off.within(20, 2) ? 1 : 0;
      surface.push_back(one.surface_mm);
      share.push_back(one.inlier_share);
    }
    std::vector<Figure> figures = tally.verdicts();
    figures.push_back({"near_optimum", "%", 100.0 * near_best / seeds_, Bar::at_least(99)});
    figures.push_back({"near_published", "%", 100.0 * near_published / seeds_, Bar::at_least(95)});
    figures.push_back({"median_surface", "mm", median(surface), Bar::at_most(7)});
    figures.push_back({"inlier_share", "", median(share), Bar::at_least(0.9)});
    add(name, seeds_, std::move(figures));
  }

  void far(const std::string& name, const std::vector<SceneFrame>& frames) {
    ReferenceTally tally;
    for (int i = 0; i < seeds_; ++i)
      tally.add(try_scan(frames, initial_pose(0.4, 40, i), scan_.published));
    add(name, seeds_, tally.verdicts());
  }

  // Cross-validation: the other frames' pose against the published one, by the median distance in
  // the frame left out.
  void left_out() {
    double worst = 0;
    for (std::size_t out = 0; out < scan_.frames.size(); ++out) {
      worst = std::max(worst, options_.piece([&] {
        std::vector<SceneFrame> others = scan_.frames;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
        const std::vector<SceneFrame> one{scan_.frames[out]};
        const double published = surface_mm(one, scan_.published);
        return surface_mm(one, optimum(others).T_world_base) / published;
      }));
    }
    add("one frame left out", static_cast<int>(scan_.frames.size()),
        {{"median_beside_published", "", worst, Bar::at_most(1.1)}});
  }

  static double surface_mm(const std::vector<SceneFrame>& frames, const Pose& T) {
    FindReferenceSettings still;
    still.search_alternatives = false;
    still.alignment.gate_count = 0;
    return 1e3 * find_reference(frames, T, still).found.judgement.median_m;
  }

  void cut_out() {
    const std::vector<SceneFrame> frames = without_robot(scan_);
    int accepted = 0;
    for (int i = 0; i < seeds_; ++i) {
      const double wide = i % 2 == 0 ? 1 : 4;
      const ReferenceTry one =
          try_scan(frames, initial_pose(0.1 * wide, 10 * wide, i), scan_.published);
      accepted += one.verdict == ReferenceVerdict::accepted ? 1 : 0;
    }
    add("robot cut out", seeds_,
        {{"accepted", "", static_cast<double>(accepted), Bar::at_most(0)}});
  }

  void single(std::size_t number) {
    const std::vector<SceneFrame> one{scan_.frames[number]};
    const Pose best = optimum(one).T_world_base;
    int near_best = 0;
    ReferenceTally tally;
    for (int i = 0; i < seeds_; ++i) {
      const ReferenceTry found = try_scan(one, initial_pose(0.1, 10, i), best);
      near_best += found.off_fit.within(10, 1) ? 1 : 0;
      tally.add(found);
    }
    std::vector<Figure> figures = tally.verdicts();
    figures.push_back({"near_optimum", "%", 100.0 * near_best / seeds_, Bar::at_least(98)});
    add("frame " + std::to_string(number) + " alone", seeds_, std::move(figures));
  }

  // A column that looks much alike from all sides: an ambiguous verdict is not counted as wrong.
  void straight_up() {
    const std::string folder = options_.data + "/robots/ur5";
    const RobotModel robot =
        load_robot({folder + "/ur5_robot.urdf", {folder}, Geometry::collision});
    constexpr double quarter = 1.5707963267948966;
    SimulationSettings settings;
    settings.half_hidden = settings.mask = false;
    settings.positions = {0, -quarter, 0, -quarter, 0, 0};
    ReferenceTally tally;
    for (int i = 0; i < seeds_; ++i) {
      const auto number = static_cast<std::uint64_t>(i);
      tally.add(options_.piece([&] {
        const SimulatedScene scene = simulate_scene(robot, settings, options_.seed, number);
        const Pose start = initial_pose_near(scene.T_world_base, 0.4, 40, options_.seed, number);
        return tried(find_reference(scene.frames, start, {}), scene.T_world_base,
                     scene.T_world_base);
      }));
    }
    add("ur5 straight up, seeds +-40 cm, 40 deg", seeds_, tally.verdicts());
  }

  void simulated(const std::string& name) {
    const std::string folder = options_.data + "/robots/" + name;
    const std::string urdf = folder + (name == "ur5" ? "/ur5_robot.urdf" : "/panda.urdf");
    const RobotModel robot = load_robot({urdf, {folder}, Geometry::collision});
    for (const int views : {1, 3}) {
      for (const bool mask : {true, false}) {
        simulated(name, robot, views, mask, nullptr);
      }
    }
    const RobotCloud cloud = sample_robot(robot, k_robot_cloud_points);
    simulated(name + "'s points", robot, 1, true, &cloud);
  }

  // cloud: used for the search in place of the robot's triangles; may be null.
  void simulated(const std::string& name, const RobotModel& robot, int views, bool mask,
                 const RobotCloud* cloud) {
    const int count = options_.quick ? k_simulated_quick : k_simulated;
    ReferenceTally tally;
    for (int i = 0; i < count; ++i) {
      SimulationSettings settings;
      settings.views = views;
      settings.mask = mask;
      const auto instance = static_cast<std::uint64_t>(i);
      tally.add(options_.piece([&] {
        SimulatedScene scene = simulate_scene(robot, settings, options_.seed, instance);
        for (SceneFrame& frame : scene.frames) {
          if (cloud != nullptr) frame.cloud = posed_cloud(*cloud, scene.positions, name);
        }
        const Pose start = initial_pose_near(scene.T_world_base, 0.1, 10, options_.seed, instance);
        return tried(find_reference(scene.frames, start, {}), scene.T_world_base,
                     scene.T_world_base);
      }));
    }
    // One view without a mask is rejected if half of the robot is hidden, right or wrong.
    const bool judged = mask || views > 1;
    std::vector<Figure> figures = tally.verdicts(judged ? Bar::at_most(2) : Bar::none());
    const double mm = median(tally.mm), degrees = median(tally.degrees);
    const auto at_most = [&](double one, double three) {
      return judged ? Bar::at_most(views == 1 ? one : three) : Bar::none();
    };
    figures.push_back({"position", "mm", mm, at_most(2.0, 0.8)});
    figures.push_back({"rotation", "deg", degrees, at_most(0.45, 0.15)});
    figures.push_back({"position_in_sigmas", "", mm / median(tally.sigma_mm), at_most(1.3, 1.3)});
    figures.push_back(
        {"rotation_in_sigmas", "", degrees / median(tally.sigma_degrees), at_most(1.3, 1.3)});
    add(name + ", " + std::to_string(views) + (views == 1 ? " view" : " views") +
            (mask ? ", mask" : ""),
        count, std::move(figures));
  }

  [[nodiscard]] Pose initial_pose(double shift_m, double degrees, int number) const {
    return initial_pose_near(scan_.published, shift_m, degrees, options_.seed,
                             static_cast<std::uint64_t>(number));
  }

  void add(const std::string& name, int n, std::vector<Figure> figures) {
    list_.cases.push_back({name, "glint", n, std::move(figures)});
    constexpr int cases = 21;
    if (options_.progress) options_.progress(static_cast<int>(list_.cases.size()), cases);
  }

  const CaseOptions& options_;
  int seeds_;
  RobotScan scan_;
  CaseList list_{"reference", {}, {}};
};

}  // namespace

CaseList run_reference_experiment(const CaseOptions& options) {
  return options.tries > 0 ? run_reference_tries(options) : Experiment(options).run();
}

}  // namespace glint

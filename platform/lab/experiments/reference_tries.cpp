#include "platform/lab/experiments/reference_tries.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>

#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/reference/find_reference.hpp"

namespace glint {
namespace {

constexpr double k_cpu_max_s = 10;

// Data shared by all tries.
struct TryScan {
  RobotScan scan;
  std::vector<RobotModel> other_robots;
  std::vector<SceneFrame> cut_out;
  Pose best;
};

Pose best_pose(const RobotScan& scan) {
  FindReferenceSettings alone;
  alone.search_alternatives = false;
  return find_reference(scan.frames, scan.published, alone).found.alignment.T_world_base;
}

TryScan read_try_scan(const std::string& data) {
  TryScan all;
  all.scan = read_robot_scan(data);
  for (const auto& [name, urdf] :
       {std::pair("ur5", "ur5_robot.urdf"), std::pair("panda", "panda.urdf")}) {
    const std::string folder = data + "/robots/" + name;
    all.other_robots.push_back(load_robot({folder + "/" + urdf, {folder}, Geometry::collision}));
  }
  all.cut_out = without_robot(all.scan);
  all.best = best_pose(all.scan);
  return all;
}

// Sequence of random numbers of one try.
class TryDraws {
 public:
  TryDraws(std::uint64_t seed, int number)
      : key_{seed, sim::Stream::reference, static_cast<std::uint64_t>(number) + (1u << 20)} {}
  [[nodiscard]] std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(sim::uniform(key_, drawn_++) * static_cast<double>(count));
  }
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * sim::uniform(key_, drawn_++);
  }

 private:
  sim::RandomKey key_;
  std::uint64_t drawn_ = 0;
};

std::vector<SceneFrame> frames_of(const TryScan& all, const TryClass& kind, TryDraws& draws) {
  const RobotScan& scan = all.scan;
  std::vector<SceneFrame> frames = kind.fault == TryFault::cut_out ? all.cut_out
                                   : kind.mask                     ? scan.masked
                                                                   : scan.frames;
  const std::size_t count = frames.size();
  if (kind.fault == TryFault::joints) {
    const std::size_t ahead = 1 + draws.below(count - 1);
    for (std::size_t i = 0; i < count; ++i)
      frames[i].model = scan.frames[(i + ahead) % count].model;
  }
  if (kind.fault == TryFault::robot) {
    const RobotModel& robot = all.other_robots[draws.below(all.other_robots.size())];
    for (SceneFrame& frame : frames) {
      std::vector<double> positions;
      for (std::size_t j = 0; j < robot.inputs.size(); ++j) {
        positions.push_back(draws.between(-1.3, 1.3));
      }
      frame.model = posed_surface(robot, positions, "a try");
    }
  }
  if (!kind.several) frames = {frames[draws.below(count)]};
  return frames;
}

TryResult run_try(const TryScan& all, std::uint64_t seed, int number) {
  const std::vector<TryClass>& classes = try_classes();
  const TryClass& kind = classes[static_cast<std::size_t>(number) % classes.size()];
  TryDraws draws(seed, number);
  const std::vector<SceneFrame> frames = frames_of(all, kind, draws);
  const Pose start = initial_pose_near(all.best, kind.far ? 0.4 : 0.1, kind.far ? 40 : 10, seed,
                                       static_cast<std::uint64_t>(number));
  const std::clock_t before = std::clock();
  const Reference reference = find_reference(frames, start, {});
  TryResult result{seed, number, name_of(reference.verdict), 0, 0, 0, 0, reference.reason};
  result.cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  const ModelAlignment& end = reference.found.alignment;
  result.translation_mm = 1e3 * (end.T_world_base.translation - all.best.translation).norm();
  result.rotation_deg =
      k_degrees_per_radian * 2 *
      arc_cosine(std::min(1.0, std::abs(end.T_world_base.rotation.dot(all.best.rotation))));
  result.sigma_mm = 1e3 * std::sqrt(end.covariance.topLeftCorner<3, 3>().trace());
  return result;
}

}  // namespace

const std::vector<TryClass>& try_classes() {
  static const std::vector<TryClass> k_classes = {
      {"one picture, near", false, false, false, TryFault::none, 80},
      {"one picture, mask, near", false, true, false, TryFault::none, 95},
      {"five pictures, near", true, false, false, TryFault::none, 95},
      {"five pictures, masks, near", true, true, false, TryFault::none, 95},
      {"one picture, far", false, false, true, TryFault::none, 45},
      {"one picture, mask, far", false, true, true, TryFault::none, 45},
      {"five pictures, far", true, false, true, TryFault::none, 0},
      {"one picture, other joint values, near", false, false, false, TryFault::joints, 0},
      {"one picture, mask, other joint values, near", false, true, false, TryFault::joints, 0},
      {"one picture, other joint values, far", false, false, true, TryFault::joints, 0},
      {"one picture, mask, other joint values, far", false, true, true, TryFault::joints, 0},
      {"five pictures, other joint values, far", true, false, true, TryFault::joints, 0},
      {"one picture, another robot, far", false, false, true, TryFault::robot, 0},
      {"one picture, mask, another robot, far", false, true, true, TryFault::robot, 0},
      {"one picture, robot cut out, near", false, false, false, TryFault::cut_out, 0},
      {"one picture, robot cut out, far", false, false, true, TryFault::cut_out, 0},
  };
  return k_classes;
}

std::string try_line(const TryResult& result) {
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, ",%.2f,%.3f,%.2f,%.2f,", result.translation_mm,
                result.rotation_deg, result.sigma_mm, result.cpu_s);
  return std::to_string(result.seed) + "," + std::to_string(result.number) + "," + result.verdict +
         numbers + result.reason + "\n";
}

std::vector<TryResult> read_tries(const std::string& path, std::uint64_t seed) {
  std::vector<TryResult> tries;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (file.eof()) break;  // truncated: no end of line
    std::istringstream fields(line);
    TryResult one;
    char comma = 0;
    fields >> one.seed >> comma >> one.number >> comma;
    std::getline(fields, one.verdict, ',');
    fields >> one.translation_mm >> comma >> one.rotation_deg >> comma >> one.sigma_mm >> comma >>
        one.cpu_s >> comma;
    if (!fields || one.seed != seed || one.number < 0) continue;
    std::getline(fields, one.reason);
    tries.push_back(one);
  }
  return tries;
}

CaseList count_tries(const std::vector<TryResult>& tries) {
  CaseList list{"reference", {}, {}};
  const std::vector<TryClass>& classes = try_classes();
  for (std::size_t c = 0; c < classes.size(); ++c) {
    int count = 0, right = 0, between = 0, wrong = 0, ambiguous = 0;
    double cpu_s = 0;
    for (const TryResult& one : tries) {
      if (static_cast<std::size_t>(one.number) % classes.size() != c) continue;
      ++count;
      cpu_s = std::max(cpu_s, one.cpu_s);
      ambiguous += one.verdict == "ambiguous" ? 1 : 0;
      if (one.verdict != "accepted") continue;
      // If the robot is not in the image, no pose is right.
      const bool there = classes[c].fault == TryFault::none || classes[c].fault == TryFault::joints;
      right += there && one.is_right() ? 1 : 0;
      wrong += !there || one.is_wrong() ? 1 : 0;
      between += there && !one.is_right() && !one.is_wrong() ? 1 : 0;
    }
    if (count == 0) continue;
    const double accepted = 100.0 * (right + between) / count;
    const double least = classes[c].accepted_min;
    list.cases.push_back(
        {classes[c].name,
         "glint",
         count,
         {{"wrong_accepted", "", static_cast<double>(wrong), Bar::at_most(0)},
          {"between_accepted", "", static_cast<double>(between)},
          {"accepted", "%", accepted, least > 0 ? Bar::at_least(least) : Bar::none()},
          {"ambiguous", "%", 100.0 * ambiguous / count},
          {"cpu_max", "s", cpu_s, Bar::at_most(k_cpu_max_s)}}});
  }
  return list;
}

CaseList run_reference_tries(const CaseOptions& options) {
  const std::string path = options.out + "/reference_tries.csv";
  const std::vector<TryResult> finished = read_tries(path, options.seed);
  const TryScan all = read_try_scan(options.data);
  std::ofstream file(path, std::ios::app);
  std::vector<TryResult> tries;
  for (int number = 0; number < options.tries; ++number) {
    tries.push_back(options.piece([&] {
      for (const TryResult& one : finished) {
        if (one.number == number) return one;
      }
      const TryResult fresh = run_try(all, options.seed, number);
      file << try_line(fresh) << std::flush;
      if (!file)
        throw InputError(path + ": cannot be written; expected a writable folder with free space");
      return fresh;
    }));
    if (options.progress) options.progress(number + 1, options.tries);
  }
  return count_tries(tries);
}

}  // namespace glint

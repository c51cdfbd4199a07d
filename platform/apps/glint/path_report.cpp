#include "platform/apps/glint/path_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "platform/apps/glint/losses_json.hpp"

namespace glint {
namespace {

double largest_sigma_m(const DrawnPath& path) {
  double most = 0;
  for (const PathElement& element : path) {
    for (const UncertainPose& point : element.points) {
      most = std::max(most, point.covariance.topLeftCorner<3, 3>().trace() / 3);
    }
  }
  return std::sqrt(most);
}

double median_sigma_m(const DrawnPath& path) {
  std::vector<double> variances;
  for (const PathElement& element : path)
    for (const UncertainPose& point : element.points)
      variances.push_back(point.covariance.topLeftCorner<3, 3>().trace() / 3);
  if (variances.empty()) return 0;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::sqrt(*middle);
}

}  // namespace

void print_elements(const DrawnPath& path) {
  int number = 0;
  for (const PathElement& element : path) {
    const UncertainPose& first = element.points.front();
    const Vector3& at = first.pose.translation;
    std::printf("%3d  %-12s  %-8s  %5zu points  at %9.3f s  from %+.4f %+.4f %+.4f m\n", ++number,
                element.name.c_str(), name_of(element.kind), element.points.size(),
                static_cast<double>(first.time.nanoseconds) * 1e-9, at.x(), at.y(), at.z());
  }
}

void print_capture(const RecordedPath& drawn, double spacing_m) {
  const CaptureCounts& counts = drawn.counts;
  std::printf("poses while held %lld, used %lld; largest sigma an axis %.2f mm\n",
              static_cast<long long>(counts.poses), static_cast<long long>(counts.poses_accepted),
              1e3 * largest_sigma_m(drawn.path));
  if (drawn.poses == PathPoses::smoothed) {
    std::printf("smoothed over %lld measured frames; median sigma an axis %.2f mm\n",
                static_cast<long long>(drawn.frames), 1e3 * median_sigma_m(drawn.path));
  } else {
    std::printf("poses as sent at the ticks; median sigma an axis %.2f mm\n",
                1e3 * median_sigma_m(drawn.path));
  }
  if (spacing_m < 2 * largest_sigma_m(drawn.path)) {
    std::printf(
        "notice  points are %.2f mm apart, less than twice their sigma: noise dominates some; set "
        "a wider --spacing, or keep a reference body in view\n",
        1e3 * spacing_m);
  }
  const auto notice = [](std::int64_t count, const char* what) {
    if (count > 0) std::printf("notice  %lld %s\n", static_cast<long long>(count), what);
  };
  if (drawn.losses.any())
    std::printf("notice  the recording lacks %s\n", text_of(drawn.losses).c_str());
  notice(drawn.replay_mismatches, "output records differ from the replay's, which was smoothed");
  notice(counts.not_measured, "poses left out: not measured");
  notice(counts.not_in_robot, "poses left out: not in the robot's frame");
  notice(counts.not_usable, "poses left out: out of order or a jump");
  notice(counts.gaps, "strokes ended by a lost pen; the next pose begins another");
  notice(counts.presses_without_effect,
         "button presses without effect: no pose, or nothing to delete or undo");
  notice(counts.points_over_capacity, "points left out: more than --points-max");
  notice(counts.strokes_over_capacity, "elements left out: more than the capacity");
}

nlohmann::ordered_json path_figures(const RecordedPath& drawn) {
  nlohmann::ordered_json elements = nlohmann::ordered_json::array();
  for (const PathElement& element : drawn.path) {
    elements.push_back({{"name", element.name},
                        {"kind", name_of(element.kind)},
                        {"points", element.points.size()}});
  }
  const CaptureCounts& counts = drawn.counts;
  return {{"tool", drawn.tool},
          {"events", drawn.events},
          {"elements", elements},
          {"points", point_count(drawn.path)},
          {"smoothed", drawn.poses == PathPoses::smoothed},
          {"frames", drawn.frames},
          {"replay_mismatches", drawn.replay_mismatches},
          {"median_sigma_mm", 1e3 * median_sigma_m(drawn.path)},
          {"largest_sigma_mm", 1e3 * largest_sigma_m(drawn.path)},
          {"poses", counts.poses},
          {"taken", counts.poses_accepted},
          {"not_measured", counts.not_measured},
          {"not_in_robot", counts.not_in_robot},
          {"not_usable", counts.not_usable},
          {"gaps", counts.gaps},
          {"presses_in_vain", counts.presses_without_effect},
          {"points_left_out", counts.points_over_capacity},
          {"strokes_left_out", counts.strokes_over_capacity},
          {"missing", losses_json(drawn.losses)}};
}

}  // namespace glint

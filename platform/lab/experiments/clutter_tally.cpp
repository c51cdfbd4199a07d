#include "platform/lab/experiments/clutter_tally.hpp"

#include <algorithm>
#include <bit>
#include <string>

namespace glint {
namespace {

constexpr double k_swapped_m = 0.02;
constexpr int k_markers_to_find = 4;

bool matches_tool(const Tool& tool, const ToolOutcome& found, const Tool& other,
                  const Pose& truth) {
  for (int i = 0; i < tool.marker_count; ++i) {
    if (((found.marker_mask >> i) & 1) == 0) continue;
    const Vector3 place = found.T_camera_tool * tool.markers_m[static_cast<std::size_t>(i)];
    const auto end = other.markers_m.begin() + other.marker_count;
    if (std::none_of(other.markers_m.begin(), end, [&](const Vector3& marker) {
          return (truth * marker - place).norm() <= k_swapped_m;
        }))
      return false;
  }
  return true;
}

}  // namespace

void ClutterTally::add(const FrameOutcome& outcome, const FrameGroundTruth& truth) {
  const Pose T_camera_world = truth.T_world_camera.inverse();
  for (int t = 0; t < tools_.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const ToolOutcome& found = outcome.tools[i];
    const Pose T_camera_tool = T_camera_world * truth.T_world_tool[i];
    ++judged_;
    const int to_find = std::min(k_markers_to_find, tools_.items[i].marker_count);
    four_seen_[i] = four_seen_[i] || std::popcount(truth.visible_mask[i]) >= to_find;
    if (is_trackable(truth.visible_mask[i])) {
      if (four_seen_[i]) {
        ++findable_;
        found_ += found.seen ? 1 : 0;
      }
      ++trackable_;
      if (found.seen)
        ++tracked_;
      else
        ++missed_[static_cast<std::size_t>(found.reason)];
    }
    if (!found.seen) continue;
    if (!is_gross(error_of(found, tools_.items[i], T_camera_tool))) continue;
    ++gross_;
    for (int o = 0; o < tools_.count; ++o) {
      const auto other = static_cast<std::size_t>(o);
      if (o == t || !matches_tool(tools_.items[i], found, tools_.items[other],
                                  T_camera_world * truth.T_world_tool[other]))
        continue;
      ++swapped_;
      break;
    }
  }
}

std::vector<Figure> ClutterTally::figures(const Bar& found, const Bar& wrong) const {
  const auto share = [](std::int64_t part, std::int64_t of) {
    return 100 * static_cast<double>(part) / static_cast<double>(of);
  };
  std::vector<Figure> figures = {{"tracked", "%", share(tracked_, trackable_)},
                                 {"found", "%", share(found_, findable_), found},
                                 {"gross", "", static_cast<double>(gross_), wrong},
                                 {"swapped", "", static_cast<double>(swapped_), wrong},
                                 {"trackable_share", "%", share(trackable_, judged_)}};
  for (std::size_t reason = 0; reason < missed_.size(); ++reason) {
    if (missed_[reason] == 0) continue;
    figures.push_back({"missed_" + std::string(name_of(static_cast<Reason>(reason))), "",
                       static_cast<double>(missed_[reason])});
  }
  return figures;
}

}  // namespace glint

#include "platform/tools/inspect/replay_points.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/formats/points_csv.hpp"
#include "platform/tools/inspect/label_path.hpp"

namespace glint {
namespace {

std::uint8_t mask_of(const Labeling& labeling) {
  unsigned mask = 0;
  for (std::size_t i = 0; i < labeling.marker.size(); ++i)
    if (labeling.marker[i] >= 0) mask |= 1u << i;
  return static_cast<std::uint8_t>(mask);
}

PointPose pose_of(const LabeledFrame& frame, const PathChoice& choice, const Tool& tool) {
  PointPose pose;
  pose.time = frame.time;
  if (choice.chosen < 0) return pose;
  pose.margin = choice.margin;
  pose.reason = choice.ambiguous() ? Reason::ambiguous : Reason::none;
  pose.solved = !choice.ambiguous();
  const Labeling& labeling = frame.labelings[static_cast<std::size_t>(choice.chosen)];
  pose.marker_mask = mask_of(labeling);
  pose.rms_m = labeling.rms_m;
  pose.pose = labeling.T_camera_tool;
  pose.tip_m = pose.pose * tool.tip_m;
  return pose;
}

}  // namespace

PointsResult replay_points(const std::string& points_file, const std::string& tool_file) {
  const std::vector<PointFrame> frames = load_points(points_file);
  const Tool tool = as_points(named_tool(tool_file));
  const CorrespondSettings settings = settings_for_points();
  const auto scratch = std::make_unique<CorrespondScratch>();
  const auto found = std::make_unique<Labelings>();
  std::vector<LabeledFrame> labeled;
  std::vector<Reason> reasons;
  for (const PointFrame& frame : frames) {
    propose_labelings(markers_from_points(frame.points_m), tool, settings, nullptr, *scratch,
                      *found);
    labeled.push_back({frame.time, {found->items.begin(), found->items.begin() + found->count}});
    reasons.push_back(found->reason);
  }
  PathSettings path;
  path.sigma_m = settings.range_sigma_m;
  const std::vector<PathChoice> choices = choose_path(labeled, tool, path);

  PointsResult result;
  result.margin_min = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < labeled.size(); ++f) {
    PointPose pose = pose_of(labeled[f], choices[f], tool);
    if (choices[f].chosen < 0) pose.reason = reasons[f];
    result.ambiguous += pose.reason == Reason::ambiguous ? 1 : 0;
    if (pose.solved) {
      ++result.solved;
      result.rms_mean_m += pose.rms_m;
      result.rms_max_m = std::max(result.rms_max_m, pose.rms_m);
      result.margin_min = std::min(result.margin_min, pose.margin);
    }
    result.frames.push_back(pose);
  }
  if (result.solved > 0) result.rms_mean_m /= static_cast<double>(result.solved);
  return result;
}

}  // namespace glint

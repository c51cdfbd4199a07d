#include "platform/tools/calibrate/tool_round.hpp"

#include <algorithm>
#include <cmath>

#include "platform/tools/calibrate/marker_clusters.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr double k_noise_min_m = 2e-5;
constexpr double k_cluster_noises = 6;
constexpr double k_cluster_radius_min_m = 0.002;

double robust_noise(const ToolIteration& round) {
  std::vector<double> components;
  for (const LabelledPoint& point : round.points) {
    const Vector3 miss = bundle_residual(round.bundle, point);
    for (int axis = 0; axis < 3; ++axis) components.push_back(miss[axis]);
  }
  return std::max(sigma_of(components), k_noise_min_m);
}

void drop_outliers(ToolIteration& round) {
  const double limit = std::sqrt(k_chi_square_of_three) * robust_noise(round);
  std::erase_if(round.points, [&](const LabelledPoint& point) {
    return bundle_residual(round.bundle, point).norm() > limit;
  });
  // Fewer than three points do not determine a pose.
  std::vector<int> left(round.frames.size(), 0);
  for (const LabelledPoint& point : round.points) ++left[point.frame];
  std::erase_if(round.points, [&](const LabelledPoint& point) { return left[point.frame] < 3; });
}

// Removes poses without points.
void compact(ToolIteration& round) {
  std::vector<std::size_t> index(round.frames.size(), 0), frames;
  std::vector<Pose> poses;
  std::vector<bool> used(round.frames.size(), false);
  for (const LabelledPoint& point : round.points) used[point.frame] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    index[i] = frames.size();
    frames.push_back(round.frames[i]);
    poses.push_back(round.bundle.poses[i]);
  }
  for (LabelledPoint& point : round.points) point.frame = index[point.frame];
  round.frames = std::move(frames);
  round.bundle.poses = std::move(poses);
}

}  // namespace

ToolIteration round_of(std::span<const PointFrame> frames, std::size_t begin,
                       const LabelledFrames& named) {
  ToolIteration round;
  round.bundle.markers_m.assign(named.tool.markers_m.begin(),
                                named.tool.markers_m.begin() + named.tool.marker_count);
  for (std::size_t i = 0; i < named.labels.size(); ++i) {
    const Labeling& label = named.labels[i];
    if (label.count < 3) continue;
    const std::size_t pose = round.frames.size();
    round.frames.push_back(begin + i);
    round.bundle.poses.push_back(label.T_camera_tool);
    for (std::size_t m = 0; m < round.bundle.markers_m.size(); ++m) {
      if (label.marker[m] < 0) continue;
      const auto point = static_cast<std::size_t>(label.marker[m]);
      round.points.push_back({pose, m, frames[begin + i].points_m[point]});
    }
  }
  return round;
}

void fit(ToolIteration& round, double noise_m) {
  round.bundle = refined_bundle(std::move(round.bundle), round.points, noise_m);
  drop_outliers(round);
  compact(round);
  if (round.points.empty()) return;
  round.bundle = refined_bundle(std::move(round.bundle), round.points, 0);
  round.noise_m = std::max(bundle_noise(round.bundle, round.points), k_noise_min_m);
}

std::vector<int> frame_counts_by_marker(const ToolIteration& round) {
  std::vector<int> seen(round.bundle.markers_m.size(), 0);
  for (const LabelledPoint& point : round.points) ++seen[point.marker];
  return seen;
}

std::vector<Vector3> next_markers(std::span<const PointFrame> frames, const ToolIteration& round,
                                  double frame_share_min) {
  const std::vector<int> seen = frame_counts_by_marker(round);
  const double least = frame_share_min * static_cast<double>(round.frames.size());
  std::vector<Vector3> markers;
  for (std::size_t m = 0; m < seen.size(); ++m) {
    if (seen[m] >= least) markers.push_back(round.bundle.markers_m[m]);
  }
  MarkerClusters clusters(std::max(k_cluster_noises * round.noise_m, k_cluster_radius_min_m));
  for (std::size_t i = 0; i < round.frames.size(); ++i) {
    const Pose T_tool_file = round.bundle.poses[i].inverse();
    for (const Vector3& point : frames[round.frames[i]].points_m) clusters.add(T_tool_file * point);
  }
  for (const Vector3& centre : clusters.centres_with_count_min(least)) {
    const auto near = [&](const Vector3& marker) {
      return (marker - centre).norm() < 2 * clusters.radius_m();
    };
    if (std::none_of(markers.begin(), markers.end(), near) &&
        markers.size() < static_cast<std::size_t>(k_markers_per_tool_max))
      markers.push_back(centre);
  }
  return markers;
}

}  // namespace glint

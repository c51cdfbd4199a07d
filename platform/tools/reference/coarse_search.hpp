// Coarse global search of a robot's pose: candidate poses in a declared range about an initial
// pose.
//
// What:     samples a few hundred points of the robot's surface. Scores poses spread evenly over
//           the range by the depth at the points' pixels. Aligns the best ones by projective ICP
//           (match_points.hpp) and scores them again. A coarse z-buffer hides points behind others.
// Cost:     k_coarse_poses scores and k_coarse_aligned short alignments of all points.
// Worst:    all poses of the range score equally: the right one may not be among the best.
// Accuracy: converged poses are within a few centimetres of those of align_model.hpp.
// Source:   spread poses: Roberts 2018, the R sequence; scores with normals: Chen and Medioni 1992.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernels/registration/alignment_sums.hpp"
#include "platform/tools/reference/coarse_image.hpp"
#include "platform/tools/reference/scene.hpp"

namespace glint {

inline constexpr int k_coarse_points = 1600;  // of all images together
inline constexpr int k_coarse_points_min = 300;
inline constexpr double k_end_gate_m = 0.04;
inline constexpr int k_coarse_poses = 10'000;
inline constexpr std::size_t k_coarse_aligned = 600;

// Limits of each coordinate of the base's position, and of each rotation about a fixed axis,
// relative to the initial pose.
struct SearchRange {
  double translation_m = 0.4;
  double rotation_rad = 0.6981317007977318;  // 40 deg

  // Returns whether a pose is no farther from `start` than a corner of the range.
  [[nodiscard]] bool contains(const Pose& start, const Pose& pose) const;
};

// Returns `start`, then k_coarse_poses poses that fill the range evenly.
[[nodiscard]] std::vector<Pose> spread_poses(const Pose& start, const SearchRange& range);

struct CoarsePose {
  Pose T_world_base;
  double score = 0;  // of score() with k_end_gate_m
};

class CoarseSearch {
 public:
  explicit CoarseSearch(std::span<const SceneFrame> frames);

  // Returns the best distinct converged poses, best first, each over `apart_m` from those before.
  [[nodiscard]] std::vector<CoarsePose> best(std::span<const Pose> starts, std::size_t count,
                                             double apart_m);
  // (explained within gate_m, weighted by normal, minus seen through) / points, times mask
  // coverage.
  [[nodiscard]] double score(const Pose& T_world_base, double gate_m);
  // Root mean square of the distances between the robot's points at two poses.
  [[nodiscard]] double surface_motion_m(const Pose& a, const Pose& b) const;

 private:
  // Transforms an image's points and computes the nearest depth in each cell.
  void project_points(const CoarseImage& picture, const Pose& T_world_base);
  [[nodiscard]] Pose aligned(Pose T_world_base);
  [[nodiscard]] bool move(Pose& T_world_base, double gate_m);

  std::vector<CoarseImage> pictures_;
  std::vector<Vector3> points_camera_;  // points of the image of the last project_points()
  std::vector<int> pixels_;             // of the projected points; -1: outside, -2: hidden
  std::vector<float> cell_depths_;      // 0: no point
};

}  // namespace glint

// Poses of a robot that are worth an alignment: a search over a declared range about a start.
//
// What:     a few hundred points of the robot's surface stand for it. Poses spread evenly over the
//           range are scored by the depth at the points' pixels; the best move by projective ICP
//           (match_points.hpp) and are scored again. A coarse z-buffer hides points behind others.
// Cost:     k_coarse_poses scores and k_coarse_aligned short alignments of all points.
// Worst:    every pose of the range scores alike: the right one may not be among the best.
// Accuracy: ends lie within a few centimetres of those of align_model.hpp.
// Source:   spread poses: Roberts 2018, the R sequence; scores with normals: Chen and Medioni 1992.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernels/registration/alignment_sums.hpp"
#include "platform/reference/coarse_picture.hpp"
#include "platform/reference/scene.hpp"

namespace glint {

inline constexpr int k_coarse_points = 1600;  // of all pictures together
inline constexpr int k_coarse_points_min = 300;
inline constexpr double k_end_gate_m = 0.04;
inline constexpr int k_coarse_poses = 10'000;
inline constexpr std::size_t k_coarse_aligned = 600;

// Each coordinate of the base's position, and each turn about a fixed axis, lies within these of
// the start's.
struct SearchRange {
  double shift_m = 0.4;
  double turn_rad = 0.6981317007977318;  // 40 deg

  // Whether a pose is no farther from the start than a corner of the range.
  [[nodiscard]] bool holds(const Pose& start, const Pose& pose) const;
};

// The start first, then k_coarse_poses that fill the range evenly.
[[nodiscard]] std::vector<Pose> spread_poses(const Pose& start, const SearchRange& range);

struct CoarsePose {
  Pose T_world_base;
  double score = 0;  // as score() has it, within k_end_gate_m
};

class CoarseSearch {
 public:
  explicit CoarseSearch(std::span<const SceneFrame> frames);

  // The best distinct ends, best first, each farther than `apart_m` from those before it.
  [[nodiscard]] std::vector<CoarsePose> best(std::span<const Pose> starts, std::size_t count,
                                             double apart_m);
  // Of the points: explained within gate_m, with the scene's normal, less those seen through.
  [[nodiscard]] double score(const Pose& T_world_base, double gate_m);
  // Root mean square of the distances between the robot's points at two poses.
  [[nodiscard]] double surface_motion_m(const Pose& a, const Pose& b) const;

 private:
  // Transforms a picture's points and finds the nearest depth in each cell.
  void place(const CoarsePicture& picture, const Pose& T_world_base);
  [[nodiscard]] Pose aligned(Pose T_world_base);
  [[nodiscard]] bool move(Pose& T_world_base, double gate_m);

  std::vector<CoarsePicture> pictures_;
  std::vector<Vector3> placed_;     // of the picture that place() was called for last
  std::vector<int> pixels_;         // of the placed points; -1: hidden or outside
  std::vector<float> cell_depths_;  // 0: no point
};

}  // namespace glint

#include "platform/tools/reference/coarse_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "kernels/elementary.hpp"
#include "platform/tools/reference/find_reference.hpp"

namespace glint {
namespace {

// Less than the thickness of a link, more than the depth variation within a cell.
constexpr double k_occlusion_m = 0.06;
constexpr float k_normal_cosine = 0.64f;  // depth noise rotates normals by up to 50 deg
constexpr double k_other_normal = 0.25;   // weight of a point with a different normal
constexpr double k_score_gate_m = 0.12;
constexpr std::array<std::pair<double, int>, 3> k_coarse_gates{{{0.15, 6}, {0.08, 5}, {0.04, 5}}};

}  // namespace

bool SearchRange::contains(const Pose& start, const Pose& pose) const {
  const double turn = 2 * arc_cosine(std::min(1.0, std::abs(start.rotation.dot(pose.rotation))));
  // Largest rotation by three rotations about fixed axes.
  const SineCosine half = sine_cosine(0.5 * rotation_rad);
  const double cosine = half.cosine * half.cosine * half.cosine - half.sine * half.sine * half.sine;
  return (start.translation - pose.translation).norm() <= std::sqrt(3.0) * translation_m &&
         turn <= 2 * arc_cosine(std::max(0.0, cosine)) + 1e-9;
}

std::vector<Pose> spread_poses(const Pose& start, const SearchRange& range) {
  constexpr double root = 1.1127756842787055;  // g^7 = g + 1: six-dimensional R sequence
  std::vector<Pose> poses{start};
  for (int i = 1; i <= k_coarse_poses; ++i) {
    std::array<double, 6> side{};  // -1 to 1
    double power = 1;
    for (double& s : side) {
      power /= root;
      s = 2 * std::fmod(0.5 + power * i, 1.0) - 1;
    }
    const Pose turn =
        pose_from_xyz_rpy({0, 0, 0, range.rotation_rad * side[3], range.rotation_rad * side[4],
                           range.rotation_rad * side[5]});
    poses.push_back({(turn.rotation * start.rotation).normalized(),
                     start.translation + range.translation_m * Vector3(side[0], side[1], side[2])});
  }
  return poses;
}

CoarseSearch::CoarseSearch(std::span<const SceneFrame> frames) {
  const int count =
      std::max(k_coarse_points_min, k_coarse_points / std::max(1, static_cast<int>(frames.size())));
  std::size_t cells = 0;
  for (const SceneFrame& frame : frames) {
    pictures_.push_back(coarse_image(frame, count));
    cells = std::max(cells, static_cast<std::size_t>(pictures_.back().cells()));
  }
  cell_depths_.resize(cells);
}

void CoarseSearch::project_points(const CoarseImage& picture, const Pose& T_world_base) {
  const Pinhole& camera = picture.view.camera;
  const Pose T_camera_base = picture.view.T_camera_world * T_world_base;
  const Matrix3 rotation = T_camera_base.rotation.toRotationMatrix();
  points_camera_.clear();
  pixels_.clear();
  std::fill(cell_depths_.begin(), cell_depths_.end(), 0.0f);
  for (const Vector3& point : picture.points) {
    const Vector3 p = rotation * point + T_camera_base.translation;
    points_camera_.push_back(p);
    pixels_.push_back(-1);
    if (!(p.z() > k_render_near_m)) continue;
    const double u = camera.fx * p.x() / p.z() + camera.cx;
    const double v = camera.fy * p.y() / p.z() + camera.cy;
    if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) continue;
    pixels_.back() = static_cast<int>(v) * camera.width + static_cast<int>(u);
    float& depth = cell_depths_[static_cast<std::size_t>(picture.cell_of(pixels_.back()))];
    const auto z = static_cast<float>(p.z());
    if (depth == 0 || z < depth) depth = z;
  }
  for (std::size_t i = 0; i < points_camera_.size(); ++i) {
    if (pixels_[i] < 0) continue;
    const double nearest =
        static_cast<double>(cell_depths_[static_cast<std::size_t>(picture.cell_of(pixels_[i]))]);
    if (points_camera_[i].z() > nearest + k_occlusion_m) pixels_[i] = -2;
  }
}

// Counts points as explained or seen through; hidden and unmeasured points count as neither.
double CoarseSearch::score(const Pose& T_world_base, double gate_m) {
  double points = 0, explained = 0, through = 0, mask_cells = 0, covered = 0;
  for (const CoarseImage& picture : pictures_) {
    project_points(picture, T_world_base);
    const Matrix3 rotation =
        (picture.view.T_camera_world.rotation * T_world_base.rotation).toRotationMatrix();
    for (std::size_t i = 0; i < points_camera_.size(); ++i) {
      if (pixels_[i] == -2) continue;
      ++points;
      if (pixels_[i] < 0) continue;
      const auto pixel = static_cast<std::size_t>(pixels_[i]);
      const double z = static_cast<double>(picture.view.depth_m[pixel]);
      if (!(z > 0)) continue;
      const double behind = z - points_camera_[i].z();
      if (behind > gate_m) through += 1;
      if (std::abs(behind) > gate_m || !picture.view.may_be_model(pixel)) continue;
      const Vector3f normal = (rotation * picture.normals[i]).cast<float>();
      const Vector3f& seen = picture.scene_normals[pixel];
      const bool differs = !(std::abs(normal.dot(seen)) >= k_normal_cosine);
      explained += differs ? k_other_normal : 1;
    }
    mask_cells += static_cast<double>(picture.mask_cells.size());
    for (const int cell : picture.mask_cells) {
      covered += cell_depths_[static_cast<std::size_t>(cell)] > 0 ? 1 : 0;
    }
  }
  const double share = (explained - through) / std::max(1.0, points);
  return share > 0 && mask_cells > 0 ? share * covered / mask_cells : share;
}

bool CoarseSearch::move(Pose& T_world_base, double gate_m) {
  AlignmentSums sums;
  if (pictures_[0].points.empty()) return false;
  const Vector3 middle = T_world_base * pictures_[0].points[pictures_[0].points.size() / 2];
  for (const CoarseImage& picture : pictures_) {
    project_points(picture, T_world_base);
    const Pose T_world_camera = picture.view.T_camera_world.inverse();
    const Matrix3 to_world = T_world_camera.rotation.toRotationMatrix();
    const Matrix3 rotation = T_world_base.rotation.toRotationMatrix();
    for (std::size_t i = 0; i < points_camera_.size(); ++i) {
      if (pixels_[i] < 0) continue;
      const auto pixel = static_cast<std::size_t>(pixels_[i]);
      const double z = static_cast<double>(picture.view.depth_m[pixel]);
      const double away = points_camera_[i].z() - z;
      if (!(z > 0) || !(std::abs(away) <= gate_m) || !picture.view.may_be_model(pixel)) continue;
      const Vector3 ray = to_world * points_camera_[i].normalized();
      Vector3 normal = rotation * picture.normals[i];
      if (normal.dot(ray) > 0) normal = -normal;
      const double cosine = -normal.dot(ray);
      if (cosine < k_cosine_min) continue;
      // Residual along the normal: a surface at grazing incidence has no larger weight.
      sums.add(T_world_camera * points_camera_[i] - middle, normal,
               -away * cosine * points_camera_[i].norm() / points_camera_[i].z(), 1);
    }
  }
  const Result<AlignmentStep> step = solve(sums);
  if (!step) return false;
  T_world_base = moved(T_world_base, step.value, middle);
  return true;
}

Pose CoarseSearch::aligned(Pose T_world_base) {
  for (const auto& [gate_m, steps] : k_coarse_gates) {
    for (int i = 0; i < steps; ++i) {
      if (!move(T_world_base, gate_m)) return T_world_base;
    }
  }
  return T_world_base;
}

std::vector<CoarsePose> CoarseSearch::best(std::span<const Pose> starts, std::size_t count,
                                           double apart_m) {
  const auto by_score = [](const CoarsePose& a, const CoarsePose& b) { return a.score > b.score; };
  std::vector<CoarsePose> poses;
  for (const Pose& start : starts) poses.push_back({start, score(start, k_score_gate_m)});
  std::stable_sort(poses.begin(), poses.end(), by_score);
  if (poses.size() > k_coarse_aligned) poses.resize(k_coarse_aligned);
  for (CoarsePose& pose : poses) {
    pose.T_world_base = aligned(pose.T_world_base);
    pose.score = score(pose.T_world_base, k_end_gate_m);
  }
  std::stable_sort(poses.begin(), poses.end(), by_score);
  std::vector<CoarsePose> distinct;
  for (const CoarsePose& pose : poses) {
    if (distinct.size() == count) break;
    const bool duplicate =
        std::any_of(distinct.begin(), distinct.end(), [&](const CoarsePose& other) {
          return surface_motion_m(pose.T_world_base, other.T_world_base) < apart_m;
        });
    if (!duplicate) distinct.push_back(pose);
  }
  return distinct;
}

double CoarseSearch::surface_motion_m(const Pose& a, const Pose& b) const {
  double squares = 0, points = 0;
  for (const CoarseImage& picture : pictures_) {
    for (const Vector3& point : picture.points) {
      squares += (a * point - b * point).squaredNorm();
      points += 1;
    }
  }
  return std::sqrt(squares / std::max(1.0, points));
}

}  // namespace glint

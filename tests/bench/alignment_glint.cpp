#include "alignment_glint.hpp"

#include <cstdlib>

#include "kernels/registration/align_model.hpp"
#include "thread_seconds.hpp"

namespace glint::bench {
namespace {

// Fraction of the reach, and stride of the source points. Early stages use few points to converge
// quickly; later stages use more for accuracy.
struct Stage {
  double part;
  int step;
};
constexpr Stage k_stages[] = {{1, 16}, {0.5, 8}, {0.25, 4}, {0.125, 2}};
constexpr int k_iterations_max = 60;

Vector3f point_of(const float* xyz, int i) { return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}; }

}  // namespace

CloudAlignment::CloudAlignment(int points) {
  if (grid_.prepare(points) != Reason::none) std::abort();
  some_.reserve(static_cast<std::size_t>(points));
  target_.reserve(static_cast<std::size_t>(points));
}

void CloudAlignment::run(const AlignmentTask& task, Matching matching, AlignmentAnswer& answer) {
  target_.clear();
  for (int i = 0; i < task.target_count; ++i) target_.push_back(point_of(task.target, i));
  const double begin = thread_seconds();
  const AlignmentSettings rest;
  const SceneView no_depth_image{};  // no occlusion
  Pose T;
  for (const Stage& stage : k_stages) {
    const double gate_m = stage.part * static_cast<double>(task.reach_m);
    if (grid_.build(target_, gate_m) != Reason::none) std::abort();
    some_.clear();
    Vector3 middle = Vector3::Zero();
    for (int i = 0; i < task.source_count; i += stage.step) {
      some_.push_back({point_of(task.source, i), point_of(task.normals, i), 0});
      middle += some_.back().point.cast<double>();
    }
    middle /= static_cast<double>(some_.size());
    for (int step = 0; step < k_iterations_max; ++step) {
      AlignmentSums sums;
      const Vector3 about = T * middle;
      add_pairs(some_, T, matching, gate_m, no_depth_image, {&grid_, target_},
                Quaternion::Identity(), about, sums);
      const Result<AlignmentStep> found = solve(sums);
      if (!found) break;
      T = moved(T, found.value, about);
      const double still = stage.step > 1 ? gate_m / 50 : 0;
      if (found.value.translation.norm() < std::max(still, rest.convergence_translation_m) &&
          found.value.rotation.norm() < std::max(still, rest.convergence_rotation_rad)) {
        break;
      }
    }
  }
  answer.seconds = thread_seconds() - begin;
  const Matrix3 rotation = T.rotation.toRotationMatrix();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) answer.matrix[4 * r + c] = rotation(r, c);
    answer.matrix[4 * r + 3] = T.translation(r);
  }
}

}  // namespace glint::bench

#include "kernels/pose/refine_pose.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

using MarkerSpan = std::span<const WeightedMarker>;

// What every fit of one tool in one frame needs.
struct Task {
  const Vector3& reference_m;
  const PosePrior* prior;
  const RefineSettings& settings;
};

Vector3 mean_of(MarkerSpan markers) {
  Vector3 sum = Vector3::Zero();
  for (const WeightedMarker& marker : markers) sum += marker.model_m;
  return sum / static_cast<double>(markers.size());
}

RigidFit rigid_start(MarkerSpan markers) {
  std::array<Vector3, k_markers_per_tool_max> model, measured;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    model[i] = markers[i].model_m;
    measured[i] = markers[i].measured_m();
  }
  return fit_rigid({model.data(), markers.size()}, {measured.data(), markers.size()});
}

void count(const WeightedFit& fit, MarkerSpan markers, RefineWork& work) {
  ++work.fits;
  work.steps += fit.steps;
  work.marker_steps += fit.steps * static_cast<int>(markers.size());
}

bool is_better(const WeightedFit& a, const WeightedFit& b) {
  if (a.reason != Reason::none || b.reason != Reason::none) return a.reason == Reason::none;
  return a.chi_square < b.chi_square;
}

OtherMinimum other_than(const WeightedFit& best, const WeightedFit& second) {
  OtherMinimum other;
  if (second.reason != Reason::none) return other;
  const Vector3 apart =
      rotation_vector(second.T_camera_tool.rotation * best.T_camera_tool.rotation.conjugate());
  const Matrix3 turning =
      best.information.bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>();
  other.exists = apart.dot(turning * apart) > k_minima_apart_least;
  if (!other.exists) return other;
  other.T_camera_tool = second.T_camera_tool;
  other.delta_chi_square = second.chi_square - best.chi_square;
  return other;
}

// All of `markers`, from both starts.
RefinedPose refine_all(MarkerSpan markers, const Task& task, int steps_max) {
  RefinedPose out;
  const Vector3 mean = mean_of(markers);
  const RigidFit start = rigid_start(markers);
  out.reason = task.prior != nullptr ? Reason::none : start.reason;
  if (out.reason != Reason::none) return out;
  const bool two = start.reason == Reason::none;
  const Pose first = two ? start.transform : task.prior->T_camera_tool;
  WeightedFit best = fit_weighted(markers, mean, first, task.prior, steps_max);
  count(best, markers, out.work);
  if (two) {
    const Pose flip = depth_flipped(first, flattest_direction(markers, mean), mean);
    WeightedFit second = fit_weighted(markers, mean, flip, task.prior, steps_max);
    count(second, markers, out.work);
    if (is_better(second, best)) std::swap(best, second);
    out.other = other_than(best, second);
  }
  out.reason = best.reason;
  out.T_camera_tool = best.T_camera_tool;
  out.chi_square = best.chi_square;
  out.degrees_of_freedom = 3 * static_cast<int>(markers.size()) - (task.prior != nullptr ? 0 : 6);
  if (out.reason != Reason::none) return out;
  const Result<PoseFactor> factor = pose_factor(best.information);
  const Vector3 lever = best.T_camera_tool.rotation * (task.reference_m - mean);
  if (factor) out.covariance = moved_covariance(factor.value.inverse(), lever);
  if (!factor || !std::isfinite(out.covariance.sum())) out.reason = Reason::degenerate;
  return out;
}

bool is_explained(const RefinedPose& pose) {
  return pose.reason == Reason::none &&
         pose.chi_square <= chi_square_limit(pose.degrees_of_freedom);
}

void add_work(const RefineWork& more, RefineWork& work) {
  work.fits += more.fits;
  work.steps += more.steps;
  work.marker_steps += more.marker_steps;
}

// The best fit without one of the markers that the noise explains; `all` where there is none.
RefinedPose without_one(MarkerSpan markers, const Task& task, const RefinedPose& all) {
  RefinedPose best = all;
  RefineWork work = all.work;
  std::array<WeightedMarker, k_markers_per_tool_max> others;
  for (std::size_t left_out = 0; left_out < markers.size(); ++left_out) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      if (i != left_out) others[n++] = markers[i];
    }
    RefinedPose pose = refine_all({others.data(), n}, task, task.settings.left_out_steps_max);
    add_work(pose.work, work);
    if (!is_explained(pose)) continue;
    if (best.left_out >= 0 && !(pose.chi_square < best.chi_square)) continue;
    best = pose;
    best.left_out = static_cast<int>(left_out);
  }
  best.work = work;
  return best;
}

}  // namespace

RefinedPose refine_pose(MarkerSpan markers, const Vector3& reference_m, const PosePrior* prior,
                        const RefineSettings& settings) noexcept {
  const std::size_t least = prior != nullptr ? 1 : 3;
  if (markers.size() < least || markers.size() > k_markers_per_tool_max) {
    RefinedPose none;
    none.reason = Reason::too_few_markers;
    return none;
  }
  const Task task{reference_m, prior, settings};
  RefinedPose pose = refine_all(markers, task, settings.steps_max);
  if (is_explained(pose)) return pose;
  if (pose.reason == Reason::none) pose.reason = Reason::bad_fit;
  const int count = static_cast<int>(markers.size());
  if (settings.left_out_max < 1 || count <= settings.markers_left_least) return pose;
  return without_one(markers, task, pose);
}

}  // namespace glint

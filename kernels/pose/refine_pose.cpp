#include "kernels/pose/refine_pose.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

using MarkerSpan = std::span<const WeightedMarker>;

// Inputs of every fit of one tool in one frame.
struct Task {
  const Vector3& reference_m;
  const PosePrior* prior;
  const RefineSettings& settings;
  const PredictedPose* expected;
};

// A fit, the covariance of its reference, and its squared Mahalanobis distance from the prediction.
struct Minimum {
  WeightedFit fit;
  Matrix6 covariance = Matrix6::Zero();
  double mahalanobis_square = 0;
  Reason reason = Reason::none;
  [[nodiscard]] double cost() const { return fit.chi_square + mahalanobis_square; }
};

RigidFit rigid_start(MarkerSpan markers) {
  std::array<Vector3, k_markers_per_tool_max> model, measured;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    model[i] = markers[i].model_m;
    measured[i] = markers[i].measured_m();
  }
  return fit_rigid({model.data(), markers.size()}, {measured.data(), markers.size()});
}

Minimum fit_from(const Pose& start, MarkerSpan markers, const Vector3& mean, const Task& task,
                 int steps_max, double chi_square_stop, RefineWork& work) {
  Minimum found;
  found.fit = fit_weighted(markers, mean, start, task.prior, steps_max, chi_square_stop);
  ++work.fits;
  work.steps += found.fit.steps;
  work.marker_steps += found.fit.steps * static_cast<int>(markers.size());
  found.reason = found.fit.reason;
  if (found.reason != Reason::none) return found;
  const Pose& pose = found.fit.T_camera_tool;
  const Result<PoseFactor> factor = pose_factor(found.fit.information);
  if (factor) {
    const Vector3 lever = pose.rotation * (task.reference_m - mean);
    found.covariance = moved_covariance(factor.value.inverse(), lever);
  }
  if (!factor || !std::isfinite(found.covariance.sum())) {
    found.reason = Reason::degenerate;
  } else if (task.expected != nullptr) {
    found.mahalanobis_square =
        mahalanobis_square(*task.expected, pose, found.covariance, task.reference_m);
  }
  return found;
}

bool is_better(const Minimum& a, const Minimum& b) {
  if (a.reason != Reason::none || b.reason != Reason::none) return a.reason == Reason::none;
  return a.cost() < b.cost();
}

OtherMinimum other_than(const WeightedFit& best, const Minimum& second) {
  OtherMinimum other;
  const Pose& pose = second.fit.T_camera_tool;
  const Vector3 apart = rotation_vector(pose.rotation * best.T_camera_tool.rotation.conjugate());
  const Matrix3 turning =
      best.information.bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>();
  other.exists = apart.dot(turning * apart) > k_minima_apart_min;
  if (!other.exists) return other;
  other.T_camera_tool = pose;
  other.covariance = second.covariance;
  other.delta_chi_square = second.fit.chi_square - best.chi_square;
  other.mahalanobis_square = second.mahalanobis_square;
  return other;
}

// Dot product of the quaternions of a pose and its flip, tilted by 29 degrees to the view.
constexpr double k_shallow_dot = 0.8776;

bool passes_chi_square_test(double chi_square, int degrees_of_freedom) {
  return chi_square <= chi_square_limit(degrees_of_freedom);
}

// Chi-square above which a fit from the flip cannot become a second minimum beside `first`.
double flip_limit(const Minimum& first, MarkerSpan markers, int degrees_of_freedom) {
  const bool is_decided = markers.size() >= 4 && first.reason == Reason::none &&
                          passes_chi_square_test(first.fit.chi_square, degrees_of_freedom);
  return is_decided ? first.fit.chi_square + k_flip_excess_max
                    : std::numeric_limits<double>::infinity();
}

// Fits all of `markers` from both initial guesses.
RefinedPose refine_all(MarkerSpan markers, const Task& task, int steps_max) {
  RefinedPose out;
  out.degrees_of_freedom = 3 * static_cast<int>(markers.size()) - (task.prior != nullptr ? 0 : 6);
  const Vector3 mean = mean_of(markers);
  const RigidFit start = rigid_start(markers);
  out.reason = task.prior != nullptr ? Reason::none : start.reason;
  if (out.reason != Reason::none) return out;
  const bool two = start.reason == Reason::none;
  const Pose first = two ? start.transform : task.prior->T_camera_tool;
  constexpr double k_never = std::numeric_limits<double>::infinity();
  Minimum best = fit_from(first, markers, mean, task, steps_max, k_never, out.work);
  if (two) {
    const Pose flip = depth_flipped(first, flattest_direction(markers, mean), mean);
    const double chi_square_stop = flip_limit(best, markers, out.degrees_of_freedom);
    Minimum second = fit_from(flip, markers, mean, task, steps_max, chi_square_stop, out.work);
    if (is_better(second, best)) std::swap(best, second);
    if (second.reason == Reason::none) {
      out.other = other_than(best.fit, second);
      out.shallow = std::abs(first.rotation.dot(flip.rotation)) > k_shallow_dot &&
                    second.fit.chi_square - best.fit.chi_square < k_odds_min;
    }
  }
  out.reason = best.reason;
  out.T_camera_tool = best.fit.T_camera_tool;
  out.covariance = best.covariance;
  out.chi_square = best.fit.chi_square;
  out.mahalanobis_square = best.mahalanobis_square;
  return out;
}

bool passes_chi_square_test(const RefinedPose& pose) {
  return pose.reason == Reason::none &&
         passes_chi_square_test(pose.chi_square, pose.degrees_of_freedom);
}

// The best fit with one marker removed that passes the chi-square test; `all` if there is none.
RefinedPose without_one(MarkerSpan markers, const Task& task, const RefinedPose& all) {
  RefinedPose best = all;
  RefineWork work = all.work;
  std::array<WeightedMarker, k_markers_per_tool_max> others;
  for (std::size_t rejected = 0; rejected < markers.size(); ++rejected) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      if (i != rejected) others[n++] = markers[i];
    }
    RefinedPose pose = refine_all({others.data(), n}, task, task.settings.rejection_steps_max);
    work += pose.work;
    if (!passes_chi_square_test(pose)) continue;
    if (best.rejected >= 0 &&
        !(pose.chi_square + pose.mahalanobis_square < best.chi_square + best.mahalanobis_square))
      continue;
    best = pose;
    best.rejected = static_cast<int>(rejected);
  }
  best.work = work;
  return best;
}

}  // namespace

RefinedPose refine_pose(MarkerSpan markers, const Vector3& reference_m, const PosePrior* prior,
                        const RefineSettings& settings, const PredictedPose* expected) noexcept {
  const std::size_t least = prior != nullptr ? 1 : 3;
  if (markers.size() < least || markers.size() > k_markers_per_tool_max) {
    RefinedPose none;
    none.reason = Reason::too_few_markers;
    return none;
  }
  const Task task{reference_m, prior, settings, expected};
  RefinedPose pose = refine_all(markers, task, settings.steps_max);
  if (passes_chi_square_test(pose)) return pose;
  if (pose.reason == Reason::none) pose.reason = Reason::bad_fit;
  const int count = static_cast<int>(markers.size());
  if (settings.rejected_max < 1 || count <= settings.markers_kept_min) return pose;
  return without_one(markers, task, pose);
}

}  // namespace glint

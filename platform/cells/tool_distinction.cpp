#include "platform/cells/tool_distinction.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

// Squared distances that differ by less, in sigma squared, are equal, so that rounding does not
// select among the equal exchanges of a symmetric tool.
constexpr double k_equal_distance = 1e-6;

// As required by propose_labelings() without a prediction.
int markers_needed(const Tool& tool) {
  return std::clamp(CorrespondSettings{}.min_markers_without_prior, 3,
                    std::max(3, tool.marker_count));
}

class WrongLabelingSearch {
 public:
  WrongLabelingSearch(const Tool& seen, const Tool& other, int wanted,
                      const DistinctionSettings& settings)
      : seen_(seen),
        other_(other),
        wanted_(wanted),
        variance_m2_(settings.sigma_m * settings.sigma_m),
        steps_max_(settings.steps_max) {
    bound_m2_ = settings.limit_sigmas * settings.limit_sigmas * variance_m2_;
    assignment_.fill(-1);
    best_.assignment = assignment_;
  }

  void run() { assign_from(0, 0.0); }

  // `seen` and `other` are not set.
  [[nodiscard]] WrongLabeling best() const {
    WrongLabeling best = best_;
    best.steps_exhausted = full_;
    return best;
  }
  [[nodiscard]] std::int64_t steps() const { return steps_; }

 private:
  bool spend(std::int64_t steps) {
    if (steps_ + steps > steps_max_) full_ = true;
    if (!full_) steps_ += steps;
    return !full_;
  }

  // Sum of squared differences of the sides to the markers assigned so far.
  [[nodiscard]] double side_differences_m2(int marker, int name) const {
    double sum = 0;
    for (int j = 0; j < marker; ++j) {
      const int other_name = assignment_[at(j)];
      if (other_name < 0) continue;
      const double difference =
          seen_.distance_m[at(marker)][at(j)] - other_.distance_m[at(name)][at(other_name)];
      sum += difference * difference;
    }
    return sum;
  }

  // Recursion depth: at most the number of markers.
  void assign_from(int marker, double differences_m2) {
    if (named_ == wanted_) {
      evaluate_assignment();
      return;
    }
    for (int name = 0; name < other_.marker_count; ++name) {
      if (((used_ >> name) & 1U) != 0) continue;
      if (!spend(1)) return;
      const double sum = differences_m2 + side_differences_m2(marker, name);
      if (!(sum < (named_ + 1) * bound_m2_)) continue;
      assignment_[at(marker)] = name;
      used_ |= 1U << name;
      ++named_;
      assign_from(marker + 1, sum);
      --named_;
      used_ &= ~(1U << name);
      assignment_[at(marker)] = -1;
    }
    if (seen_.marker_count - marker > wanted_ - named_) assign_from(marker + 1, differences_m2);
  }

  void evaluate_assignment() {
    if (&seen_ == &other_ && is_identity()) return;
    if (!spend(k_fit_steps) || !determines_pose()) return;
    const double squares_m2 = residual_squares_m2(seen_, other_, assignment_);
    if (!(squares_m2 < bound_m2_)) return;
    best_.assignment = assignment_;
    best_.markers = named_;
    best_.distance_sigmas = std::sqrt(squares_m2 / variance_m2_);
    bound_m2_ = squares_m2 - k_equal_distance * variance_m2_;
  }

  [[nodiscard]] bool is_identity() const {
    for (int i = 0; i < seen_.marker_count; ++i) {
      if (assignment_[at(i)] != i) return false;
    }
    return true;
  }

  // The tracker's rigid fit refuses other sets.
  [[nodiscard]] bool determines_pose() const {
    std::array<Vector3, k_markers_per_tool_max> model;
    std::size_t count = 0;
    for (const int name : assignment_) {
      if (name >= 0) model[count++] = other_.markers_m[at(name)];
    }
    return rotation_is_fixed_by(std::span(model.data(), count)) == Reason::none;
  }

  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  const Tool& seen_;
  const Tool& other_;
  int wanted_;
  double variance_m2_;
  std::int64_t steps_max_;
  double bound_m2_ = 0;  // bound: only smaller residuals are of interest
  MarkerAssignment assignment_{};
  unsigned used_ = 0;
  int named_ = 0;
  std::int64_t steps_ = 0;
  bool full_ = false;
  WrongLabeling best_;
};

}  // namespace

double residual_squares_m2(const Tool& seen, const Tool& other,
                           const MarkerAssignment& assignment) {
  std::array<Vector3, k_markers_per_tool_max> from, to;
  std::size_t count = 0;
  Vector3 from_mean = Vector3::Zero(), to_mean = Vector3::Zero();
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    if (assignment[i] < 0) continue;
    from[count] = seen.markers_m[i];
    to[count] = other.markers_m[static_cast<std::size_t>(assignment[i])];
    from_mean += from[count];
    to_mean += to[count];
    ++count;
  }
  if (count == 0) return 0;
  from_mean /= static_cast<double>(count);
  to_mean /= static_cast<double>(count);
  Matrix3 cross = Matrix3::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 x = from[i] - from_mean, y = to[i] - to_mean;
    cross += y * x.transpose();
    squares += x.squaredNorm() + y.squaredNorm();
  }
  // Collinear markers are no special case here, as in the tracker's own fit.
  const Vector3 w = Eigen::JacobiSVD<Matrix3>(cross).singularValues();
  const double third = cross.determinant() < 0 ? -w.z() : w.z();
  return std::max(0.0, squares - 2 * (w.x() + w.y() + third));
}

Distinction distinguish(const ToolSet& tools, const DistinctionSettings& settings) {
  Distinction out;
  for (int a = 0; a < tools.count; ++a) {
    for (int b = a; b < tools.count; ++b) {
      const auto tool = [&](int t) -> const Tool& {
        return tools.items[static_cast<std::size_t>(t)];
      };
      const bool swapped = markers_needed(tool(a)) < markers_needed(tool(b));
      const int seen = swapped ? b : a, other = swapped ? a : b;
      const int wanted = a == b ? tool(a).marker_count : markers_needed(tool(other));
      WrongLabelingSearch search(tool(seen), tool(other), wanted, settings);
      search.run();
      out.steps_max_used = std::max(out.steps_max_used, search.steps());
      WrongLabeling best = search.best();
      if (best.markers == 0 && !best.steps_exhausted) continue;
      if (best.markers == 0) best.distance_sigmas = settings.limit_sigmas;
      best.seen = seen;
      best.other = other;
      out.wrong_labelings.push_back(best);
    }
  }
  std::stable_sort(out.wrong_labelings.begin(), out.wrong_labelings.end(),
                   [](const WrongLabeling& x, const WrongLabeling& y) {
                     return x.distance_sigmas < y.distance_sigmas;
                   });
  return out;
}

double error_probability(double distance_sigmas) {
  return 0.5 * std::erfc(distance_sigmas / (2 * std::sqrt(2.0)));
}

}  // namespace glint

#include "platform/tools/calibrate/tool_frame.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/frame_labels.hpp"

namespace glint {
namespace {

constexpr double k_drawn_noise_m = 0.002;  // manufacturing, and size error by uncalibrated ranges

// Sum of squared distances from the centroid.
double spread_m2(const std::vector<Vector3>& points) {
  double squares = 0;
  for (const Vector3& p : points) squares += (p - centroid_of(points)).squaredNorm();
  return squares;
}

// Rotates the markers about their centroid to their principal axes, the longest first. The farthest
// marker along x and along y gets the positive sign.
void rotate_to_principal_axes(std::vector<Vector3>& markers) {
  const Vector3 centroid = centroid_of(markers);
  Matrix3 spread = Matrix3::Zero();
  for (Vector3& m : markers) {
    m -= centroid;
    spread += m * m.transpose();
  }
  const SymmetricEigen principal = symmetric_eigen(spread);
  Matrix3 axes;
  for (int axis = 0; axis < 2; ++axis) {
    Vector3 direction = principal.vectors.col(2 - axis);
    const auto farther = [&](const Vector3& a, const Vector3& b) {
      return std::abs(direction.dot(a)) < std::abs(direction.dot(b));
    };
    if (direction.dot(*std::max_element(markers.begin(), markers.end(), farther)) < 0) {
      direction = -direction;
    }
    axes.row(axis) = direction.transpose();
  }
  axes.row(2) = axes.row(0).cross(axes.row(1));
  for (Vector3& m : markers) m = axes * m;
}

// Transforms into the drawing's frame and marker order.
void register_to(const Tool& drawn, const std::string& what, ToolGeometry& geometry) {
  const PointFrame points{Time{}, geometry.markers_m};
  const Labeling label = label_segment({&points, 1}, {0, 1}, drawn, k_drawn_noise_m).front();
  const std::size_t count = geometry.markers_m.size();
  const auto drawn_count = static_cast<std::size_t>(drawn.marker_count);
  if (count != drawn_count || static_cast<std::size_t>(label.count) != count) {
    throw InputError(what + ": " + std::to_string(label.count) + " of " + std::to_string(count) +
                     " found markers lie within " + format_mm(2 * k_drawn_noise_m) + " of the " +
                     std::to_string(drawn_count) + " drawn of \"" + drawn.name.data() +
                     "\"; expected all of them: show this tool only, each marker in a fifth of the "
                     "frames or more");
  }
  ToolGeometry named = geometry;
  for (std::size_t i = 0; i < count; ++i) {
    const auto from = static_cast<std::size_t>(label.marker[i]);
    named.markers_m[i] = geometry.markers_m[from];
    named.marker_sigma_m[i] = geometry.marker_sigma_m[from];
    named.frame_counts[i] = geometry.frame_counts[from];
  }
  const std::span<const Vector3> as_drawn(drawn.markers_m.data(), count);
  const RigidFit fit = fit_rigid(named.markers_m, as_drawn);
  for (Vector3& marker : named.markers_m) marker = fit.transform * marker;
  named.drawn_rms_m = fit.rms_m;
  geometry = std::move(named);
}

}  // namespace

Vector3 centroid_of(const std::vector<Vector3>& points) {
  Vector3 centroid = Vector3::Zero();
  for (const Vector3& p : points) centroid += p / static_cast<double>(points.size());
  return centroid;
}

double longest_side(const std::vector<Vector3>& markers) {
  double longest = 0;
  for (const Vector3& a : markers)
    for (const Vector3& b : markers) longest = std::max(longest, (a - b).norm());
  return longest;
}

void set_size(const ToolGeometrySettings& settings, ToolGeometry& geometry) {
  const double spread = std::sqrt(spread_m2(geometry.markers_m));
  double sigma = 0;  // a ratio
  if (settings.longest_side_m > 0) {
    geometry.scale = settings.longest_side_m / longest_side(geometry.markers_m);
    sigma = settings.longest_side_sigma_m / settings.longest_side_m;
  } else if (settings.drawn) {
    const Tool& drawn = *settings.drawn;
    const double drawn_spread = std::sqrt(
        spread_m2({drawn.markers_m.begin(), drawn.markers_m.begin() + drawn.marker_count}));
    geometry.scale = drawn_spread / spread;
    sigma = drawn.marker_sigma_m / drawn_spread;
  }
  const Vector3 centroid = centroid_of(geometry.markers_m);
  for (std::size_t i = 0; i < geometry.markers_m.size(); ++i) {
    Vector3& marker = geometry.markers_m[i];
    marker = centroid + geometry.scale * (marker - centroid);
    const double moved_m = sigma * (marker - centroid).norm() / std::sqrt(3.0);  // per axis
    geometry.marker_sigma_m[i] = std::hypot(geometry.scale * geometry.marker_sigma_m[i], moved_m);
  }
}

void set_frame(const ToolGeometrySettings& settings, const std::string& what,
               ToolGeometry& geometry) {
  if (settings.drawn) {
    register_to(*settings.drawn, what, geometry);
  } else {
    rotate_to_principal_axes(geometry.markers_m);
  }
}

}  // namespace glint

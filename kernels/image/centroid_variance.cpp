#include "kernels/image/centroid_variance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

// A pixel of a sharp rim, covered by a fraction u, counts at its own centre instead of the centre
// of its covered part. The error along the rim's normal is u (1 - u) / 2, of variance
// 1/120 - 1/144 for uniform u. A disc of diameter D has 4 D such pixels; half of the sum of the
// squared normals is along each axis. Simulated spheres have half of that variance, because errors
// of adjacent pixels differ, and 1 / r^3 of it for a rim blurred over r pixels.
constexpr double k_rim_sampling_variance = 0.5 * 4 * (1.0 / 120 - 1.0 / 144) / 2;
// If saturation clips a pixel from u = 1 - q on, its light has a variance of q^2 / 12, at half a
// diameter from the centre: 4 D (q^2 / 12) (D^2 / 8). Simulated spheres have two thirds of that.
constexpr double k_rim_clipping_variance = 0.63 / 24;
// Smallest q of a saturated rim: motion blur widens the rim and so hides the clipping.
constexpr double k_clip_min = 1.0 / 3;
// Above this ratio of threshold to signal, too little of the rim is left to estimate its width.
constexpr double k_rim_threshold_ratio_max = 0.25;
constexpr double k_rim_width_min = 0.5;

// Light that a neighbour two pixels away may add to the mask: pixels just below the threshold, on
// one side.
constexpr double k_neighbour_pixels = 3;

double squared(double x) { return x * x; }

struct Disc {
  double area, diameter;
  explicit Disc(double area_px)
      : area(std::max(area_px, 1.0)), diameter(std::sqrt(area * (4 / std::numbers::pi))) {}

  [[nodiscard]] double sampling_variance(double rim_width) const {
    return k_rim_sampling_variance * diameter / (rim_width * rim_width * rim_width * area * area);
  }
  [[nodiscard]] double clipped(double part) const {
    return k_rim_clipping_variance * part * part * diameter * diameter * diameter / (area * area);
  }
};

// Extent of the blob's box along an axis and the lever of its pixels, px.
struct Axis {
  double size, lever;
};

class Variance {
 public:
  Variance(const Centroid& centroid, const Component& component, const BlobSettings& settings)
      : c_(centroid),
        signal_(std::max(c_.peak - c_.background, 1.0)),
        threshold_(std::max(std::max(settings.threshold, component.level) - c_.background, 0.0)),
        rim_(rim(component.area_px, c_.peak >= settings.saturated_from)) {
    const PixelNoise& noise = settings.noise;
    const double uneven = squared(noise.proportional);
    dark_ = squared(noise.read_counts) + noise.shot_counts * c_.background +
            uneven * squared(c_.background);
    bright_ = c_.intensity_sum * (noise.shot_counts + uneven * signal_);
  }

  // The mean squared offset of a disc's pixels from its centre is (size / 4)^2 along an axis.
  [[nodiscard]] float variance_along(const Axis& axis) const {
    const double own = squared(axis.size) / 16, grown = squared(axis.size + 2) / 16;
    const double noisy =
        dark_ * (c_.pixels * grown + squared(axis.lever) / c_.dark_pixels) + bright_ * own;
    const double pulled =
        c_.has_bright_rim ? k_neighbour_pixels * threshold_ * (0.5 * axis.size + 1) : 0;
    return static_cast<float>(rim_ + (noisy + squared(pulled)) / squared(c_.intensity_sum));
  }

 private:
  // A rim r pixels wide has 2 D r more pixels above zero than the area of its light. A fraction of
  // these, twice the ratio of threshold to signal, is below the threshold.
  [[nodiscard]] double rim(double area_px, bool saturated) const {
    const Disc lit(c_.intensity_sum / signal_);
    const double share = threshold_ / signal_;
    if (share >= k_rim_threshold_ratio_max)
      return saturated ? lit.clipped(1) : lit.sampling_variance(1);
    const double width = (area_px - lit.area) / (2 * lit.diameter * (1 - 2 * share));
    return saturated ? lit.clipped(std::clamp(1 - width, k_clip_min, 1.0))
                     : lit.sampling_variance(std::max(width, k_rim_width_min));
  }

  const Centroid& c_;
  double signal_, threshold_;
  double rim_;
  double dark_ = 0, bright_ = 0;  // variance of a background pixel; of all the blob's light
};

}  // namespace

std::array<float, 2> centroid_variance(const Centroid& centroid, const Component& component,
                                       const BlobSettings& settings) noexcept {
  if (centroid.pixels == 0) {  // the plain mean: every pixel has full weight
    const auto all = static_cast<float>(Disc(component.area_px).clipped(1));
    return {all, all};
  }
  const Variance variance(centroid, component, settings);
  return {variance.variance_along(
              {static_cast<double>(component.x1 - component.x0), centroid.lever_px.x()}),
          variance.variance_along(
              {static_cast<double>(component.y1 - component.y0), centroid.lever_px.y()})};
}

std::array<float, 2> shape_variance(const Component& component, bool cut_x, bool cut_y) noexcept {
  const auto missing = static_cast<float>(excess_px(component)) / 2;
  const float x = missing + (cut_x ? k_border_sigma_px : 0),
              y = missing + (cut_y ? k_border_sigma_px : 0);
  return {x * x, y * y};
}

// A step d across the middle adds d / 2 on one side of the grown disc and -d / 2 on the other; the
// mean |x| of a disc of diameter D is 2 D / (3 pi). The samples are beyond the grown blob's rim.
std::array<float, 2> surface_variance(const Frame& frame, const Centroid& centroid,
                                      const Component& component) noexcept {
  constexpr int k_beyond_px = 3;
  constexpr double k_mean_offset = 2 / (3 * std::numbers::pi);
  if (centroid.pixels == 0) return {};
  const auto background_at = [&](int column, int row) {
    const int x = std::clamp(column, 0, frame.width() - 1);
    const int y = std::clamp(row, 0, frame.height() - 1);
    const int value = frame.reflectivity_8.empty() ? int{frame.reflectivity_16.row(y)[x]}
                                                   : int{frame.reflectivity_8.row(y)[x]};
    return std::min(value, int{component.level});
  };
  const auto variance_of = [&](int step, int size) {
    const double offset = 0.5 * step * centroid.pixels * k_mean_offset * (size + 2);
    return static_cast<float>(squared(offset / centroid.intensity_sum));
  };
  const int x = (component.x0 + component.x1) / 2, y = (component.y0 + component.y1) / 2;
  const int step_x = background_at(component.x1 - 1 + k_beyond_px, y) -
                     background_at(component.x0 - k_beyond_px, y);
  const int step_y = background_at(x, component.y1 - 1 + k_beyond_px) -
                     background_at(x, component.y0 - k_beyond_px);
  return {variance_of(step_x, component.x1 - component.x0),
          variance_of(step_y, component.y1 - component.y0)};
}

}  // namespace glint

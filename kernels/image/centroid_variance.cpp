#include "kernels/image/centroid_variance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

// A sharp rim's pixel that is covered by a part u lies at its own middle instead of at that of its
// covered part: along the rim's normal it misses by u (1 - u) / 2, of variance 1/120 - 1/144 for
// even u. A disc of diameter D has 4 D such pixels, and half of their normals' squares falls to an
// axis. Simulated spheres have half of that, as pixels side by side do not miss alike, and of a rim
// smeared over r pixels the r^3-rd part.
constexpr double k_rim_miss = 0.5 * 4 * (1.0 / 120 - 1.0 / 144) / 2;
// Clipped so that it is full from u = 1 - q on, a pixel's light has q^2 / 12 of variance, at half a
// diameter from the middle: 4 D (q^2 / 12) (D^2 / 8). Simulated spheres have two thirds of that.
constexpr double k_rim_clip = 0.63 / 24;
// How far a clipped rim is clipped at least: smear widens it and so hides that it is.
constexpr double k_clip_least = 1.0 / 3;
// A threshold so high leaves too little of the rim to tell its width.
constexpr double k_rim_seen_below = 0.25;
constexpr double k_rim_width_least = 0.5;

// Of the light that a neighbour two pixels away may leave in the mask: pixels just below the
// threshold, on one side.
constexpr double k_neighbour_pixels = 3;

double squared(double x) { return x * x; }

struct Disc {
  double area, diameter;
  explicit Disc(double area_px)
      : area(std::max(area_px, 1.0)), diameter(std::sqrt(area * (4 / std::numbers::pi))) {}

  [[nodiscard]] double missed(double rim_width) const {
    return k_rim_miss * diameter / (rim_width * rim_width * rim_width * area * area);
  }
  [[nodiscard]] double clipped(double part) const {
    return k_rim_clip * part * part * diameter * diameter * diameter / (area * area);
  }
};

// An axis's share of what depends on the blob's size along it.
struct Axis {
  double size, lever;
};

class Variance {
 public:
  Variance(const Centroid& centroid, const Component& component, const BlobSettings& settings)
      : c_(centroid),
        signal_(std::max(c_.peak - c_.background, 1.0)),
        threshold_(std::max(settings.threshold - c_.background, 0.0)),
        rim_(rim(component.area_px, c_.peak >= settings.saturated_from)) {
    const PixelNoise& noise = settings.noise;
    const double uneven = squared(noise.proportional);
    dark_ = squared(noise.read_counts) + noise.shot_counts * c_.background +
            uneven * squared(c_.background);
    bright_ = c_.light * (noise.shot_counts + uneven * signal_);
  }

  // A disc's pixels lie (size / 4)^2 beside its middle in the mean.
  [[nodiscard]] float along(const Axis& axis) const {
    const double own = squared(axis.size) / 16, grown = squared(axis.size + 2) / 16;
    const double noisy =
        dark_ * (c_.pixels * grown + squared(axis.lever) / c_.dark_pixels) + bright_ * own;
    const double pulled =
        c_.beside_bright ? k_neighbour_pixels * threshold_ * (0.5 * axis.size + 1) : 0;
    return static_cast<float>(rim_ + (noisy + squared(pulled)) / squared(c_.light));
  }

 private:
  // A rim r pixels wide has 2 D r pixels more above zero than its light fills, and of these a part
  // of twice the threshold's share of the signal stays below it.
  [[nodiscard]] double rim(double area_px, bool saturated) const {
    const Disc lit(c_.light / signal_);
    const double share = threshold_ / signal_;
    if (share >= k_rim_seen_below) return saturated ? lit.clipped(1) : lit.missed(1);
    const double width = (area_px - lit.area) / (2 * lit.diameter * (1 - 2 * share));
    return saturated ? lit.clipped(std::clamp(1 - width, k_clip_least, 1.0))
                     : lit.missed(std::max(width, k_rim_width_least));
  }

  const Centroid& c_;
  double signal_, threshold_;
  double rim_;
  double dark_ = 0, bright_ = 0;  // of a pixel of the background; of all the blob's light
};

}  // namespace

std::array<float, 2> centroid_variance(const Centroid& centroid, const Component& component,
                                       const BlobSettings& settings) noexcept {
  if (centroid.pixels == 0) {  // the plain mean: every pixel counts as full
    const auto all = static_cast<float>(Disc(component.area_px).clipped(1));
    return {all, all};
  }
  const Variance variance(centroid, component, settings);
  return {
      variance.along({static_cast<double>(component.x1 - component.x0), centroid.lever_px.x()}),
      variance.along({static_cast<double>(component.y1 - component.y0), centroid.lever_px.y()})};
}

std::array<float, 2> shape_variance(const Component& component, bool cut_x, bool cut_y) noexcept {
  const auto missing = static_cast<float>(excess_px(component)) / 2;
  const float x = missing + (cut_x ? k_cut_px : 0), y = missing + (cut_y ? k_cut_px : 0);
  return {x * x, y * y};
}

}  // namespace glint

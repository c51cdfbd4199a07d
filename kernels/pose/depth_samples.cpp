#include "kernels/pose/depth_samples.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_pi = 3.14159265358979323846;
constexpr double k_inner_part = 0.7;           // of the radius: half of the disc's area
constexpr double k_inner_radius_max_px = 3.7;  // holds at most k_inner_samples_max pixel centres
constexpr double k_rim_margin_px = 0.5;        // half a pixel beyond the rim still sees the marker

std::uint16_t reflectivity_at(const Frame& frame, int x, int y) {
  return frame.reflectivity_8.empty() ? frame.reflectivity_16.row(y)[x]
                                      : std::uint16_t{frame.reflectivity_8.row(y)[x]};
}

// The lens around the middle as a quadratic form: how far beside it a pixel's ray lies.
struct Beside {
  double xx, xy, yy;
  explicit Beside(const LocalRays& rays)
      : xx(rays.along_x.squaredNorm()),
        xy(2 * rays.along_x.dot(rays.along_y)),
        yy(rays.along_y.squaredNorm()) {}
  [[nodiscard]] double square(double dx, double dy) const {
    return xx * dx * dx + xy * dx * dy + yy * dy * dy;
  }
};

// Adds the pixel if its depth is of use.
void take(const DepthView& view, const Beside& beside, int x, int y, DepthSamples& out) {
  const std::uint16_t raw = view.frame.depth.row(y)[x];
  if (raw == 0 || raw >= view.depth.invalid_from) return;
  if (reflectivity_at(view.frame, x, y) >= view.depth.saturated_from) return;
  const double dx = x + 0.5 - view.blob.centroid_px.x(), dy = y + 0.5 - view.blob.centroid_px.y();
  DepthSample& sample = out.items[static_cast<std::size_t>(out.count++)];
  sample.range_m = raw * view.depth.unit_m;
  sample.beside_square = beside.square(dx, dy);
  sample.radial_factor = 1;
  if (view.depth.kind == DepthKind::z) {
    const LocalRays& rays = view.rays;
    const double z = rays.ray.z() + rays.along_x.z() * dx + rays.along_y.z() * dy;
    sample.radial_factor = std::sqrt(1 + sample.beside_square) / std::max(z, 0.01);
  }
}

// A square of the frame's pixels, every `step`-th in both directions.
struct Square {
  int x0, y0, x1, y1, step = 1;
  [[nodiscard]] int pixels() const {
    return ((x1 - x0 + step - 1) / step) * ((y1 - y0 + step - 1) / step);
  }
};

Square square_around(const DepthView& view, double outer) {
  const Vector2& middle = view.blob.centroid_px;
  const int width = std::min(view.frame.width(), view.frame.depth.width);
  const int height = std::min(view.frame.height(), view.frame.depth.height);
  Square square;
  square.x0 = std::max(static_cast<int>(std::floor(middle.x() - outer)), 0);
  square.y0 = std::max(static_cast<int>(std::floor(middle.y() - outer)), 0);
  square.x1 =
      std::max(std::min(static_cast<int>(std::floor(middle.x() + outer)) + 1, width), square.x0);
  square.y1 =
      std::max(std::min(static_cast<int>(std::floor(middle.y() + outer)) + 1, height), square.y0);
  return square;
}

// Visits the square's pixels with inner <= distance < outer from the centroid, by rows.
template <class Visit>
void for_each_within(const Square& square, const Vector2& middle, double inner, double outer,
                     Visit visit) {
  const double least = inner * inner, most = outer * outer;
  for (int y = square.y0; y < square.y1; y += square.step) {
    const double dy = y + 0.5 - middle.y();
    for (int x = square.x0; x < square.x1; x += square.step) {
      const double dx = x + 0.5 - middle.x();
      const double distance = dx * dx + dy * dy;
      if (distance >= least && distance < most) visit(x, y);
    }
  }
}

// Takes so many of the candidates that come, evenly spread, so that all round is heard.
class Thinning {
 public:
  Thinning(double candidates, int most)
      : candidates_(std::max(static_cast<int>(candidates), 1)), most_(std::max(most, 0)) {}
  // Source: Bresenham, IBM Systems Journal 4 (1965): the line's error term.
  [[nodiscard]] bool take_next() {
    due_ += std::min(most_, candidates_);
    if (due_ < candidates_) return false;
    due_ -= candidates_;
    return true;
  }

 private:
  int candidates_, most_;
  int due_ = 0;
};

}  // namespace

void inner_samples(const DepthView& view, double radius_px, int most_samples,
                   DepthSamples& out) noexcept {
  // A pixel's centre is at most 0.71 px from any point.
  const double outer = std::clamp(k_inner_part * radius_px, 0.72, k_inner_radius_max_px);
  const int most = std::min(most_samples, k_inner_samples_max);
  Thinning thinning(k_pi * outer * outer, most);
  const Beside beside(view.rays);
  const Square square = square_around(view, outer);
  out.count = out.tried = 0;
  out.pixels = square.pixels();
  for_each_within(square, view.blob.centroid_px, 0, outer, [&](int x, int y) {
    if (!thinning.take_next() || out.tried >= most) return;
    ++out.tried;
    take(view, beside, x, y, out);
  });
}

void ring_samples(const DepthView& view, double radius_px, int most_samples, int most_pixels,
                  DepthSamples& out) noexcept {
  const double outer = std::min(radius_px + k_rim_margin_px, k_scan_radius_max_px - 1.0);
  const double inner = std::min(k_inner_part * radius_px, outer);
  const int most = std::min(most_samples, k_ring_samples_max);
  Square square = square_around(view, outer);
  while (square.pixels() > most_pixels && square.step < 2 * k_scan_radius_max_px) ++square.step;
  const double area = k_pi * (outer * outer - inner * inner) / (square.step * square.step);
  Thinning thinning(area, most);
  const Beside beside(view.rays);
  out.count = out.tried = 0;
  out.pixels = square.pixels();
  for_each_within(square, view.blob.centroid_px, inner, outer, [&](int x, int y) {
    if (reflectivity_at(view.frame, x, y) < view.blob.peak / 4) return;  // mostly background
    if (!thinning.take_next() || out.count >= most) return;
    ++out.tried;
    take(view, beside, x, y, out);
  });
}

}  // namespace glint

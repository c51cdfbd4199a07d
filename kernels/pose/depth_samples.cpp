#include "kernels/pose/depth_samples.hpp"

#include <algorithm>

namespace glint {
namespace {

constexpr double k_inner_part = 0.7;           // of the radius: half of the disc's area
constexpr double k_inner_radius_max_px = 3.7;  // holds at most k_inner_samples_max pixel centres
constexpr double k_rim_margin_px = 0.5;        // half a pixel beyond the rim still sees the marker

constexpr int k_square_side_max_px = 2 * k_scan_radius_max_px;

// A square of the frame's pixels, subsampled by `step` in both directions.
struct Square {
  int x0, y0, columns, rows, step = 1;
  [[nodiscard]] int pixels() const { return columns * rows; }
  // Increases the step until at most so many pixels remain, but at least one.
  void widen_step(int most) {
    const int width = columns, height = rows;
    while (pixels() > std::max(most, 1)) {
      ++step;
      columns = (width + step - 1) / step;
      rows = (height + step - 1) / step;
    }
  }
};

// Index of the pixel that contains the coordinate, at least 0.
int pixel_at(double coordinate) { return coordinate > 0 ? static_cast<int>(coordinate) : 0; }

Square square_around(const DepthView& view, double outer) {
  const Vector2& middle = view.blob.centroid_px;
  const int width = std::min(view.frame.width(), view.frame.depth.width);
  const int height = std::min(view.frame.height(), view.frame.depth.height);
  Square square;
  square.x0 = pixel_at(middle.x() - outer);
  square.y0 = pixel_at(middle.y() - outer);
  square.columns = std::max(std::min(pixel_at(middle.x() + outer) + 1, width) - square.x0, 0);
  square.rows = std::max(std::min(pixel_at(middle.y() + outer) + 1, height) - square.y0, 0);
  return square;
}

// Column, row and raw depth of a pixel in one word: one store, one load.
class DepthPixel {
 public:
  DepthPixel() = default;
  DepthPixel(int column, int row, std::uint16_t raw)
      : all_(static_cast<std::uint32_t>(column | row << 8) | std::uint32_t{raw} << 16) {}
  [[nodiscard]] std::size_t column() const { return all_ & 0xFF; }
  [[nodiscard]] std::size_t row() const { return all_ >> 8 & 0xFF; }
  [[nodiscard]] std::uint32_t raw() const { return all_ >> 16; }

 private:
  std::uint32_t all_;
};
static_assert(k_square_side_max_px <= 256);

struct DepthPixels {
  std::array<DepthPixel, k_square_max_px + 1> items;  // the last one is written, never counted
  int count = 0;
  int tried = 0;
};

// Offsets of a square's columns and rows from the blob's centroid, in pixels.
struct Offsets {
  std::array<double, k_square_side_max_px> x, y;

  Offsets(const Square& square, const Vector2& middle) {
    for (int i = 0; i < square.columns; ++i) {
      x[static_cast<std::size_t>(i)] = square.x0 + i * square.step + 0.5 - middle.x();
    }
    for (int i = 0; i < square.rows; ++i) {
      y[static_cast<std::size_t>(i)] = square.y0 + i * square.step + 0.5 - middle.y();
    }
  }
};

// Annulus: pixels with inner <= distance < outer from the centroid that are not mostly background.
struct Annulus {
  double inner_square, outer_square;
  int reflectivity_min;
  [[nodiscard]] int holds(double distance_square, int reflectivity) const {
    return static_cast<int>(distance_square >= inner_square) &
           static_cast<int>(distance_square < outer_square) &
           static_cast<int>(reflectivity >= reflectivity_min);
  }
};

// Disc: all pixels nearer than outer.
struct FullDisc {
  double outer_square;
  [[nodiscard]] int holds(double distance_square, int) const {
    return static_cast<int>(distance_square < outer_square);
  }
};

// Collects the square's pixels that are inside the shape and have usable depth, by rows. Writes
// every pixel and advances the count only for those: no branch depends on a pixel's value.
template <class Shape, class Pixel>
void read(const DepthView& view, const ImageView<Pixel>& reflectivity, const Square& square,
          const Offsets& offsets, const Shape& shape, DepthPixels& out) {
  // A depth of 0 means none: 0 - 1U is large and fails the test.
  const unsigned raw_end = std::max<unsigned>(view.depth.invalid_from, 1) - 1;
  const int saturated_from = view.depth.saturated_from;
  int count = 0, tried = 0;
  for (int row = 0; row < square.rows; ++row) {
    const int y = square.y0 + row * square.step;
    const std::uint16_t* depth = view.frame.depth.row(y) + square.x0;
    const Pixel* bright = reflectivity.row(y) + square.x0;
    const double dy = offsets.y[static_cast<std::size_t>(row)], dy_square = dy * dy;
    for (int column = 0; column < square.columns; ++column) {
      const double dx = offsets.x[static_cast<std::size_t>(column)];
      const int inside = shape.holds(dx * dx + dy_square, *bright);
      out.items[static_cast<std::size_t>(count)] = DepthPixel(column, row, *depth);
      tried += inside;
      count += inside & static_cast<int>(*depth - 1U < raw_end) &
               static_cast<int>(*bright < saturated_from);
      depth += square.step;
      bright += square.step;
    }
  }
  out.count = count;
  out.tried = tried;
}

// Selects some of `all` indices, evenly spread so that all sides are represented: each the last of
// its interval. Source: Bresenham, IBM Systems Journal 4 (1965): the line's error term.
class Subsampling {
 public:
  // Requires 1 <= taken <= all.
  Subsampling(int all, int taken)
      : taken_(taken),
        stride_(all / taken),
        stride_rest_(all % taken),
        next_((all - 1) / taken),
        rest_((all - 1) % taken) {}
  [[nodiscard]] std::size_t next() {
    const int index = next_;
    rest_ += stride_rest_;
    const bool over = rest_ >= taken_;
    next_ += stride_ + (over ? 1 : 0);
    rest_ -= over ? taken_ : 0;
    return static_cast<std::size_t>(index);
  }

 private:
  int taken_, stride_, stride_rest_, next_, rest_;
};

// Geometry of a pixel from the linearised lens: a quadratic form gives its ray's squared distance
// from the centre ray; a factor converts depth along the axis to radial range.
class PixelGeometry {
 public:
  explicit PixelGeometry(const DepthView& view)
      : rays_(view.rays),
        xx_(broadcast_two(rays_.along_x.squaredNorm())),
        xy_(broadcast_two(2 * rays_.along_x.dot(rays_.along_y))),
        yy_(broadcast_two(rays_.along_y.squaredNorm())),
        unit_m_(broadcast_two(view.depth.unit_m)),
        is_along_axis_(view.depth.kind == DepthKind::z) {}

  void compute(std::size_t at, const TwoDoubles& raw, const TwoDoubles& dx, const TwoDoubles& dy,
               DepthSamples& out) const {
    const TwoDoubles beside = xx_ * dx * dx + xy_ * dx * dy + yy_ * dy * dy;
    TwoDoubles factor = broadcast_two(1);
    if (is_along_axis_) {
      const TwoDoubles z = broadcast_two(rays_.ray.z()) + broadcast_two(rays_.along_x.z()) * dx +
                           broadcast_two(rays_.along_y.z()) * dy;
      factor = square_root(broadcast_two(1) + beside) / maximum(z, broadcast_two(0.01));
    }
    store_two(raw * unit_m_, &out.range_m[at]);
    store_two(beside, &out.offset_square[at]);
    store_two(factor, &out.radial_factor[at]);
  }

 private:
  const LocalRays& rays_;
  TwoDoubles xx_, xy_, yy_, unit_m_;
  bool is_along_axis_;
};

// Writes at most `most` of the readings, in pairs; an odd last one is duplicated.
void take(const DepthView& view, const Offsets& offsets, const DepthPixels& readings, int most,
          DepthSamples& out) {
  out.count = std::min(readings.count, most);
  if (out.count <= 0) return;
  Subsampling subsampling(readings.count, out.count);
  const PixelGeometry geometry(view);
  for (int i = 0; i < out.count; i += 2) {
    const DepthPixel a = readings.items[subsampling.next()];
    const DepthPixel b = i + 1 < out.count ? readings.items[subsampling.next()] : a;
    const TwoDoubles raw{static_cast<double>(a.raw()), static_cast<double>(b.raw())};
    const TwoDoubles dx{offsets.x[a.column()], offsets.x[b.column()]};
    const TwoDoubles dy{offsets.y[a.row()], offsets.y[b.row()]};
    geometry.compute(static_cast<std::size_t>(i), raw, dx, dy, out);
  }
}

template <class Shape>
void sample(const DepthView& view, const Square& square, const Shape& shape, int most,
            DepthSamples& out) {
  const Offsets offsets(square, view.blob.centroid_px);
  DepthPixels readings;
  if (view.frame.reflectivity_8.empty()) {
    read(view, view.frame.reflectivity_16, square, offsets, shape, readings);
  } else {
    read(view, view.frame.reflectivity_8, square, offsets, shape, readings);
  }
  out.pixels = square.pixels();
  out.tried = readings.tried;
  out.usable = readings.count;
  take(view, offsets, readings, most, out);
}

}  // namespace

void inner_samples(const DepthView& view, double radius_px, int samples_max,
                   DepthSamples& out) noexcept {
  // The nearest pixel's centre is at most 0.71 px from any point.
  const double outer = std::clamp(k_inner_part * radius_px, 0.72, k_inner_radius_max_px);
  sample(view, square_around(view, outer), FullDisc{outer * outer},
         std::min(samples_max, k_inner_samples_max), out);
}

void annulus_samples(const DepthView& view, double radius_px, int samples_max, int pixels_max,
                     DepthSamples& out) noexcept {
  const double outer = std::min(radius_px + k_rim_margin_px, k_scan_radius_max_px - 1.0);
  const double inner = std::min(k_inner_part * radius_px, outer);
  Square square = square_around(view, outer);
  square.widen_step(std::min(pixels_max, k_square_max_px));
  sample(view, square, Annulus{inner * inner, outer * outer, view.blob.peak / 4},
         std::min(samples_max, k_annulus_samples_max), out);
}

}  // namespace glint

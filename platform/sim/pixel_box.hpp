// Half-open rectangle of pixels.
#pragma once

#include "kernels/geometry.hpp"
#include "platform/sim/lens_rays.hpp"

namespace glint::sim {

struct PixelBox {
  int x0 = 1 << 20, y0 = 1 << 20, x1 = 0, y1 = 0;  // empty

  void add(const Vector2& pixel, double reach) {
    x0 = min_of(x0, floor_to_int(pixel.x() - reach));
    y0 = min_of(y0, floor_to_int(pixel.y() - reach));
    x1 = max_of(x1, floor_to_int(pixel.x() + reach) + 1);
    y1 = max_of(y1, floor_to_int(pixel.y() + reach) + 1);
  }
  void clip(int width, int height) {
    x0 = max_of(x0, 0);
    y0 = max_of(y0, 0);
    x1 = min_of(x1, width);
    y1 = min_of(y1, height);
  }

 private:
  static int min_of(int a, int b) { return a < b ? a : b; }
  static int max_of(int a, int b) { return a > b ? a : b; }
  static int floor_to_int(double x) {
    const double limited = x < -1e6 ? -1e6 : x > 1e6 ? 1e6 : x;
    return static_cast<int>(limited + 1e6) - 1'000'000;
  }
};

// Angle of the pixel at this position, or of the nearest one in the frame.
[[nodiscard]] inline double finest_pixel_rad(const LensRays& rays, const Vector2& pixel) {
  const double x = pixel.x() < 0 ? 0 : pixel.x() > rays.width() - 1 ? rays.width() - 1 : pixel.x();
  const double y = pixel.y() < 0                   ? 0
                   : pixel.y() > rays.height() - 1 ? rays.height() - 1
                                                   : pixel.y();
  return rays.slopes(static_cast<int>(x), static_cast<int>(y)).finest_rad();
}

}  // namespace glint::sim

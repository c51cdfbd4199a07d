// Table of the camera's unit rays per pixel, computed once for all frames.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint::sim {

class LensRays {
 public:
  explicit LensRays(const CameraModel& model);

  struct Ray {
    float x = 0, y = 0, z = 0;
  };

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool has_ray(int x, int y) const { return mask_[at(x, y)] != 0; }
  // All bits set if the lens maps the pixel, otherwise 0; mask for integer arithmetic.
  [[nodiscard]] const std::uint16_t* mask_row(int y) const { return mask_.data() + at(0, y); }
  // z of the unit ray: converts radial range to depth along the axis.
  [[nodiscard]] const float* z_row(int y) const { return z_.data() + at(0, y); }
  [[nodiscard]] Vector3 ray(int x, int y) const {
    const Ray& r = rays_[at(x, y)];
    return {double{r.x}, double{r.y}, double{r.z}};
  }

  // Derivative of the ray per pixel, to the right and down.
  struct Slopes {
    Vector3 right, down;
    [[nodiscard]] double finest_rad() const;  // smaller angle of a pixel
    [[nodiscard]] double coarsest_rad() const;
  };
  [[nodiscard]] Slopes slopes(int x, int y) const;

 private:
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  Slopes fallback_;
  std::vector<Ray> rays_;
  std::vector<float> z_;
  std::vector<std::uint16_t> mask_;
};

}  // namespace glint::sim

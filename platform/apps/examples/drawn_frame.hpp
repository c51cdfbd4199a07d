// A camera frame with a tool's markers as bright spheres, in memory: the input of the examples.
#pragma once

#include <cmath>
#include <cstdint>
#include <glint/kernels/image/frame.hpp>
#include <glint/kernels/pose/camera_model.hpp>
#include <glint/kernels/pose/tool.hpp>
#include <glint/platform/formats/camera.hpp>
#include <vector>

class DrawnFrame {
 public:
  explicit DrawnFrame(const glint::Camera& camera) : camera_(&camera) {}

  // The frame stays valid until the next call.
  glint::Frame draw(const glint::Tool& tool, const glint::Pose& T_camera_tool, glint::Time time,
                    std::uint64_t sequence) {
    const glint::CameraModel& model = camera_->model;
    const auto pixels = static_cast<std::size_t>(model.width * model.height);
    reflectivity_.assign(pixels, 100);
    depth_.assign(pixels, 0);
    for (std::size_t m = 0; m < static_cast<std::size_t>(tool.marker_count); ++m) {
      draw_sphere(T_camera_tool * tool.markers_m[m], tool.marker_radius_m);
    }
    glint::Frame frame;
    frame.mid_exposure = frame.arrival = time;
    frame.sequence = sequence;
    frame.reflectivity_16 = {reflectivity_.data(), model.width, model.height};
    frame.depth = {depth_.data(), model.width, model.height};
    return frame;
  }

 private:
  void draw_sphere(const glint::Vector3& centre, double radius) {
    const glint::CameraModel& model = camera_->model;
    const auto middle = glint::project(model, centre);
    const int reach = 2 + static_cast<int>(model.fx * radius / centre.z());
    if (!middle) return;
    for (int y = static_cast<int>(middle.value.y()) - reach; y <= middle.value.y() + reach; ++y) {
      for (int x = static_cast<int>(middle.value.x()) - reach; x <= middle.value.x() + reach; ++x) {
        const auto ray = glint::unproject(model, {x + 0.5, y + 0.5});
        if (!ray || x < 0 || y < 0 || x >= model.width || y >= model.height) continue;
        const double along = ray.value.dot(centre);
        const double inside = radius * radius - (centre - along * ray.value).squaredNorm();
        if (inside < 0) continue;
        const auto pixel = static_cast<std::size_t>(y * model.width + x);
        const double range = along - std::sqrt(inside);
        reflectivity_[pixel] = 4000;
        depth_[pixel] = static_cast<std::uint16_t>(std::lround(range / camera_->depth.unit_m));
      }
    }
  }

  const glint::Camera* camera_;
  std::vector<std::uint16_t> reflectivity_, depth_;
};

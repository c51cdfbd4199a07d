// A small pinhole camera and a static tool in the dark. Every nonzero pixel belongs to a marker,
// and a hundred frames render quickly.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/sim/simulator.hpp"

namespace glint::sim {

// 160 x 160, f = 253 px, 16 bit, radial depth in 1 mm steps without wrapping.
inline Camera small_camera() {
  Camera camera;
  camera.name = "small";
  camera.model.width = camera.model.height = 160;
  camera.model.fx = camera.model.fy = 253;
  camera.model.cx = camera.model.cy = 80;
  camera.period = Duration{22'222'222};
  camera.exposure = milliseconds(2);
  camera.transport = milliseconds(8);
  camera.threshold = 1280;
  return camera;
}

inline NoiseSettings no_noise() {
  NoiseSettings noise;
  noise.blob_pixel_sigma_px = 0;
  noise.blob_range_sigma_m = 0;
  noise.read_sigma = 0;
  noise.shot_counts = 0;
  noise.depth_floor_m = 0;
  noise.depth_at_100_counts_m = 0;
  return noise;
}

// Five spheres, at least 40 mm apart in the image plane.
inline Tool five_spheres(MarkerShape shape = MarkerShape::sphere) {
  Tool tool;
  const std::array<Vector3, 5> places{Vector3(0, 0, 0), Vector3(0.05, 0.01, 0.01),
                                      Vector3(-0.045, 0.03, -0.01), Vector3(0.015, -0.06, 0.02),
                                      Vector3(-0.03, -0.05, 0)};
  for (std::size_t i = 0; i < places.size(); ++i) tool.markers_m[i] = places[i];
  tool.marker_count = 5;
  tool.marker_radius_m = 0.0055;
  tool.shape = shape;
  return tool;
}

// The camera at the world's origin with the tool in front of it. Camera and world axes agree.
inline Scenario dark_scene(const Vector3& tool_place = Vector3(0.003, -0.002, 0.5),
                           MarkerShape shape = MarkerShape::sphere) {
  Scenario scenario;
  scenario.camera = small_camera();
  scenario.noise = no_noise();
  scenario.signal.sphere_limb = 1;
  scenario.signal.wall = 0;
  scenario.head = fixed_motion(Pose{});
  ToolBody body;
  body.tool = five_spheres(shape);
  body.motion = fixed_motion({Quaternion::Identity(), tool_place});
  body.disc_normal = Vector3::UnitZ();
  scenario.tools.push_back(body);
  scenario.duration = milliseconds(1000);
  return scenario;
}

struct Measured {
  Vector2 centroid = Vector2::Zero();
  double range_m = 0;   // mean depth within 1.5 px of the centroid
  int zero_depths = 0;  // bright pixels without depth
  int bright = 0;
};

// Centroid of all signal within 12 px of `near`; requires a dark background.
inline Measured measure(const SimFrame& frame, const Vector2& near) {
  Measured result;
  double sum = 0, count = 0, depth = 0;
  Vector2 weighted = Vector2::Zero();
  const Frame view = frame.view();
  const auto visit = [&](auto&& each, const Vector2& middle, double reach) {
    for (int y = 0; y < view.height(); ++y) {
      for (int x = 0; x < view.width(); ++x) {
        const Vector2 place(x + 0.5, y + 0.5);
        if ((place - middle).norm() <= reach) each(x, y, place);
      }
    }
  };
  visit(
      [&](int x, int y, const Vector2& place) {
        const double signal = view.reflectivity_16.row(y)[x];
        sum += signal;
        weighted += signal * place;
        if (signal <= 1280) return;
        ++result.bright;
        if (view.depth.row(y)[x] == 0) ++result.zero_depths;
      },
      near, 12);
  if (sum > 0) result.centroid = weighted / sum;
  visit(
      [&](int x, int y, const Vector2&) {
        if (view.depth.row(y)[x] == 0) return;
        depth += view.depth.row(y)[x] * 0.001;
        ++count;
      },
      result.centroid, 1.5);
  result.range_m = count > 0 ? depth / count : 0;
  return result;
}

inline Vector2 projected(const Scenario& scenario, int marker) {
  const ToolBody& body = scenario.tools.front();
  const Vector3 place =
      body.motion->pose(Time{}) * body.tool.markers_m[static_cast<std::size_t>(marker)];
  return project(scenario.camera.model, place).value;
}

}  // namespace glint::sim

// Synthetic blobs of a tool at varied range and brightness, with a given range bias.
#pragma once

#include <cmath>

#include "platform/cells/tool_file.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/sightings.hpp"

namespace glint::test {

struct DepthScene {
  DepthBias bias{0.006, -0.008, 0.004, 0.01, 10};
  double near_m = 0.3, far_m = 0.8;
  // Peak at 0.5 m; each blob's is a random part of it, from dim_part to 1.
  double peak = 20'000, dim_part = 0.15;
  double peak_exponent = 2;  // exponent of the decrease of brightness with range
  double pixel_sigma_px = 0.1, range_sigma_m = 0.002;
  int frames = 300;
  int strays = 0;
  std::uint64_t seed = 1;
};

// The built-in pen without marker position errors.
inline Tool scene_tool() {
  Tool tool = default_pen();
  tool.marker_sigma_m = 0;
  return tool;
}

class SceneRandom {
 public:
  SceneRandom(std::uint64_t seed, int frame)
      : key_{seed, sim::Stream::points, static_cast<std::uint64_t>(frame)} {}
  double within(double low, double high) {
    return low + (high - low) * sim::uniform(key_, next_++);
  }
  double normal() { return sim::gaussian(key_, next_++); }
  Vector3 vector() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

 private:
  sim::RandomKey key_;
  std::uint64_t next_ = 0;
};

inline bool add_blob(const DepthScene& scene, const Camera& camera, const Vector3& centre,
                     double behind_m, SceneRandom& numbers, BlobFrame& frame) {
  const double right = numbers.normal(), down = numbers.normal(), away = numbers.normal();
  const double part = numbers.within(scene.dim_part, 1);
  const Result<Vector2> pixel = project(camera.model, centre);
  if (!pixel) return false;
  int steps = 0;
  const Vector2 seen = pixel.value + scene.pixel_sigma_px * Vector2(right, down);
  const Result<LocalRays> rays = local_rays(camera.model, seen, k_ray_steps_max, steps);
  if (!rays) return false;
  ObservedBlob blob;
  blob.rays = rays.value;
  const double surface = centre.norm() - behind_m;
  blob.peak = std::floor(scene.peak * part * std::pow(0.5 / surface, scene.peak_exponent));
  // The bias is a function of the measured range: range = surface + bias(range, peak).
  const DepthBias& bias = scene.bias;
  const double at_zero = surface + bias.offset_m - bias.per_metre * DepthBias::k_reference_m +
                         bias.low_signal_m * DepthBias::k_reference_counts / blob.peak;
  blob.surface_range_m = at_zero / (1 - bias.per_metre) + scene.range_sigma_m * away;
  frame.blobs.push_back(blob);
  return true;
}

inline BlobSeries blobs_of(const DepthScene& scene) {
  const Tool tool = scene_tool();
  BlobSeries series;
  series.camera = hololens2_ahat();
  series.brightness = true;
  series.what = "scene";
  Vector3 mean = Vector3::Zero();
  for (int m = 0; m < tool.marker_count; ++m)
    mean += tool.markers_m[static_cast<std::size_t>(m)] / tool.marker_count;
  for (int f = 0; f < scene.frames; ++f) {
    SceneRandom numbers(scene.seed, f);
    const double range = numbers.within(scene.near_m, scene.far_m);
    const Vector3 sight(numbers.within(-0.3, 0.3), numbers.within(-0.3, 0.3), 1);
    Pose pose{from_rotation_vector(0.5 * numbers.vector()), Vector3::Zero()};
    pose.translation = range * sight.normalized() - pose.rotation * mean;
    BlobFrame frame{Time{} + milliseconds(22 * f), {}};
    for (int m = 0; m < tool.marker_count; ++m)
      (void)add_blob(scene, series.camera, pose * tool.markers_m[static_cast<std::size_t>(m)],
                     tool.centre_offset_m(), numbers, frame);
    for (int s = 0; s < scene.strays; ++s)
      (void)add_blob(scene, series.camera, range * sight.normalized() + 0.2 * numbers.vector(), 0,
                     numbers, frame);
    series.frames.push_back(frame);
  }
  return series;
}

}  // namespace glint::test

// Pictures of one sphere each, at a random place between the pixels, with the truth beside them.
//
// What:     the simulator's reflector and sensor on a small frame; where the sphere is off the
// axis,
//           the lens is moved instead, so that the frame stays small.
// Source:   random numbers by counter: picture i depends on the seed and i alone.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sensors/frame_buffer.hpp"
#include "platform/sim/lens_rays.hpp"
#include "platform/sim/noise.hpp"
#include "platform/sim/planes.hpp"
#include "platform/sim/sensor.hpp"

namespace glint {

struct SphereSetting {
  Camera camera;  // its lens; the frame's size is of no interest
  double radius_m = 0.0055;
  double radius_spread_m = 0;  // evenly up to so much more or less, new in every picture
  double range_m = 0.5;        // to the sphere's centre
  double off_axis_rad = 0;
  double peak_counts = 20'000;  // of the sphere's middle, before clipping
  double background_counts = 300;
  double limb = 0.6;         // of the signal that is left at its limb
  Vector2 place_px{32, 32};  // its centre is up to a pixel beyond; the frame is k_side_px wide
  Vector2 other_px{0, 0};    // a second sphere like it is so far away; 0: there is none
  double smear_px = 0;       // travelled during the exposure, in a random direction
  sim::NoiseSettings noise;  // its errors of whole blobs are left out
};

// At this range an on-axis sphere's image has this diameter.
[[nodiscard]] double range_of_diameter(double diameter_px, double focal_px, double radius_m);

class SpherePictures {
 public:
  static constexpr int k_side_px = 64;
  SpherePictures(const SphereSetting& setting, std::uint64_t seed);

  struct Truth {
    Vector2 centre_px = Vector2::Zero();  // where the sphere's centre projects, mid-exposure
    Vector3 centre_m = Vector3::Zero();   // camera frame
  };
  Truth render(std::uint64_t number, FrameBuffer& out);

  // The setting's camera with a small frame about the place that the sphere is seen at.
  [[nodiscard]] const Camera& camera() const { return setting_.camera; }

 private:
  void draw_sphere(std::uint64_t number, const Vector2& pixel);

  SphereSetting setting_;
  std::uint64_t seed_;
  sim::LensRays rays_;
  sim::Sensor sensor_;
  sim::Planes planes_;
};

}  // namespace glint

// Rendered images of one sphere each at a random subpixel position, with ground truth.
//
// What:     the simulator's reflector and sensor on a small frame. For a sphere off the axis the
//           principal point is moved, so that the frame stays small.
// Source:   counter-based random numbers: image i depends on the random seed and i alone.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"
#include "platform/sim/lens_rays.hpp"
#include "platform/sim/noise.hpp"
#include "platform/sim/planes.hpp"
#include "platform/sim/sensor.hpp"

namespace glint {

struct SphereSetting {
  Camera camera;  // its lens is used, its frame size is not
  double radius_m = 0.0055;
  double radius_spread_m = 0;  // uniform, up to this more or less, drawn for each image
  double range_m = 0.5;        // to the sphere's centre
  double off_axis_rad = 0;
  double peak_counts = 20'000;  // of the sphere's middle, before clipping
  double background_counts = 300;
  double limb = 0.6;         // fraction of the signal that remains at the limb
  Vector2 place_px{32, 32};  // the centre is up to a pixel beyond; the frame is k_side_px wide
  Vector2 second_offset_px{0, 0};  // offset of a second, equal sphere; 0: none
  double smear_px = 0;             // motion during the exposure, in a random direction
  sim::NoiseSettings noise;        // without its errors of whole blobs
};

// Returns the range at which the image of an on-axis sphere has this diameter.
[[nodiscard]] double range_of_diameter(double diameter_px, double focal_px, double radius_m);

class SphereImages {
 public:
  static constexpr int k_side_px = 64;
  SphereImages(const SphereSetting& setting, std::uint64_t seed);

  struct Truth {
    Vector2 centre_px = Vector2::Zero();  // projection of the sphere's centre at mid-exposure
    Vector3 centre_m = Vector3::Zero();   // camera frame
  };
  Truth render(std::uint64_t number, FrameBuffer& out);

  // The setting's camera, with a small frame around the sphere's image position.
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

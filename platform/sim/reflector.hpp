// Renders a retro-reflective sphere or flat disc with antialiased edges into the noise-free image.
//
// What:     computes the coverage of each pixel from k_edge_samples squared rays at edges and one
//           inside. If the reflector moves by more than k_blur_step_px during the exposure, samples
//           several positions. Signal and range of a partly covered pixel mix with the background,
//           weighted by signal, as in the sensor.
// Accuracy: the centroid of the rendered signal is within 0.01 px of the projected silhouette's.
#pragma once

#include <span>

#include "platform/sim/lens_rays.hpp"
#include "platform/sim/planes.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

inline constexpr int k_edge_samples = 8;
inline constexpr double k_blur_step_px = 0.25;
inline constexpr int k_exposures_max = 8;

// Camera frame, metres.
struct Reflector {
  Vector3 centre = Vector3::UnitZ();  // at mid-exposure
  Vector3 travel = Vector3::Zero();   // from the begin to the end of the exposure
  Vector3 normal = Vector3::Zero();   // zero: a sphere
  double radius_m = 0;
  double signal = 0;           // counts at 0.5 m, normal incidence
  double limb = 1;             // sphere: relative signal at its limb
  double range_error_m = 0;    // added to all its ranges
  int tool = -1, marker = -1;  // -1: clutter
  int index = 0;               // in the order of build_scene()

  [[nodiscard]] bool is_disc() const { return normal.squaredNorm() > 0; }
};

struct RenderedReflector {
  Vector2 pixel = Vector2::Zero();  // of the centre, mid-exposure
  double radius_px = 0;
  double peak_signal = 0;       // 0: no light reaches the image
  double visible_fraction = 0;  // share of its disc with a ray, not hidden; 0: cut by the image
};

// occluders: possible occluders (camera frame).
RenderedReflector draw(const Reflector& reflector, const CameraModel& model, const LensRays& rays,
                       std::span<const Capsule> occluders, Planes& planes);

// The signal of a capsule replaces everything at larger range.
void draw(const Capsule& capsule, const CameraModel& model, const LensRays& rays, Planes& planes);

}  // namespace glint::sim

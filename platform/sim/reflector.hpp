// A retro-reflective sphere or flat disc, drawn with soft edges into the perfect picture.
//
// What:     coverage of each pixel by k_edge_samples squared rays where its edge passes, one
// inside;
//           several positions during the exposure where it moves by more than k_blur_step_px.
//           Signal and range of a partly covered pixel mix with what is behind, weighted by signal,
//           as they do in the sensor.
// Accuracy: the centroid of the drawn signal is within 0.01 px of the projected silhouette's.
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
  Vector3 travel = Vector3::Zero();   // from the exposure's begin to its end
  Vector3 normal = Vector3::Zero();   // zero: a sphere
  double radius_m = 0;
  double signal = 0;           // counts at 0.5 m, head on
  double limb = 1;             // sphere: share of the signal left at its limb
  double range_error_m = 0;    // added to all its ranges
  int tool = -1, marker = -1;  // -1: clutter
  int index = 0;               // in the order in which the scene was built

  [[nodiscard]] bool is_disc() const { return normal.squaredNorm() > 0; }
};

struct Drawn {
  Vector2 pixel = Vector2::Zero();  // of the centre, mid-exposure
  double radius_px = 0;
  double peak_signal = 0;  // 0: it sends no light into the image
  double open_share = 0;   // of its disc: with a ray, not hidden; 0: not all inside the image
};

// hiders: what may stand before it (camera frame).
Drawn draw(const Reflector& reflector, const CameraModel& model, const LensRays& rays,
           std::span<const Capsule> hiders, Planes& planes);

// What a capsule sends back replaces whatever is further away.
void draw(const Capsule& capsule, const CameraModel& model, const LensRays& rays, Planes& planes);

}  // namespace glint::sim

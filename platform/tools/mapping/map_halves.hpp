// Split-half evaluation of a map: maps from the even and the odd images of a sequence.
#pragma once

#include <vector>

#include "platform/tools/mapping/depth_sequence.hpp"
#include "platform/tools/mapping/map_chain.hpp"

namespace glint {

// One plane of the first half's map, before projection of points onto it.
struct PlaneAgreement {
  int points = 0;
  bool matched = false;           // the other half has a plane within 10 degrees and 30 mm
  double angle_deg = 0;           // between the planes of the two halves
  double offset_m = 0;            // between them at the centroid of the first one's points
  double voxel_rms_m = 0;         // distance of its points from the plane, before smoothing
  double smooth_rms_m = 0;        // the same after smoothing
  double held_out_m = 0;          // mean signed distance of the other half's raw points
  std::int64_t held_out = 0;      // number of those points
  double wrong_normal_share = 0;  // as in MapHalves, for this plane's points
};

struct MapHalves {
  std::vector<PlaneAgreement> planes;  // largest first, at most three
  // Of all points projected onto planes: the largest displacement; the number for which the other
  // half's map has a surface within 50 mm (evaluated); the share of those whose surface normal
  // differs by more than 20 degrees from the plane's.
  double displacement_max_m = 0;
  std::int64_t projected = 0, evaluated = 0;
  double wrong_normal_share = 0;
};

// Compares the images of even index with those of odd index.
[[nodiscard]] MapHalves compare_halves(const DepthSequence& sequence, const MapSettings& settings);

}  // namespace glint

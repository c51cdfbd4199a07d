// A map judged by a second one of the same place: from every other picture of a sequence.
#pragma once

#include <vector>

#include "platform/mapping/depth_sequence.hpp"
#include "platform/mapping/map_chain.hpp"

namespace glint {

// One plane of the first half's map, before anything is moved onto it.
struct PlaneAgreement {
  int points = 0;
  bool matched = false;       // the other half has a plane within 10 degrees and 30 mm
  double angle_deg = 0;       // between the two halves' planes
  double offset_m = 0;        // between them at the middle of the first one's points
  double voxel_rms_m = 0;     // of its points before smoothing, from the plane
  double smooth_rms_m = 0;    // of the same points after it
  double held_out_m = 0;      // mean height of the other half's raw points over it
  std::int64_t held_out = 0;  // how many
  double swallowed_part = 0;  // as in MapHalves, of this plane's points
};

struct MapHalves {
  std::vector<PlaneAgreement> planes;  // the largest first, at most three
  // Of all points moved onto planes: the furthest move; how many of them the other half's map has
  // a surface at, within 50 mm, and which part of those has its normal more than 20 degrees from
  // their plane's.
  double moved_most_m = 0;
  std::int64_t snapped = 0, judged = 0;
  double swallowed_part = 0;
};

// The pictures with even places in the sequence against the odd ones.
[[nodiscard]] MapHalves compare_halves(const DepthSequence& sequence, const MapSettings& settings);

}  // namespace glint

// Settings, search call and marker list shared by the correspondence tests.
#pragma once

#include <vector>

#include "kernels/pose/correspond.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::test {

inline CorrespondSettings ahat() {
  CorrespondSettings settings;
  settings.focal_px = 253;
  return settings;
}

inline Labelings labelings_of(const Markers& markers, const Tool& tool,
                              const CorrespondSettings& settings, const Pose* prior = nullptr) {
  Labelings labelings;
  static CorrespondScratch scratch;
  propose_labelings(markers, tool, settings, prior, scratch, labelings);
  return labelings;
}

inline Markers centres(const Tool& tool, const std::vector<Vector3>& points) {
  Markers markers;
  for (const Vector3& point : points) add_marker(markers, tool, point);
  return markers;
}

}  // namespace glint::test

// Partial visibility: identifies one or two visible markers of a predicted tool by validation
// gates, where no labeling by distances is possible.
//
// What:     each marker of a predicted tool has a gate, an ellipsoid at significance level 1e-4,
//           from the prediction's covariance at its position and the declared measurement noise. A
//           marker is identified under four conditions. (1) Exactly one gate of all tools contains
//           it, and that gate contains no other free marker. (2) No other gate of the tool can
//           overlap that gate. (3) The tool has one or two filled gates, since three should have
//           given a pose. (4) The marker has depth and is not merged, partially occluded or cut by
//           the border, which displaces the centroid. Two identified markers must also have the
//           tool's distance.
// Cost:     a Cholesky factor for each gate, a test of nine multiplications for each gate and
//           marker.
// Worst:    all tools predicted, the capacity of markers. Their positions make no difference.
// Accuracy: a stray reflection in the gate of a hidden marker is identified as that marker. The
//           error is at most the gate's width, less than half of the tool's least distance.
// Source:   validation gates and their exclusive use: Bar-Shalom, Li and Kirubarajan 2001, section
//           1.5 (nearest neighbour), made strict: a marker in two gates belongs to neither.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

inline constexpr int k_partial_markers_max = 2;  // three give a pose

struct IdentifiedMarker {
  int of_tool = 0;                     // index of the tool's marker
  Vector3 centre_m = Vector3::Zero();  // as measured, camera frame
  Matrix3 covariance_m2 = Matrix3::Zero();
};
struct PartialMarkers {
  std::array<IdentifiedMarker, k_partial_markers_max> items;
  int count = 0;
};

// A tool at its predicted pose. covariance: of the mean of its markers and of its rotation, about
// the camera's axes.
struct PredictedTool {
  const Tool* tool = nullptr;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  bool predicted = false;       // false: it has no gates
  bool needs_labeling = false;  // it has no labeling, so its markers are to be identified
};

using TakenMarkers = std::bitset<k_blobs_max>;

struct PartialScratch {
  struct Gate {
    Vector3 predicted_m = Vector3::Zero();
    Matrix3 whitening = Matrix3::Zero();  // |whitening * residual|^2 is its chi-square
    bool is_disjoint = false;             // overlaps no other gate of the same tool
    int free_count = 0;                   // markers in it that no labeling contains
    int marker = -1;                      // the last of them
  };
  std::array<std::array<Gate, k_markers_per_tool_max>, k_tools_max> gates;
  std::array<std::uint8_t, k_blobs_max> gate_count{};  // number of gates that contain the marker
  std::array<double, k_blobs_max> range_m{};  // ranges of marker centres for the current tool
};

struct PartialWork {
  int gates = 0;
  int tests = 0;  // of a marker in a gate; its range, once per tool, counts as one
};

// taken: markers of labelings. Reads at most markers_max markers. `named` has one element per tool.
PartialWork identify_partial(std::span<const PredictedTool> tools, const Markers& markers,
                             int markers_max, const TakenMarkers& taken, const MarkerNoise& noise,
                             PartialScratch& scratch,
                             std::span<PartialMarkers> named) noexcept GLINT_NONBLOCKING;

}  // namespace glint

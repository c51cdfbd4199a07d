// Which markers can only be one tool's, where too few are in view to name them by their distances.
//
// What:     each predicted tool's markers get a gate, the ellipsoid that holds a marker but once in
//           10^4: the prediction's covariance at its place and the declared noise of a measurement.
//           A marker is named where one gate alone holds it, of all tools', and it is alone there;
//           where no other of the tool's gates can meet this one; where the tool has one or two
//           filled gates, for of three a pose should have come; and where it is whole in the image,
//           as one half behind a hand lies beside its place. Two have to be as far apart as they
//           should.
// Cost:     a Cholesky factor for each gate, a test of nine multiplications for each gate and
//           marker.
// Worst:    all tools predicted, as many markers as there may be. Where they lie makes no
//           difference.
// Accuracy: a stray in the gate of a hidden marker is taken for it: wrong by no more than the gate
//           is wide, which is less than half of the tool's least distance.
// Source:   validation gates and their exclusive use: Bar-Shalom, Li and Kirubarajan 2001, section
//           1.5 (nearest neighbour), made strict: what two may claim nobody gets.
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

inline constexpr int k_few_max = 2;  // three are a pose

struct NamedMarker {
  int of_tool = 0;                     // the tool's marker
  Vector3 centre_m = Vector3::Zero();  // as measured, camera frame
  Matrix3 covariance_m2 = Matrix3::Zero();
};
struct FewMarkers {
  std::array<NamedMarker, k_few_max> items;
  int count = 0;
};

// A tool where it was predicted: covariance of the middle of its markers, about the camera's axes.
struct ExpectedTool {
  const Tool* tool = nullptr;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  bool predicted = false;  // otherwise it has no gates
  bool wanted = false;     // it has no labeling: its markers are to be named
};

using TakenMarkers = std::bitset<k_blobs_max>;

struct FewScratch {
  struct Gate {
    Vector3 place_m = Vector3::Zero();
    Matrix3 whiten = Matrix3::Zero();  // a residual's squared length by it is its chi square
    bool apart = false;                // meets no other gate of the same tool
    int held = 0;                      // markers in it that no labeling has taken
    int marker = -1;                   // the last of them
  };
  std::array<std::array<Gate, k_markers_per_tool_max>, k_tools_max> gates;
  std::array<std::uint8_t, k_blobs_max> claims{};  // gates that hold the marker
  std::array<double, k_blobs_max> range_m{};       // to each marker's centre, were it this tool's
};

struct FewWork {
  int gates = 0;
  int tests = 0;  // of a marker in a gate; its range, once for each tool, counts as one
};

// taken: markers that a labeling holds. markers_max of the markers are looked at. One element of
// `named` for each tool.
FewWork name_few(std::span<const ExpectedTool> tools, const Markers& markers, int markers_max,
                 const TakenMarkers& taken, const MarkerNoise& noise, FewScratch& scratch,
                 std::span<FewMarkers> named) noexcept GLINT_NONBLOCKING;

}  // namespace glint

// Candidate markers of one tool, as points: selection by depth, range, area and prediction.
//
// What:     removes markers without depth, those out of range, and those whose area cannot be the
//           tool's marker at that range. With a prediction, marks the candidates near each
//           predicted marker, and puts those near any of them first.
// Cost:     one pass over the markers, for each of them one over the tool's markers.
// Worst:    every marker is a candidate.
// Accuracy: exact.
// Source:   the area of a sphere's image, pi (f r / z)^2.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/correspond_settings.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Bit set of candidate indices. Loops run over the `words` in use, not over all.
struct CandidateSet {
  std::array<std::uint64_t, k_blobs_max / 64> word;

  void insert(int i) { word[static_cast<unsigned>(i) / 64] |= bit(i); }
  [[nodiscard]] static std::uint64_t bit(int i) {
    return std::uint64_t{1} << (static_cast<unsigned>(i) % 64);
  }
};

// One set for each of the tool's markers.
using CandidateSets = std::array<CandidateSet, k_markers_per_tool_max>;

struct Candidates {
  std::array<Vector3, k_blobs_max> point_m;  // marker centres, camera frame
  std::array<Vector3, k_blobs_max> ray;
  std::array<double, k_blobs_max> across_variance_m2;  // of the centre, across its ray, per axis
  std::array<std::int16_t, k_blobs_max> marker;        // index into Markers
  int count = 0;
  int words = 0;                  // of a CandidateSet that are in use
  CandidateSets in_prior_gate;    // per tool marker: within prior_gate_m of its prediction
  CandidateSets in_partial_gate;  // per tool marker: within partial_gate_m of it
};

// The prior may be null. Returns the number of markers read.
int select_candidates(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                      const Pose* prior_T_camera_tool,
                      Candidates& candidates) noexcept GLINT_NONBLOCKING;

}  // namespace glint

// Second search of components beyond the size gate, at a higher level: separates a marker from the
// bright surface (hand, table) with which it is one component.
//
// What:     the pixels of such a component above a level, as new runs and components; those still
//           beyond the gate are searched again. The level is 1.5 times the component's mean, and
//           at least three mean absolute deviations above it.
// Cost:     four samples a run, once for each run; blocks of 64 bytes, at least one a run; the new
//           runs as those of the frame. All levels together scan at most the blocks of a frame and
//           use the runs that the frame leaves of runs_max. If either budget is full, the first
//           runs are kept and the result is Reason::runs_full.
// Worst:    the complete frame above the threshold, with a second level of random short runs.
// Accuracy: exact; integers only. A marker needs 2.25 times an even surface's light.
// Source:   tree of the components over all thresholds: Matas et al., "Robust wide-baseline stereo
//           from maximally stable extremal regions", Image and Vision Computing 22 (2004). The
//           factors are our own choice.
#pragma once

#include <cstdint>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct Rescan {
  std::int32_t blocks = 0;  // of 64 bytes
  Reason reason = Reason::none;
};

// Appends to scratch.runs and scratch.components; requires the result of find_components() of this
// frame. runs_max: of all runs in the scratch, at most k_runs_max; blocks_max: of the result.
[[nodiscard]] Rescan rescan_oversized(const Frame& frame, std::uint32_t max_area_px, int runs_max,
                                      int blocks_max,
                                      BlobScratch& scratch) noexcept GLINT_NONBLOCKING;

// True if the centre of a component's box is bright enough for a marker on the component's surface.
// Requires a component of rescan_oversized().
[[nodiscard]] bool has_marker_contrast(const Frame& frame,
                                       const Component& component) noexcept GLINT_NONBLOCKING;

// Maximum of Rescan::blocks: the blocks of a frame.
[[nodiscard]] constexpr int rescan_blocks_max(const Limits& limits) {
  return limits.width * limits.height * limits.reflectivity_bytes / 64;
}

}  // namespace glint

// Runs to connected components.
//
// What:     joins runs of neighbouring rows that touch by a side or a corner (8-connectivity), also
//           across the border of two bands.
// Cost:     linear: of two rows with p and q runs at most p + q - 1 pairs touch, so that there are
//           fewer than two pairs a run. The searches for roots are linear, too, as one row is done
//           before the next begins, and shortened on the way.
// Worst:    a checkerboard, for its pairs; single dots, for their components; dots at random, for
//           what the processor cannot foresee.
// Accuracy: exact, integers only.
// Source:   He, Chao, Suzuki, "A run-based two-scan labeling algorithm", IEEE TIP 17 (2008), with
//           union-find by the first run and path halving in place of its table of labels; for its
//           cost by lines: Fiorio, Gustedt, "Two linear time Union-Find strategies for image
//           processing", Theoretical Computer Science 154 (1996).
#pragma once

#include <span>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// bands: from top to bottom, at most k_row_bands of them, at most runs_per_band of each. Fills
// scratch.runs and scratch.components, ordered by each component's first run: top first, then left
// first.
void find_components(std::span<const Runs* const> bands, BlobScratch& scratch,
                     int runs_per_band = k_runs_per_band_max) noexcept GLINT_NONBLOCKING;

}  // namespace glint

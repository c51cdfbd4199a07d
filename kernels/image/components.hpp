// Connected-component labelling of runs (8-connectivity, union-find).
//
// What:     joins runs of neighbouring rows that touch by a side or a corner, also across the
//           border of two bands.
// Cost:     linear: two rows with p and q runs have at most p + q - 1 touching pairs, so fewer than
//           two pairs a run. The root searches are linear too, because one row is complete before
//           the next begins, and each search shortens its path.
// Worst:    a checkerboard, for its pairs; single dots, for their components; random dots, for
//           mispredicted branches.
// Accuracy: exact, integers only.
// Source:   He, Chao, Suzuki, "A run-based two-scan labeling algorithm", IEEE TIP 17 (2008), with
//           union-find by the first run and path halving in place of its table of labels; for its
//           cost by lines: Fiorio, Gustedt, "Two linear time Union-Find strategies for image
//           processing", Theoretical Computer Science 154 (1996).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// bands: from top to bottom; reads at most k_row_bands, and at most runs_per_band runs of each.
// Fills scratch.runs and scratch.components, the latter in order of their first run: top first,
// then left first.
void find_components(std::span<const Runs* const> bands, BlobScratch& scratch,
                     int runs_per_band = k_runs_per_band_max) noexcept GLINT_NONBLOCKING;

// Appends the components of the runs from first_run on. Requires these in row-major order; runs of
// one row do not touch. level: see Component.
void append_components(BlobScratch& scratch, int first_run,
                       std::uint16_t level) noexcept GLINT_NONBLOCKING;

}  // namespace glint

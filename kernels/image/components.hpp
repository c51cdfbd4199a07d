// Runs to connected components.
//
// What:     joins runs of neighbouring rows that touch by a side or a corner (8-connectivity), also
//           across the border of two bands.
// Cost:     linear in the runs: each run meets its upper neighbours once; union by the smaller
//           index with path halving.
// Worst:    combs that join late: log(runs) steps a find.
// Accuracy: exact, integers only.
// Source:   He, Chao, Suzuki, "A run-based two-scan labeling algorithm", IEEE TIP 17 (2008);
//           path halving: Tarjan, van Leeuwen, JACM 31 (1984), section 2.
#pragma once

#include <span>

#include "kernels/image/blob_scratch.hpp"

namespace glint {

// bands: from top to bottom, at most k_row_bands of them. Fills scratch.runs and
// scratch.components, ordered by each component's first run: top first, then left first.
void find_components(std::span<const Runs* const> bands, BlobScratch& scratch) noexcept;

}  // namespace glint

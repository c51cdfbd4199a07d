// Agreement of the points of two implementations of the cloud filter chain.
#pragma once

#include <vector>

namespace glint::bench {

struct Agreement {
  double share = 0;  // fraction of the larger side's points with a partner
  double p99_m = 0;  // of the distances between partners
  double max_m = 0;
};

// Points are interleaved x, y, z. Partners are mutual nearest neighbours, at most within_m (and 10
// mm) apart.
[[nodiscard]] Agreement agreement_of(const std::vector<float>& a, const std::vector<float>& b,
                                     double within_m);

}  // namespace glint::bench

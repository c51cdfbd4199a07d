// How far two ways through the cloud chain agree.
#pragma once

#include <vector>

namespace glint::bench {

struct Agreement {
  double share = 0;  // of the larger side's points that have a partner
  double p99_m = 0;  // of the partners' distances
  double max_m = 0;
};

// Points as x, y, z side by side. Partners are each the nearest of the other, at most within_m
// (and 10 mm) apart.
[[nodiscard]] Agreement agreement_of(const std::vector<float>& a, const std::vector<float>& b,
                                     double within_m);

}  // namespace glint::bench

#include "platform/experiments/case_experiments.hpp"

#include <vector>

namespace glint {

std::span<const CaseExperiment> case_experiments() {
  static const std::vector<CaseExperiment> k_experiments = {};
  return k_experiments;
}

}  // namespace glint

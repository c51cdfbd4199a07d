#include "platform/experiments/case_experiments.hpp"

#include <vector>

#include "platform/experiments/centroid_experiment.hpp"

namespace glint {

std::span<const CaseExperiment> case_experiments() {
  static const std::vector<CaseExperiment> k_experiments = {
      {"centroid", "rendered spheres: how far centroids are off, and whether they say so", false,
       run_centroid_experiment},
  };
  return k_experiments;
}

}  // namespace glint

// Glint's side of the cloud benchmark.
#pragma once

#include <memory>

#include "cloud_steps.hpp"
#include "kernels/cloud/point_cloud.hpp"

namespace glint::bench {

// Allocates once, for clouds up to this many points.
class CloudChain {
 public:
  CloudChain(const CloudStepSettings& settings, int points);
  ~CloudChain();
  void run(const float* xyz, int count, CloudStepResult& result);
  // Result of the last run, with normals.
  [[nodiscard]] const PointCloud& smoothed() const;

 private:
  struct Kernels;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace glint::bench

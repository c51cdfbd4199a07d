// One picture of a sphere, located by every method that the experiment `centroid` compares.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "kernels/image/blobs.hpp"
#include "kernels/image/run.hpp"
#include "kernels/pose/back_project.hpp"
#include "platform/sensors/camera.hpp"

namespace glint {

class SeedFrontEnd;

class CentroidMethods {
 public:
  // nominal: of back-projection. noise: what the stated variances follow from.
  CentroidMethods(const Camera& camera, const PixelNoise& noise, const NominalMarker& nominal);
  ~CentroidMethods();

  // Of the blob nearest to the truth, and within k_near_px of it. Nothing where there is none.
  struct Located {
    Blob blob;
    std::optional<Marker> marker;
    Vector2 weighted, binary;  // the same blob's
  };
  static constexpr double k_near_px = 16;
  [[nodiscard]] std::optional<Located> locate(const Frame& frame, const Vector2& truth_px);

  // By the published method.
  [[nodiscard]] std::optional<Vector2> locate_as_seed(const Frame& frame, const Vector2& truth_px);

 private:
  Camera camera_;
  BlobSettings settings_;
  NominalMarker nominal_;
  SphereShift shift_;
  std::unique_ptr<SeedFrontEnd> seed_;
  std::unique_ptr<Runs> runs_ = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch_ = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs_ = std::make_unique<Blobs>();
};

}  // namespace glint

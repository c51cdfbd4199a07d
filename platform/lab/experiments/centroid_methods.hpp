// Centroids of one image of a sphere by every method that the experiment `centroid` compares.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "kernels/image/blobs.hpp"
#include "kernels/image/run.hpp"
#include "kernels/pose/back_project.hpp"
#include "platform/formats/camera.hpp"

namespace glint {

class BaselineFrontEnd;

class CentroidMethods {
 public:
  // nominal: for back-projection. noise: for the stated variances.
  CentroidMethods(const Camera& camera, const PixelNoise& noise, const NominalMarker& nominal);
  ~CentroidMethods();

  // Results for the blob nearest to the ground truth; nullopt if none is within k_near_px of it.
  struct Located {
    Blob blob;
    std::optional<Marker> marker;
    Vector2 weighted, binary;  // centroids of the same blob
  };
  static constexpr double k_near_px = 16;
  [[nodiscard]] std::optional<Located> locate(const Frame& frame, const Vector2& truth_px);

  // By the baseline.
  [[nodiscard]] std::optional<Vector2> locate_by_baseline(const Frame& frame,
                                                          const Vector2& truth_px);

 private:
  Camera camera_;
  BlobSettings settings_;
  NominalMarker nominal_;
  SphereOffset shift_;
  std::unique_ptr<BaselineFrontEnd> baseline_;
  std::unique_ptr<Runs> runs_ = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch_ = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs_ = std::make_unique<Blobs>();
};

}  // namespace glint

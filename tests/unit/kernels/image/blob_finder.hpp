// find_blobs() of a complete image in one band, with its own memory, which later calls use again.
#pragma once

#include <memory>
#include <vector>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::test {

struct BlobFinder {
  BlobSettings settings{1, 100000, 500, 0xFFFF};
  std::vector<Vector2> predicted{};
  bool everywhere = false;
  Limits limits{};
  std::unique_ptr<Runs> runs = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs = std::make_unique<Blobs>();

  BlobWork operator()(const TestImage& picture) {
    const Frame frame = picture.frame();
    threshold_runs(frame, whole_frame(frame), settings.threshold, {}, *runs, limits);
    const Runs* bands[] = {runs.get()};
    return find_blobs(frame, bands, settings, {predicted, everywhere, 3}, *scratch, *blobs, limits);
  }
};

}  // namespace glint::test

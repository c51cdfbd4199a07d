// Examination of one frame: every region above the threshold, and why it is no marker candidate.
//
// The frame is searched completely, as by a newly started tracker, by the nodes of the frame group.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blobs.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

inline constexpr std::size_t k_examined_regions_max = 512;

struct ExaminedRegion {
  Vector2 centroid_px = Vector2::Zero();
  std::uint32_t area_px = 0;
  std::uint16_t peak = 0;
  Roi box;
  std::string reason;  // too_small, too_large, low_contrast, blobs_full, no_depth; "": a candidate
  std::string marker;  // "pen/2", from 1; "": none
  double range_m = 0;  // 0: none
  Vector3 surface_m = Vector3::Zero();  // of a candidate with a range: camera frame
};

// Numbers of regions; touching_edge counts candidates and regions that are too small.
struct RegionCounts {
  int candidates = 0, no_depth = 0, too_small = 0, too_large = 0, touching_edge = 0;
  // too_small: those that may be markers beyond the range.
  double too_small_range_m = 0;  // of the farthest of them; 0: none has a range
};

struct ExaminedFrame {
  bool usable = false;  // false: without pixels, or of another size than the camera's
  Time mid_exposure, arrival;
  std::uint16_t threshold = 0;
  std::uint16_t brightest = 0;  // pixel of the searched part
  double bright_share = 0;      // of the searched pixels above the threshold
  RegionCounts counts;
  std::vector<ExaminedRegion> regions;  // candidates first; at most k_examined_regions_max
};

class FrameExaminer {
 public:
  explicit FrameExaminer(const Cell& cell);

  // Pixels that were not recorded are 0.
  [[nodiscard]] ExaminedFrame examine(const Frame& frame);

  // As the last call of examine() left it.
  [[nodiscard]] Tracker& tracker() noexcept { return *tracker_; }

 private:
  void add_candidates(ExaminedFrame& examined);
  [[nodiscard]] double range_of(const Frame& frame, const Component& component,
                                const ExaminedRegion& region) const;
  void add_refused(const Frame& frame, ExaminedFrame& examined);

  const Cell& cell_;
  ToolSet tools_;
  std::uint32_t searches_ = 0;
  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  std::unique_ptr<BlobScratch> scratch_ = std::make_unique<BlobScratch>();
  Blobs blobs_;
};

}  // namespace glint

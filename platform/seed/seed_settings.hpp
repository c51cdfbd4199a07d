// What a user of the published method could set.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

// Where a frame is undistorted. The last two are ours: what OpenCV can do at best.
enum class SeedUndistortion : std::uint8_t {
  whole_frame,  // as published, ROI or not
  roi,          // its pixels alone are remapped
  points,       // the raw ROI is thresholded, the blobs' centres are undistorted: less work
};

struct SeedSettings {
  SeedUndistortion undistortion = SeedUndistortion::whole_frame;
  // Two distances are equal if they differ by less. Twice the range noise of 1.5 mm a marker gives
  // a distance 2.1 mm (1 sigma); wider than 3 sigma of that, narrower than the 8 mm by which the
  // sides of a well-made tool differ.
  double delta_m = 0.007;
  double max_rms_m = 0.005;       // of the fit; beyond it the set is not the tool
  int min_markers = 3;            // as published
  int hypotheses_max = 20'000;    // partial assignments, as Glint's own search
  double roi_margin_px = 20;      // about the predicted markers, undistorted pixels
  bool use_roi = true;            // false: search the whole frame, always
  double max_blob_area_px = 900;  // larger ones are hands and lamps; full-size pixels
  Duration lost_after = milliseconds(250);
  Duration horizon = milliseconds(60);  // no extrapolation beyond
};

}  // namespace glint

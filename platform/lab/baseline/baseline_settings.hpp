// Settings of the baseline (Puljiz et al.).
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

// Where a frame is undistorted. The last two are not published; they show OpenCV's best speed.
enum class BaselineUndistortion : std::uint8_t {
  whole_frame,  // as published, with or without an ROI
  roi,          // remaps the ROI alone
  points,       // thresholds the raw ROI, undistorts only the blobs' centres
};

struct BaselineSettings {
  BaselineUndistortion undistortion = BaselineUndistortion::whole_frame;
  // Two distances are equal if they differ by less. Range noise of 1.5 mm at both markers gives a
  // distance noise of 2.1 mm (1 sigma). Above 3 sigma of that; below the 8 mm by which the sides of
  // a well-made tool differ.
  double delta_m = 0.007;
  double max_rms_m = 0.005;       // of the fit; a set with more is rejected
  int min_markers = 3;            // as published
  int hypotheses_max = 20'000;    // partial assignments, as Glint's own search
  double roi_margin_px = 20;      // around the predicted markers, undistorted pixels
  bool use_roi = true;            // false: always search the whole frame
  double max_blob_area_px = 900;  // larger blobs are hands and lamps; full-size pixels
  Duration lost_after = milliseconds(250);
  Duration horizon = milliseconds(60);  // limit of the extrapolation
};

}  // namespace glint

// Writes a frame as a PNG with its detections: ROI boxes, blobs circled and numbered (orange),
// markers with their range (blue), markers of a tool's pose by name (magenta), lines of text below.
#pragma once

#include <span>
#include <string>

#include "kernels/image/blob.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/pose/marker.hpp"

namespace glint {

// Brightness is the square root of the reflectivity relative to its 99.9th percentile, so that a
// dark scene is visible beside bright markers. Writes a temporary file and renames it. `names`:
// labels of the blobs in their order, empty for a blob of no tool; or no names at all.
// Throws InputError if path cannot be written or the frame has no reflectivity.
void write_detection_image(const std::string& path, const Frame& frame, const Rois& rois,
                           const Blobs& blobs, const Markers& markers,
                           std::span<const std::string> lines,
                           std::span<const std::string> names = {});

}  // namespace glint

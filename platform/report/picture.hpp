// A frame as a PNG with what Glint saw in it: ROI boxes, blobs circled and numbered (orange), the
// markers among them with their range (blue), those that a tool's pose rests on by name (magenta),
// and lines of text below.
#pragma once

#include <span>
#include <string>

#include "kernels/image/blob.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/pose/marker.hpp"

namespace glint {

// Reflectivity is drawn as the root of its part of the 99.9th percentile, so that a dim room shows
// beside bright markers. Written to a temporary file first, then renamed.
// `names`: of blobs, in their order, empty for those of no tool; or none at all.
// Throws InputError where path cannot be written or the frame has no reflectivity.
void write_picture(const std::string& path, const Frame& frame, const Rois& rois,
                   const Blobs& blobs, const Markers& markers, std::span<const std::string> lines,
                   std::span<const std::string> names = {});

}  // namespace glint

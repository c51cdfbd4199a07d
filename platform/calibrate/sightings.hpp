// A known tool as a camera saw it, frame by frame: which blob is which marker, its pixel, range and
// brightness, and the pose that they give.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

// A bright spot before it is known whose marker it is.
struct SeenBlob {
  LocalRays rays;  // around its pixel
  double surface_range_m = 0;
  double sigma_x_px = 0, sigma_y_px = 0, sigma_range_m = 0;  // 0: not known
  double peak = 0;                                           // raw counts; 0: not known
  std::uint32_t area_px = 0;                                 // 0: not known
};

struct BlobFrame {
  Time time;
  std::vector<SeenBlob> blobs;
};

struct BlobSeries {
  std::vector<BlobFrame> frames;
  Camera camera;
  bool brightness = false;            // the blobs have peaks
  std::optional<Tool> tool;           // that was looked for
  std::string what;                   // the file, for messages
  std::vector<std::string> failures;  // what of it could not be read, a line each
};

struct SeenMarker {
  int marker = 0;  // of the tool
  SeenBlob blob;
};

struct Sighting {
  StampedPose pose;  // T_camera_tool
  std::vector<SeenMarker> markers;
};

struct SightingSettings {
  // What a range may be off, an error common to all markers included.
  double range_sigma_m = 0.010;
};

struct SightingSeries {
  std::vector<Sighting> sightings;
  int frames = 0;     // of the series
  int unsolved = 0;   // without the tool
  int ambiguous = 0;  // of these: two ways to name the markers fit alike
};

// Each frame by itself, without a prior; of each the labeling that the noise explains best.
[[nodiscard]] SightingSeries find_tool(const BlobSeries& series, const Tool& tool,
                                       const SightingSettings& settings);

// Recorded frames of any kind, or a recording of level blobs: the markers found anew without any
// bias taken off. The cell file (empty: the recording's own, else the built-in one) and the tool
// are as open_recorded() and select_tool() have them. Throws InputError for bad files.
[[nodiscard]] BlobSeries recorded_blobs(const std::string& path, const std::string& cell_file,
                                        const std::string& tool);
[[nodiscard]] BlobSeries recorded_blobs(RecordedFrames& recorded, const std::string& tool);

// A table of blobs (CSV) `time_s,x_px,y_px,range_m,peak`, in which this camera saw them. Pixel
// centres are at integer + 0.5; ranges are to the surface, radial. Throws InputError.
[[nodiscard]] BlobSeries blobs_from_text(std::string_view text, const std::string& path,
                                         const Camera& camera);

}  // namespace glint

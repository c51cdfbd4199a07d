// Observations of a known tool per camera frame: the labeling of its blobs, their pixel, range and
// brightness, and the resulting pose.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

// A blob without a label.
struct ObservedBlob {
  LocalRays rays;  // around its pixel
  double surface_range_m = 0;
  double sigma_x_px = 0, sigma_y_px = 0, sigma_range_m = 0;  // 0: unknown
  double peak = 0;                                           // raw counts; 0: unknown
  std::uint32_t area_px = 0;                                 // 0: unknown
};

struct BlobFrame {
  Time time;
  std::vector<ObservedBlob> blobs;
};

struct BlobSeries {
  std::vector<BlobFrame> frames;
  Camera camera;
  bool brightness = false;            // the blobs have peaks
  std::optional<Tool> tool;           // the tool of the search
  std::string what;                   // file name, for messages
  std::vector<std::string> failures;  // read errors, a line each
};

struct ObservedMarker {
  int marker = 0;  // index in the tool
  ObservedBlob blob;
};

struct ToolObservation {
  TimedPose pose;  // T_camera_tool
  std::vector<ObservedMarker> markers;
};

struct ObservationSettings {
  // Standard deviation of a range, including errors common to all markers.
  double range_sigma_m = 0.010;
};

struct ObservationSeries {
  std::vector<ToolObservation> observations;
  int frames = 0;     // of the series
  int unsolved = 0;   // frames without a pose
  int ambiguous = 0;  // of `unsolved`: two labelings fit equally well
};

// Labels each frame by itself, without a prior; returns the labeling of least chi-square.
[[nodiscard]] ObservationSeries find_tool(const BlobSeries& series, const Tool& tool,
                                          const ObservationSettings& settings);

// Finds the markers again, without bias correction, in recorded frames of any kind or in a
// recording of level blobs. For the cell file (empty: the recording's own, else the built-in one)
// and the tool see open_recorded() and select_tool(). Throws InputError for bad files.
[[nodiscard]] BlobSeries recorded_blobs(const std::string& path, const std::string& cell_file,
                                        const std::string& tool);
[[nodiscard]] BlobSeries recorded_blobs(RecordedFrames& recorded, const std::string& tool);

// Reads a table of blobs (CSV) `time_s,x_px,y_px,range_m,peak` of this camera. Pixel centres are at
// integer + 0.5; ranges are radial, to the surface. Throws InputError.
[[nodiscard]] BlobSeries blobs_from_text(std::string_view text, const std::string& path,
                                         const Camera& camera);

}  // namespace glint

// Camera lens calibration from images of a chessboard or a circle grid, by OpenCV.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "platform/runtime/session/frame_source.hpp"

namespace glint {

enum class TargetPattern { chessboard, circles };

struct CameraCalibrationSettings {
  TargetPattern pattern = TargetPattern::chessboard;
  int columns = 9, rows = 6;  // inner corners, or circles
  double spacing_m = 0.025;
  Lens lens = Lens::rational;  // or brown
  double tilt_min_rad = 0.1;   // rms of the target's normal; less leaves the focal length open
};

inline constexpr std::size_t k_target_images_min = 5;

struct CameraFit {
  CameraModel model;
  double rms_px = 0;        // per axis
  double error_max_px = 0;  // largest |error|
  double tilt_rad = 0;
  // As LensSigmas of board_lens.hpp.
  double principal_point_sigma_px = 0, focal_sigma = 0;
  int images = 0, images_used = 0, corners = 0;
  std::vector<double> image_rms_px;  // rms of |error| of each image used
};

// Throws InputError for an unreadable image, an image of another size, too few detections of the
// target (most often a wrong number of corners), and targets that are all parallel.
[[nodiscard]] CameraFit calibrate_camera(const std::vector<std::string>& images,
                                         const CameraCalibrationSettings& settings);

// Calibrates from the reflectivity of recorded frames. Searches every k_target_frame_step-th frame
// and doubles the step until at most k_target_views_max detections, spread over the recording,
// remain. `what` names the source in messages. Reads the source to its end.
inline constexpr std::size_t k_target_frame_step = 4, k_target_views_max = 60;
[[nodiscard]] CameraFit calibrate_camera(FrameSource& source, const std::string& what,
                                         const CameraCalibrationSettings& settings);

// Returns the model's ray at each pixel centre for a cell's ray_table; zeros where there is none.
[[nodiscard]] std::vector<float> ray_table_of(const CameraModel& model);

}  // namespace glint

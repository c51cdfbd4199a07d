// A lens from pictures of a chessboard or a grid of circles: found and solved by OpenCV.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

enum class BoardPattern { chessboard, circles };

struct BoardSettings {
  BoardPattern pattern = BoardPattern::chessboard;
  int columns = 9, rows = 6;  // inner corners, or circles
  double spacing_m = 0.025;
  Lens lens = Lens::rational;  // or brown
  double tilt_min_rad = 0.1;   // rms of the board's normal: less, and focal length is a guess
};

inline constexpr std::size_t k_board_images_min = 5;

struct BoardFit {
  CameraModel model;
  double rms_px = 0;   // an axis
  double most_px = 0;  // of |error|
  double tilt_rad = 0;
  // LensSigmas of board_lens.hpp.
  double principal_point_sigma_px = 0, focal_sigma = 0;
  int images = 0, images_used = 0, corners = 0;
  std::vector<double> image_rms_px;  // of |error|, of each image used
};

// Throws InputError for a picture that cannot be read or has another size, a board that is not
// found often enough (the wrong number of corners, most likely), or boards that are all parallel.
[[nodiscard]] BoardFit calibrate_board(const std::vector<std::string>& images,
                                       const BoardSettings& settings);

// The same from the reflectivity of recorded frames: every k_board_frame_step-th is searched, and
// so many more are skipped as boards are found that at most k_board_views_max remain, spread over
// the whole recording. `what` names it. The source is read to its end.
inline constexpr std::size_t k_board_frame_step = 4, k_board_views_max = 60;
[[nodiscard]] BoardFit calibrate_board(FrameSource& source, const std::string& what,
                                       const BoardSettings& settings);

// The model's ray at each pixel's centre, zeros where it has none: what a cell's ray_table holds.
[[nodiscard]] std::vector<float> ray_table_of(const CameraModel& model);

}  // namespace glint

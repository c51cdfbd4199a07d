// Renders a chessboard as seen through the device's own lens, for `glint calibrate camera`.
//
// What:     evaluates the target's brightness at each pixel's ray and averages it over the pixel's
//           footprint on the target. Corners then agree with their projections to 0.01 px.
// Cost:     one plane and two averages per pixel.
// Accuracy: approximates the footprint by a rectangle along the target's sides.
#pragma once

#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "platform/sim/device_errors.hpp"
#include "platform/sim/motion.hpp"
#include "platform/sim/planes.hpp"

namespace glint::sim {

struct Chessboard {
  int columns = 9, rows = 6;  // inner corners; none: no target
  double spacing_m = 0.025;
  double white_signal = 3000, black_signal = 300;  // counts at 0.5 m
  MotionPointer motion;  // T_world_board: origin at the first corner, z points away
};

class ChessboardDrawer {
 public:
  // Computes the ray of each pixel with the device's own lens.
  ChessboardDrawer(const CameraModel& model, const DeviceErrors& device);
  void draw(const Chessboard& board, const Pose& T_camera_board, Planes& planes) const;

 private:
  int width_ = 0, height_ = 0;
  std::vector<Vector3> rays_;  // zero: none
};

// Motion over the complete field of view, at near and far range, with tilts in all directions.
[[nodiscard]] MotionPointer target_motion(const Pose& T_world_camera, const Chessboard& board,
                                          std::uint64_t seed);

}  // namespace glint::sim

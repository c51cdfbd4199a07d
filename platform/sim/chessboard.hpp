// A chessboard before the camera, as the device's own lens shows it: what `glint calibrate camera`
// takes.
//
// What:     the board's brightness at each pixel's ray, averaged over the pixel's footprint on the
//           board, so that corners lie where the lens puts them to a hundredth of a pixel.
// Cost:     one plane and two averages a pixel.
// Accuracy: the footprint is taken for a rectangle along the board's sides.
#pragma once

#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "platform/sim/device_errors.hpp"
#include "platform/sim/motion.hpp"
#include "platform/sim/planes.hpp"

namespace glint::sim {

struct Chessboard {
  int columns = 9, rows = 6;  // inner corners; none: there is no board
  double spacing_m = 0.025;
  double white_signal = 3000, black_signal = 300;  // counts at 0.5 m
  MotionPointer motion;                            // T_world_board: the first corner, z away
};

class ChessboardDrawer {
 public:
  // Computes the ray of each pixel by the device's own lens.
  ChessboardDrawer(const CameraModel& model, const DeviceErrors& device);
  void draw(const Chessboard& board, const Pose& T_camera_board, Planes& planes) const;

 private:
  int width_ = 0, height_ = 0;
  std::vector<Vector3> rays_;  // zero: none
};

// Over the whole lens, near and far, tilted to all sides.
[[nodiscard]] MotionPointer board_motion(const Pose& T_world_camera, const Chessboard& board,
                                         std::uint64_t seed);

}  // namespace glint::sim

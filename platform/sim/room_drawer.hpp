// Renders the room: ray-traces every k_room_step_px-th pixel and interpolates linearly, to follow
// the head at low cost. Edges of furniture are bevelled by that step.
#pragma once

#include <array>
#include <vector>

#include "kernels/limits.hpp"
#include "platform/sim/planes.hpp"
#include "platform/sim/room.hpp"

namespace glint::sim {

inline constexpr int k_room_step_px = 8;
inline constexpr std::size_t k_room_columns_max = k_width_max / k_room_step_px + 2;

class RoomDrawer {
 public:
  explicit RoomDrawer(const CameraModel& model);
  // wall_signal: counts of albedo 1 at 0.5 m, normal incidence.
  void draw(const Room& room, const Pose& T_world_camera, double wall_signal, Planes& planes) const;

 private:
  // Writes the signals, then the ranges, of one row of traced pixels.
  void trace_row(const Room& room, const Pose& T_world_camera, double wall_signal, int row,
                 std::array<float, 2 * k_room_columns_max>& out) const;
  void fill_row(const std::array<float, 2 * k_room_columns_max>& upper,
                const std::array<float, 2 * k_room_columns_max>& lower, float down, float* signal,
                float* range, int width) const;

  int columns_ = 0, rows_ = 0;
  std::vector<Vector3> rays_;
};

}  // namespace glint::sim

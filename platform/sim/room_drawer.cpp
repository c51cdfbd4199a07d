#include "platform/sim/room_drawer.hpp"

#include <cmath>

namespace glint::sim {
namespace {

struct RoomHit {
  double range = 1e9;
  double albedo = 0;
  double cosine = 0;
};

double shade(int face) { return 0.7 + 0.06 * face; }  // makes the walls differ

// Slab method: the ray is between the two planes of each axis from `entry` to `leave`.
void trace_box(const Box& box, const Vector3& origin, const Vector3& ray, RoomHit& hit) {
  double entry = -1e9, leave = 1e9;
  int entry_face = 0, leave_face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = std::abs(ray[axis]) > 1e-12 ? ray[axis] : 1e-12;
    const double low = (box.low[axis] - origin[axis]) / speed;
    const double high = (box.high[axis] - origin[axis]) / speed;
    const double first = low < high ? low : high, second = low < high ? high : low;
    if (first > entry) {
      entry = first;
      entry_face = axis;
    }
    if (second < leave) {
      leave = second;
      leave_face = axis;
    }
  }
  if (entry > leave || leave <= 0) return;
  const bool inside = entry <= 0;
  const double range = inside ? leave : entry;
  const int axis = inside ? leave_face : entry_face;
  if (range >= hit.range || range <= 0) return;
  const int side = ray[axis] > 0 ? 1 : 0;
  hit = {range, box.albedo * shade(2 * axis + side), std::abs(ray[axis])};
}

// Outside of the lens's field: the ray of the nearest valid position towards the centre.
Vector3 nearest_ray(const CameraModel& model, const Vector2& pixel) {
  constexpr int k_steps = 64;
  const Vector2 middle(model.cx, model.cy);
  for (int i = k_steps; i > 0; --i) {
    const Result<Vector3> found = unproject(model, middle + (pixel - middle) * i / k_steps);
    if (found) return found.value.normalized();
  }
  return Vector3::UnitZ();
}

}  // namespace

RoomDrawer::RoomDrawer(const CameraModel& model)
    : columns_((model.width + k_room_step_px - 1) / k_room_step_px + 1),
      rows_((model.height + k_room_step_px - 1) / k_room_step_px + 1) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      rays_.push_back(nearest_ray(model, Vector2(column * k_room_step_px, row * k_room_step_px)));
    }
  }
}

void RoomDrawer::draw(const Room& room, const Pose& T_world_camera, double wall_signal,
                      Planes& planes) const {
  std::array<float, 2 * k_room_columns_max> upper{}, lower{};
  trace_row(room, T_world_camera, wall_signal, 0, lower);
  for (int row = 0; row + 1 < rows_; ++row) {
    upper = lower;
    trace_row(room, T_world_camera, wall_signal, row + 1, lower);
    const int begin = row * k_room_step_px;
    const int end = begin + k_room_step_px < planes.height ? begin + k_room_step_px : planes.height;
    for (int y = begin; y < end; ++y) {
      const float down = (static_cast<float>(y - begin) + 0.5f) / float{k_room_step_px};
      fill_row(upper, lower, down, planes.signal.data() + planes.at(0, y),
               planes.range_m.data() + planes.at(0, y), planes.width);
    }
  }
}

void RoomDrawer::trace_row(const Room& room, const Pose& T_world_camera, double wall_signal,
                           int row, std::array<float, 2 * k_room_columns_max>& out) const {
  for (int column = 0; column < columns_; ++column) {
    const Vector3 ray =
        T_world_camera.rotation * rays_[static_cast<std::size_t>(row * columns_ + column)];
    RoomHit hit;
    trace_box(room.walls, T_world_camera.translation, ray, hit);
    for (const Box& box : room.furniture) trace_box(box, T_world_camera.translation, ray, hit);
    const double range = hit.range > 0.05 ? hit.range : 0.05;
    const auto i = static_cast<std::size_t>(column);
    out[i] = static_cast<float>(wall_signal * hit.albedo * hit.cosine * 0.25 / (range * range));
    out[i + k_room_columns_max] = static_cast<float>(range);
  }
}

void RoomDrawer::fill_row(const std::array<float, 2 * k_room_columns_max>& upper,
                          const std::array<float, 2 * k_room_columns_max>& lower, float down,
                          float* signal, float* range, int width) const {
  std::array<float, 2 * k_room_columns_max> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = upper[i] + down * (lower[i] - upper[i]);
  const auto expand = [&](const float* nodes, float* out) {
    for (int column = 0; column * k_room_step_px < width; ++column) {
      const float left = nodes[column], slope = nodes[column + 1] - nodes[column];
      const int begin = column * k_room_step_px;
      const int count = width - begin < k_room_step_px ? width - begin : k_room_step_px;
      for (int k = 0; k < count; ++k) {
        out[begin + k] = left + slope * ((static_cast<float>(k) + 0.5f) / float{k_room_step_px});
      }
    }
  };
  expand(at.data(), signal);
  expand(at.data() + k_room_columns_max, range);
}

}  // namespace glint::sim

#include "platform/sim/chessboard.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"

namespace glint::sim {
namespace {

constexpr double k_border_squares = 2;  // from the outer corners to the edge

// Integral from 0 to x of a square wave: 1 in [0, 1), -1 in [1, 2), periodic.
double wave_integral(double x) {
  const double inside = x - 2 * std::floor(x / 2);
  return inside < 1 ? inside : 2 - inside;
}

// Mean of the wave over x +- half.
double wave_mean(double x, double half) {
  return (wave_integral(x + half) - wave_integral(x - half)) / (2 * half);
}

class BoardMotion final : public Motion {
 public:
  BoardMotion(const Pose& T_world_camera, const Chessboard& board, std::uint64_t seed)
      : T_world_camera_(T_world_camera),
        middle_m_(0.5 * board.spacing_m * Vector3(board.columns - 1, board.rows - 1, 0)),
        key_{seed, Stream::chessboard} {}

  [[nodiscard]] Pose pose(Time time) const override {
    const double t = Duration{time.nanoseconds}.seconds();
    const double range_m = 0.36 + 0.1 * wave(t, 0.11, 0);
    const Vector3 middle =
        range_m * Vector3(0.55 * wave(t, 0.23, 1), 0.5 * wave(t, 0.37, 2), 1).normalized();
    const Vector3 tilt(0.45 * wave(t, 0.31, 3), 0.45 * wave(t, 0.19, 4), 0.4 * wave(t, 0.13, 5));
    const Quaternion rotation = from_rotation_vector(tilt);
    return T_world_camera_ * Pose{rotation, middle - rotation * middle_m_};
  }

 private:
  [[nodiscard]] double wave(double t, double hz, std::uint64_t number) const {
    return sine_cosine(2 * std::numbers::pi * (hz * t + uniform(key_, number))).sine;
  }
  Pose T_world_camera_;
  Vector3 middle_m_;
  RandomKey key_;
};

}  // namespace

ChessboardDrawer::ChessboardDrawer(const CameraModel& model, const DeviceErrors& device)
    : width_(model.width), height_(model.height) {
  DeviceErrors lens = device;
  lens.correlated_range_m = lens.correlated_centroid_px = 0;
  const Vector2 middle(model.cx, model.cy);
  const auto shift = [&](const Vector2& pixel) {
    return device.exists ? marker_error(lens, pixel, middle, 0, 0, Time{}).shift_px : Vector2(0, 0);
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Vector2 pixel(x + 0.5, y + 0.5);
      const Result<Vector3> ray = unproject(model, pixel - shift(pixel - shift(pixel)));
      rays_.push_back(ray ? ray.value.normalized() : Vector3::Zero());
    }
  }
}

void ChessboardDrawer::draw(const Chessboard& board, const Pose& T_camera_board,
                            Planes& planes) const {
  const Vector3 normal = T_camera_board.rotation * Vector3::UnitZ();
  const double height_m = normal.dot(T_camera_board.translation);
  const Pose T_board_camera = T_camera_board.inverse();
  // Intersection with the target's plane in units of squares; returns 0 without intersection.
  const auto place = [&](const Vector3& ray, Vector2& at) {
    const double along = normal.dot(ray);
    if (!(along * height_m > 0)) return 0.0;
    const double range_m = height_m / along;
    at = (T_board_camera * (range_m * ray)).head<2>() / board.spacing_m;
    return range_m;
  };
  for (int y = 0; y + 1 < height_; ++y) {
    for (int x = 0; x + 1 < width_; ++x) {
      const std::size_t i = planes.at(x, y);
      const std::size_t below = planes.at(x, y + 1);
      if (rays_[i].isZero() || rays_[i + 1].isZero() || rays_[below].isZero()) continue;
      Vector2 at, right, down;
      const double range_m = place(rays_[i], at);
      if (range_m == 0 || at.x() < -k_border_squares || at.y() < -k_border_squares ||
          at.x() > board.columns - 1 + k_border_squares ||
          at.y() > board.rows - 1 + k_border_squares)
        continue;
      if (place(rays_[i + 1], right) == 0 || place(rays_[below], down) == 0) continue;
      const Vector2 half = 0.5 * ((right - at).cwiseAbs() + (down - at).cwiseAbs());
      // The border around the squares is white.
      const bool edge = at.x() < -1 || at.y() < -1 || at.x() > board.columns || at.y() > board.rows;
      const double checks = edge ? 1 : -wave_mean(at.x(), half.x()) * wave_mean(at.y(), half.y());
      const double counts = 0.5 * (board.white_signal + board.black_signal) +
                            0.5 * (board.white_signal - board.black_signal) * checks;
      planes.signal[i] = static_cast<float>(counts * 0.25 / (range_m * range_m));
      planes.range_m[i] = static_cast<float>(range_m);
    }
  }
}

MotionPointer target_motion(const Pose& T_world_camera, const Chessboard& board,
                            std::uint64_t seed) {
  return std::make_shared<BoardMotion>(T_world_camera, board, seed);
}

}  // namespace glint::sim

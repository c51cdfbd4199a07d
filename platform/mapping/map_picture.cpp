#include "platform/mapping/map_picture.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {
namespace {

constexpr int k_splat = 3;  // half a point's width in pixels

cv::Vec3b colour_of(std::uint8_t plane, double facing) {
  constexpr int k_colours = 8;
  static const cv::Vec3d colours[k_colours] = {{80, 160, 255}, {90, 200, 90},   {230, 150, 70},
                                               {90, 90, 220},  {200, 100, 200}, {210, 210, 80},
                                               {60, 200, 220}, {150, 120, 90}};
  const bool on = plane != PlaneSearch::k_no_plane;
  const cv::Vec3d full = on ? colours[plane % k_colours] : cv::Vec3d(170, 170, 170);
  const double part = 0.3 + 0.7 * facing;
  return {static_cast<std::uint8_t>(full[0] * part), static_cast<std::uint8_t>(full[1] * part),
          static_cast<std::uint8_t>(full[2] * part)};
}

}  // namespace

void write_map_picture(const std::string& path, const PointCloud& map, const PlaneSupport& planes,
                       const CameraModel& camera, const Pose& T_world_camera) {
  cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar(30, 30, 30));
  cv::Mat depth(camera.height, camera.width, CV_64F, std::numeric_limits<double>::infinity());
  const Pose T_camera_world = T_world_camera.inverse();
  for (int i = 0; i < map.count; ++i) {
    const Vector3 point =
        T_camera_world * Vector3(static_cast<double>(map.x[i]), static_cast<double>(map.y[i]),
                                 static_cast<double>(map.z[i]));
    if (!(point.z() > 0)) continue;
    const Result<Vector2> pixel = project(camera, point);
    if (!pixel) continue;
    const Vector3 normal(static_cast<double>(map.normal_x[i]), static_cast<double>(map.normal_y[i]),
                         static_cast<double>(map.normal_z[i]));
    const double facing = std::abs((T_camera_world.rotation * normal).dot(point.normalized()));
    const cv::Vec3b colour = colour_of(planes.plane_of(i), std::min(facing, 1.0));
    const int u = static_cast<int>(std::floor(std::clamp(pixel.value.x(), -1e6, 1e6)));
    const int v = static_cast<int>(std::floor(std::clamp(pixel.value.y(), -1e6, 1e6)));
    for (int y = std::max(v - k_splat, 0); y <= std::min(v + k_splat, image.rows - 1); ++y) {
      for (int x = std::max(u - k_splat, 0); x <= std::min(u + k_splat, image.cols - 1); ++x) {
        if (depth.at<double>(y, x) <= point.z()) continue;
        depth.at<double>(y, x) = point.z();
        image.at<cv::Vec3b>(y, x) = colour;
      }
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const std::string reason = write_whole_file(path, text); !reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason + "; expected a place for a picture");
  }
}

}  // namespace glint

#include "platform/tools/reference/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/tools/reference/camera_info.hpp"
#include "platform/tools/robot/joint_file.hpp"

namespace glint {
namespace {

// Returns the camera pixel of a pixel of the undistorted image; -1 if there is none.
int source_pixel(const CameraModel& camera, double u, double v) {
  if (camera.lens != Lens::pinhole) {
    const Result<Vector2> distorted =
        project(camera, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1});
    if (!distorted) return -1;
    u = distorted.value.x();
    v = distorted.value.y();
  }
  if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return -1;
  return static_cast<int>(v) * camera.width + static_cast<int>(u);
}

// Requires a quarter of the block: fewer are an artefact of the sensor.
float merged(std::vector<float>& values, std::size_t block) {
  if (values.empty() || 4 * values.size() < block) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const float median = *middle;
  std::sort(values.begin(), values.end());  // fixes the order of the sum
  double sum = 0;
  int count = 0;
  for (const float value : values) {
    if (std::abs(value - median) > 0.01f * median) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  return static_cast<float>(sum / count);
}

int pixels_a_side(const CameraModel& camera) {
  return (camera.width + k_working_width - 1) / k_working_width;
}

// A frame without depth.
SceneFrame empty_frame(const MaskImage* mask, const CameraModel& camera) {
  SceneFrame frame;
  const int scale = pixels_a_side(camera);
  frame.camera = {camera.width / scale, camera.height / scale, camera.fx / scale,
                  camera.fy / scale,    camera.cx / scale,     camera.cy / scale};
  if (mask == nullptr) return frame;
  for (int y = 0; y < frame.camera.height; ++y) {
    for (int x = 0; x < frame.camera.width; ++x) {
      int on = 0;
      for (int j = 0; j < scale; ++j) {
        for (int i = 0; i < scale; ++i) {
          const int at = source_pixel(camera, x * scale + i + 0.5, y * scale + j + 0.5);
          if (at >= 0) on += mask->on[static_cast<std::size_t>(at)];
        }
      }
      frame.mask.push_back(2 * on >= scale * scale ? 1 : 0);
    }
  }
  return frame;
}

}  // namespace

SceneFrame scene_frame(const DepthImage& depth, const MaskImage* mask, const CameraModel& camera) {
  SceneFrame frame = empty_frame(mask, camera);
  const int scale = pixels_a_side(camera);
  std::vector<float> values;
  for (int y = 0; y < frame.camera.height; ++y) {
    for (int x = 0; x < frame.camera.width; ++x) {
      values.clear();
      for (int j = 0; j < scale; ++j) {
        for (int i = 0; i < scale; ++i) {
          const int at = source_pixel(camera, x * scale + i + 0.5, y * scale + j + 0.5);
          if (at < 0) continue;
          const float z = depth.z_m[static_cast<std::size_t>(at)];
          if (z > 0) values.push_back(z);
        }
      }
      frame.depth_m.push_back(merged(values, static_cast<std::size_t>(scale) * scale));
    }
  }
  return frame;
}

SceneFrame scene_frame(std::span<const Vector3f> points, const MaskImage* mask,
                       const CameraModel& camera) {
  SceneFrame frame = empty_frame(mask, camera);
  const Pinhole& pinhole = frame.camera;
  std::vector<std::pair<std::size_t, float>> depths;  // pixel, z
  for (const Vector3f& point : points) {
    const Vector3 p = point.cast<double>();
    const double u = pinhole.fx * p.x() / p.z() + pinhole.cx;
    const double v = pinhole.fy * p.y() / p.z() + pinhole.cy;
    if (!(p.z() > 0 && u >= 0 && v >= 0 && u < pinhole.width && v < pinhole.height)) continue;
    depths.emplace_back(static_cast<std::size_t>(v) * static_cast<std::size_t>(pinhole.width) +
                            static_cast<std::size_t>(u),
                        point.z());
  }
  std::sort(depths.begin(), depths.end());
  frame.depth_m.assign(static_cast<std::size_t>(pinhole.width * pinhole.height), 0);
  std::vector<float> values;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    values.push_back(depths[i].second);
    if (i + 1 < depths.size() && depths[i + 1].first == depths[i].first) continue;
    frame.depth_m[depths[i].first] = merged(values, 1);
    values.clear();
  }
  return frame;
}

namespace {

SceneFrame read_frame(const std::string& path, const MaskImage* mask, const CameraModel& camera) {
  if (!is_cloud_file(path)) return scene_frame(read_depth(path, camera), mask, camera);
  const std::vector<Vector3f> points = read_depth_points(path);
  SceneFrame frame = scene_frame(points, mask, camera);
  if (std::all_of(frame.depth_m.begin(), frame.depth_m.end(), [](float z) { return z == 0; })) {
    throw InputError(path + ": none of " + std::to_string(points.size()) +
                     " points lies in the camera's image; expected z forward, x right, y down");
  }
  return frame;
}

void check_counts(const SceneFiles& files) {
  const std::size_t count = files.depth.size();
  if (count == 0 || count > k_scene_views_max) {
    throw InputError("--depth: " + std::to_string(count) + " files; expected 1 to " +
                     std::to_string(k_scene_views_max));
  }
  if (!files.positions && files.joints.size() != count) {
    throw InputError("--joints: " + std::to_string(files.joints.size()) + " files for " +
                     std::to_string(count) + " of --depth; expected one for each");
  }
  if (!files.masks.empty() && files.masks.size() != count) {
    throw InputError("--mask: " + std::to_string(files.masks.size()) + " files for " +
                     std::to_string(count) + " of --depth; expected one for each or none");
  }
}

// `pose_robot` sets a frame's robot to these positions; their source is for error messages.
template <class Robot, class PoseRobot>
std::vector<SceneFrame> read_frames(const SceneFiles& files, const Robot& robot,
                                    PoseRobot pose_robot) {
  check_counts(files);
  const CameraModel camera = read_camera_info(files.camera);
  std::vector<SceneFrame> frames;
  for (std::size_t i = 0; i < files.depth.size(); ++i) {
    MaskImage picture;
    if (!files.masks.empty()) picture = read_mask(files.masks[i], camera);
    const MaskImage* mask = files.masks.empty() ? nullptr : &picture;
    frames.push_back(read_frame(files.depth[i], mask, camera));
    const std::string& from = files.positions ? files.positions_from : files.joints[i];
    pose_robot(frames.back(),
               files.positions ? *files.positions : read_joint_positions(from, robot.inputs), from);
    frames.back().name = files.depth[i];
  }
  return frames;
}

}  // namespace

std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotModel& robot) {
  return read_frames(
      files, robot,
      [&](SceneFrame& frame, const std::vector<double>& positions, const std::string& from) {
        frame.model = posed_surface(robot, positions, from);
      });
}

std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotCloud& robot) {
  return read_frames(
      files, robot,
      [&](SceneFrame& frame, const std::vector<double>& positions, const std::string& from) {
        frame.cloud = posed_cloud(robot, positions, from);
      });
}

}  // namespace glint

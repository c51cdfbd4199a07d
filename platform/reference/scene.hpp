// A scene to look for a robot in: depth pictures, brought down to a working size, each with the
// robot's surface at its joint positions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/registration/scene_view.hpp"
#include "platform/reference/depth_picture.hpp"
#include "platform/robot/robot_cloud.hpp"
#include "platform/robot/robot_model.hpp"

namespace glint {

inline constexpr int k_working_width = 320;

// Owns what a SceneView borrows.
struct SceneFrame {
  Pinhole camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;  // empty: none
  PosedSurface model;
  PosedCloud cloud;     // in place of the model, if it has points
  Pose T_camera_world;  // identity for a camera that stands still
  std::string name;     // the depth's file

  // Of each triangle of the model, or of each point of the cloud.
  [[nodiscard]] std::span<const std::uint16_t> links() const {
    return cloud.points.empty() ? model.face_links : cloud.point_links;
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth_m, mask, model.surface(), T_camera_world, cloud.cloud()};
  }
};

// Blocks of pixels become one: the mean of what lies within 1 % of the block's median. A lens is
// straightened on the way. `mask` may be null.
[[nodiscard]] SceneFrame scene_frame(const DepthImage& depth, const MaskPicture* mask,
                                     const CameraModel& camera);

// The same of points in the camera's frame, metres: those of one pixel of the working size become
// one, as above. They may be fewer than the picture has pixels. None need be in the picture.
[[nodiscard]] SceneFrame scene_frame(std::span<const Vector3f> points, const MaskPicture* mask,
                                     const CameraModel& camera);

struct SceneFiles {
  std::string camera;
  std::vector<std::string> depth, joints;  // one of each a frame
  std::vector<std::string> masks;          // as many, or none
  // Of every frame, in place of files of joints; and where they came from.
  std::optional<std::vector<double>> positions{};
  std::string positions_from{};
};

// Throws InputError where the files are none, not as many of one kind as of another, or a cloud has
// no point in the picture.
[[nodiscard]] std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotModel& robot);
[[nodiscard]] std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotCloud& robot);

}  // namespace glint

// Scene for robot registration: depth images at a working size, each with the robot's surface at
// its joint positions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/registration/scene_view.hpp"
#include "platform/tools/reference/depth_image.hpp"
#include "platform/tools/robot/robot_cloud.hpp"
#include "platform/tools/robot/robot_model.hpp"

namespace glint {

inline constexpr int k_working_width = 320;

// Owns the memory that a SceneView borrows.
struct SceneFrame {
  Pinhole camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;  // empty: none
  PosedSurface model;
  PosedCloud cloud;     // replaces the model if it has points
  Pose T_camera_world;  // identity for a static camera
  std::string name;     // name of the depth file

  // Link of each triangle of the model, or of each point of the cloud.
  [[nodiscard]] std::span<const std::uint16_t> links() const {
    return cloud.points.empty() ? model.face_links : cloud.point_links;
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth_m, mask, model.surface(), T_camera_world, cloud.cloud()};
  }
};

// Reduces blocks of pixels to the mean of those within 1 % of the block's median, and undistorts.
// `mask` may be null.
[[nodiscard]] SceneFrame scene_frame(const DepthImage& depth, const MaskImage* mask,
                                     const CameraModel& camera);

// The same for points in the camera's frame, metres: the points of one pixel of the working size
// are merged as above. There may be fewer points than pixels, and none in the image.
[[nodiscard]] SceneFrame scene_frame(std::span<const Vector3f> points, const MaskImage* mask,
                                     const CameraModel& camera);

struct SceneFiles {
  std::string camera;
  std::vector<std::string> depth, joints;  // one of each per frame
  std::vector<std::string> masks;          // one per frame, or none
  // Positions for every frame in place of joint files, and their source for messages.
  std::optional<std::vector<double>> positions{};
  std::string positions_from{};
};

// Throws InputError for no files, for unequal numbers of files, and for a cloud without a point in
// the image.
[[nodiscard]] std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotModel& robot);
[[nodiscard]] std::vector<SceneFrame> read_scene(const SceneFiles& files, const RobotCloud& robot);

}  // namespace glint

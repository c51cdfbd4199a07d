// A robot without meshes, an arm that rotates on a post, and its depth images.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "kernels/registration/render_depth.hpp"
#include "platform/tools/reference/find_reference.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {

// Inputs: turn, slide.
inline std::string post_arm_xml() {
  const auto link = [](const char* name, const char* size, const char* xyz) {
    return std::string("<link name='") + name + "'><collision><origin xyz='" + xyz +
           "'/><geometry><box size='" + size + "'/></geometry></collision></link>\n";
  };
  return test::robot_xml(link("post", "0.2 0.2 0.5", "0 0 0.25") +
                         link("beam", "0.5 0.11 0.1", "0.2 0 0.45") +
                         link("hand", "0.08 0.12 0.3", "0.41 0 0.35") +
                         test::joint_xml("turn", "revolute", "post", "beam") +
                         test::joint_xml("slide", "prismatic", "beam", "hand"));
}

// Ground truth of T_camera_base.
inline const Pose k_post_arm_truth{pose_from_xyz_rpy({0, 0, 0, 2.094, 0, 0}).rotation *
                                       pose_from_xyz_rpy({0, 0, 0, 0, 0, 0.7}).rotation,
                                   {-0.1, 0.15, 1.3}};

// Initial guess: the ground truth with an error of a few degrees and centimetres.
inline const Pose k_post_arm_guess{
    k_post_arm_truth.rotation * pose_from_xyz_rpy({0, 0, 0, 0.05, 0.05, 0}).rotation,
    k_post_arm_truth.translation + Vector3(0.03, -0.03, 0.03)};

// One depth image, with a wall behind the robot.
inline std::vector<SceneFrame> post_arm_scene(const RobotModel& robot,
                                              std::span<const double> positions) {
  SceneFrame frame;
  frame.camera = {160, 120, 150, 150, 80, 60};
  frame.model = posed_surface(robot, positions, "a test");
  frame.depth_m.resize(160 * 120);
  std::vector<std::int32_t> face(frame.depth_m.size());
  std::vector<ProjectedCorner> corners(frame.model.corners.size());
  EXPECT_EQ(render_depth(frame.model.surface(), k_post_arm_truth, frame.camera,
                         {frame.depth_m, face, corners}),
            Reason::none);
  for (float& z : frame.depth_m) z = z == 0 ? 2.2f : z;
  return {frame};
}

}  // namespace glint

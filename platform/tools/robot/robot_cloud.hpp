// Robot model without meshes: joints, and points sampled on the links' surfaces. A host computes it
// from a URDF for a companion computer without URDF and mesh readers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/registration/model_cloud.hpp"
#include "kernels/robot/joint_tree.hpp"

namespace glint {

inline constexpr int k_robot_cloud_points = 60'000;

struct RobotCloud {
  std::string name;
  JointTree tree;
  std::vector<std::string> links, inputs;  // as in RobotModel
  std::vector<Vector3f> points, normals;   // in the link frames, metres
  std::vector<std::uint16_t> point_links;
  float spacing_m = 0;

  [[nodiscard]] LinkCloud cloud() const { return {{points, normals, spacing_m}, point_links}; }
};

// Points of the complete robot in its root's frame.
struct PosedCloud {
  std::vector<Vector3f> points, normals;
  float spacing_m = 0;
  std::vector<std::uint16_t> point_links{};  // as in RobotCloud

  [[nodiscard]] ModelCloud cloud() const { return {points, normals, spacing_m}; }
};

// At these positions (radians, metres; one per input). Both throw InputError naming `what` if the
// positions are invalid.
[[nodiscard]] LinkPoses link_poses(const RobotCloud& robot, std::span<const double> positions,
                                   const std::string& what);
[[nodiscard]] PosedCloud posed_cloud(const RobotCloud& robot, std::span<const double> positions,
                                     const std::string& what);

// PLY format, binary_little_endian: one vertex per point with float x y z, float nx ny nz (in the
// link's frame) and ushort link. Comments before them define the kinematic tree:
//   comment glint robot cloud 1
//   comment robot NAME
//   comment spacing_m S
//   comment input NAME                    one for each joint value, in their order
//   comment link NAME                     the root; then for each joint, parents first:
//   comment joint KIND PARENT INPUT MULTIPLIER OFFSET AX AY AZ X Y Z QX QY QZ QW
//   comment link NAME                     the joint's child
// KIND: fixed, turning, sliding. PARENT, INPUT: indices from 0, INPUT -1 for none. The axis is in
// the joint's frame; T_parent_joint is metres and a quaternion. Numbers are written with full
// precision. Throws InputError if the file cannot be written.
void write_robot_cloud(const std::string& path, const RobotCloud& robot);

// Throws InputError naming file, line, found and expected.
[[nodiscard]] RobotCloud read_robot_cloud(const std::string& path);

}  // namespace glint

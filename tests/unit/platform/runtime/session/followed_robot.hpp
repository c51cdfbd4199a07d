// A robot for a session to track: its model and depth images of it in a folder, without a mesh.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/registration/render_depth.hpp"
#include "platform/cells/cell.hpp"
#include "platform/tools/robot/robot_cloud.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"
#include "tests/unit/platform/runtime/session/depth_folder.hpp"

namespace glint {

inline void write_box_robot(const std::string& path, const test::BoxArm& model) {
  const test::SampledModel sampled(model, 0.006f);
  RobotCloud robot;
  robot.name = "box";
  robot.links = {"base"};
  robot.points.assign(sampled.cloud().points.begin(), sampled.cloud().points.end());
  robot.normals.assign(sampled.cloud().normals.begin(), sampled.cloud().normals.end());
  robot.point_links.assign(robot.points.size(), 0);
  robot.spacing_m = sampled.cloud().spacing_m;
  write_robot_cloud(path, robot);
}

// Depth images of a robot without joints. It starts at the cell's pose and moves 0.5 mm aside with
// each image. If `jump_m` is not 0, it jumps in the second half.
inline void configure_box_robot(const std::string& folder, double jump_m, Cell& cell) {
  const test::BoxArm model;
  write_box_robot(folder + "/robot.ply", model);
  DepthFolder depth(folder);
  constexpr int k_shown = 12;
  for (int i = 0; i < k_shown; ++i) {
    Pose truth = test::k_truth;
    truth.translation.x() += 5e-4 * i + (i > k_shown / 2 ? jump_m : 0);
    std::vector<float> z(DepthFolder::k_width * DepthFolder::k_height);
    std::vector<std::int32_t> face(z.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, truth,
                           {DepthFolder::k_width, DepthFolder::k_height, DepthFolder::k_focal,
                            DepthFolder::k_focal, 40, 30},
                           {z, face, corners}),
              Reason::none);
    for (float& at : z) at = at == 0 ? 1.9f : at;
    depth.add(z, cell.T_world_robot * test::k_truth.inverse());
  }
  cell.background = BackgroundSettings{microseconds(250), k_background_steps_max};
  MappingSettings& mapping = cell.mapping.emplace();
  mapping.source = folder;
  mapping.model = folder + "/robot.ply";
  mapping.period = milliseconds(100);
  mapping.images_per_map = 100;
  mapping.voxels_max = 20'000;
}

}  // namespace glint

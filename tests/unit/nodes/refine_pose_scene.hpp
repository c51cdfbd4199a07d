// Test fixture: node RefinePose with labelled markers of tools that a pinhole camera sees.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "kernels/pose/rigid_fit.hpp"
#include "nodes/refine_pose.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::test {

inline const Vector3 k_place(0.08, -0.05, 0.5);
inline constexpr double k_pixel_sigma_px = 0.1, k_range_sigma_m = 0.0015;

class RefinePoseTest : public testing::Test {
 protected:
  RefinePoseTest() {
    node_.noise = {k_range_sigma_m, k_pixel_sigma_px, 253};
    node_.estimate_noise = false;
    world_->assignment.reason.fill(Reason::too_few_markers);
  }

  // Tool number t; markers in reverse order, with noise of `share` standard deviations.
  void add_tool(int t, const Tool& tool, const Pose& truth, double share, Random& random) {
    const auto at = static_cast<std::size_t>(t);
    set_.count = std::max(set_.count, t + 1);
    set_.items[at] = tool;
    world_->assignment.reason[at] = Reason::none;
    Labeling& labeling = world_->assignment.labeling[at];
    labeling = {};
    labeling.marker.fill(-1);
    labeling.count = tool.marker_count;
    const CameraModel camera = pinhole();
    for (int i = tool.marker_count - 1; i >= 0; --i) {
      const Vector3 point = truth * tool.markers_m[static_cast<std::size_t>(i)];
      const double right = random.normal(), down = random.normal(), away = random.normal();
      const Vector2 pixel =
          project(camera, point).value + share * k_pixel_sigma_px * Vector2(right, down);
      int lens_steps = 0;
      const LocalRays rays = local_rays(camera, pixel, k_ray_steps_max, lens_steps).value;
      labeling.marker[static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(world_->markers.count);
      Marker& marker = world_->markers.items[static_cast<std::size_t>(world_->markers.count++)];
      marker = {};
      marker.ray = rays.ray;
      marker.along_x = rays.along_x;
      marker.along_y = rays.along_y;
      marker.centroid_px = pixel;
      marker.surface_range_m =
          point.norm() + share * k_range_sigma_m * away - tool.centre_offset_m();
    }
  }
  Marker& marker_of(int t, int i) {
    return world_->markers
        .items[static_cast<std::size_t>(world_->assignment.labeling[static_cast<std::size_t>(t)]
                                            .marker[static_cast<std::size_t>(i)])];
  }
  void drop_marker(int t, int i) {
    Labeling& labeling = world_->assignment.labeling[static_cast<std::size_t>(t)];
    labeling.marker[static_cast<std::size_t>(i)] = -1;
    --labeling.count;
  }
  void start_over() { world_->markers.count = set_.count = 0; }
  const FittedTools& run(graph::Partition partition = {0, 1}) {
    tools_.set(set_, 1, 0);
    node_(verdict_, world_->markers, tools_, world_->predictions, world_->assignment, partition,
          world_->fitted);
    return world_->fitted;
  }
  const FittedTool& run_one() { return run().tools[0]; }

  struct World {
    Markers markers;
    Predictions predictions;
    Assignment assignment;
    FittedTools fitted;
  };
  std::unique_ptr<World> world_ = std::make_unique<World>();
  FrameVerdict verdict_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  glint::RefinePose node_;
};

inline Vector6 error_of(const FittedTool& found, const Pose& truth, const Vector3& tip) {
  Vector6 error;
  error << found.T_camera_tool * tip - truth * tip,
      rotation_vector(found.T_camera_tool.rotation * truth.rotation.conjugate());
  return error;
}

// Prediction with 3 mm and 2 degrees at the markers' mean.
inline void set_prediction(const Tool& tool, const Pose& T_camera_tool, Prediction& prediction) {
  prediction.follows_motion = true;
  prediction.T_camera_tool = T_camera_tool;
  prediction.covariance.diagonal() << Vector3::Constant(9e-6), Vector3::Constant(1.2e-3);
  ASSERT_GT(tool.marker_count, 0);
}

}  // namespace glint::test

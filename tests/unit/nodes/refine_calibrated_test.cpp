// Node RefinePose: calibration corrections of a pose, and the systematic covariance that remains.
#include "tests/unit/nodes/refine_pose_scene.hpp"

namespace glint {
namespace {

using test::error_of;
using test::k_place;
using test::Random;

class RefineCalibrated : public test::RefinePoseTest {};

// Two tools with different markers in one frame. The camera's bias, already subtracted, is that of
// the first tool's markers.
TEST_F(RefineCalibrated, TakesEachToolsOwnDepthBiasInPlaceOfTheCameras) {
  Random random(21);
  constexpr double k_camera_bias_m = 0.006;
  Tool spheres = test::five_marker_pen(), discs = spheres;
  discs.depth_bias = {0.02, 0.03, 0.004, 0.3, 0.9};
  const Pose truths[] = {test::tilted_pose(spheres, 0.6, k_place, random),
                         test::tilted_pose(discs, 0.6, -k_place + Vector3(0, 0, 1), random)};
  add_tool(0, spheres, truths[0], 0, random);
  add_tool(1, discs, truths[1], 0, random);
  for (int i = 0; i < 5; ++i) {
    Marker& marker = marker_of(1, i);
    marker.peak = static_cast<std::uint16_t>(500 + 400 * i);
    marker.bias_subtracted_m = static_cast<float>(k_camera_bias_m);
    const double surface = marker.surface_range_m;
    double raw = surface;
    for (int again = 0; again < 20; ++again) raw = surface + discs.depth_bias.at(raw, marker.peak);
    marker.surface_range_m = raw - static_cast<double>(marker.bias_subtracted_m);
    marker_of(0, i).bias_subtracted_m = marker.bias_subtracted_m;
  }
  const FittedTools& fitted = run();
  for (int t = 0; t < 2; ++t) {
    const FittedTool& found = fitted.tools[static_cast<std::size_t>(t)];
    ASSERT_EQ(found.reason, Reason::none) << t;
    EXPECT_LT((found.T_camera_tool.translation - truths[t].translation).norm(), 1e-5) << t;
  }
}

// Points of another tracker have no peak value. Treated as the markers with the lowest signal, they
// would be metres too near.
TEST_F(RefineCalibrated, TakesNoDepthBiasOffAPointWithoutAnImage) {
  Random random(22);
  Tool tool = test::five_marker_pen();
  tool.depth_bias = {0.02, 0.03, 0.004, 0.3, 0.9};
  const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
  add_tool(0, tool, truth, 0, random);
  for (int i = 0; i < 5; ++i) marker_of(0, i).peak = 0;
  const FittedTool& found = run_one();
  ASSERT_EQ(found.reason, Reason::none);
  EXPECT_LT((found.T_camera_tool.translation - truth.translation).norm(), 1e-5);
}

TEST_F(RefineCalibrated, TakesAMeasuredMeanErrorOffWhereItHolds) {
  Random random(12);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  const Pose plain = run_one().T_camera_tool;
  node_.correction = {
      CorrectionFrame::camera, Vector3(0.002, 0, 0), Vector3::Zero(), {0, 2}, {-1, 1}, {-1, 1}};
  const Pose corrected = run_one().T_camera_tool;
  EXPECT_TRUE((corrected.translation - plain.translation).isApprox(Vector3(0.002, 0, 0), 1e-9));
  node_.correction.range_m = {1, 2};
  EXPECT_EQ(run_one().T_camera_tool.translation, plain.translation);
}

TEST_F(RefineCalibrated, StatesWhatCalibrationLeavesOpen) {
  Random random(21);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  tool.marker_sigma_m = 0;
  node_.uncertainty = k_exact_camera;
  add_tool(0, tool, truth, 1, random);
  EXPECT_TRUE(run_one().systematic.calibration.isZero());
  EXPECT_TRUE(run_one().systematic.correlated.sum().isZero());
  node_.uncertainty.range_offset_m = 0.004;
  const FittedTool& found = run_one();
  // Along the ray to the markers' mean, reduced by what the tool's size in pixels constrains.
  const Vector3 ray = (truth * tool.middle_m()).normalized();
  const Matrix3 position = found.systematic.calibration.topLeftCorner<3, 3>();
  EXPECT_GT(std::sqrt(ray.dot(position * ray)), 0.4 * 0.004);
  EXPECT_LT(std::sqrt(ray.dot(position * ray)), 0.004);
  EXPECT_LT(position.trace(), 1.5 * ray.dot(position * ray));
  node_.uncertainty = {};
  EXPECT_GT(run_one().systematic.correlated.sum().trace(), 0);
}

// Points without an image come from another tracker: only the tool's own geometry contributes.
TEST_F(RefineCalibrated, KnowsNoCameraOfPointsWithoutAnImage) {
  Random random(22);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  tool.marker_sigma_m = 0;
  add_tool(0, tool, truth, 1, random);
  for (int i = 0; i < tool.marker_count; ++i)
    marker_of(0, i).along_x = marker_of(0, i).along_y = Vector3::Zero();
  EXPECT_TRUE(run_one().systematic.calibration.isZero());
  set_.items[0].marker_sigma_m = 0.0003;
  EXPECT_GT(run_one().systematic.calibration.trace(), 0);
}

}  // namespace
}  // namespace glint

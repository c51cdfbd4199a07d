// Node RefinePose with few, partially occluded or merged markers, or an inflated covariance.
#include <numbers>

#include "kernels/pose/blob_size.hpp"
#include "tests/unit/nodes/refine_pose_scene.hpp"

namespace glint {
namespace {

using test::error_of;
using test::k_place;
using test::Random;
using test::set_prediction;

class RefineFew : public test::RefinePoseTest {};

TEST_F(RefineFew, BelievesThreeMarkersOnlyWhereTheMotionCanHaveBroughtTheTool) {
  Random random(15);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 1, random);
  Prediction& prediction = world_->predictions.tools[0];
  set_prediction(tool, aside, prediction);
  EXPECT_EQ(run_one().reason, Reason::none) << "five that agree are no chance";
  drop_marker(0, 4);
  drop_marker(0, 3);
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
  EXPECT_TRUE(run_one().covariance.isZero());
  set_prediction(tool, truth, prediction);
  EXPECT_EQ(run_one().reason, Reason::none);
  set_prediction(tool, aside, prediction);
  prediction.covariance *= 100;  // after a long occlusion
  EXPECT_EQ(run_one().reason, Reason::none);
  prediction = {};  // unknown motion
  EXPECT_EQ(run_one().reason, Reason::none);
}

// Area of a marker's blob that covers `part` of its disc, in pixels of the pinhole camera.
std::uint32_t area_of(const Tool& tool, const Pose& truth, int i, double part) {
  const Vector3 point = truth * tool.markers_m[static_cast<std::size_t>(i)];
  const double radius_px = 253 * tool.marker_radius_m / point.norm() + k_rim_px;
  return static_cast<std::uint32_t>(part * std::numbers::pi * radius_px * radius_px);
}

TEST_F(RefineFew, IsLessSureOfAMarkerWhoseBlobIsLargerThanTheOthers) {
  Random random(18);
  Tool tool = test::five_marker_pen();
  tool.marker_radius_m = 0.0055;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  drop_marker(0, 4);  // with five the fit would remove the bad marker
  Marker& merged = marker_of(0, 1);
  int lens_steps = 0;
  merged.centroid_px.x() += 0.6;
  const LocalRays rays =
      local_rays(test::pinhole(), merged.centroid_px, k_ray_steps_max, lens_steps).value;
  merged.ray = rays.ray;
  merged.along_x = rays.along_x;
  merged.along_y = rays.along_y;
  const auto error = [&](double part, double of_merged) {
    for (int i = 0; i < 4; ++i)
      marker_of(0, i).area_px = area_of(tool, truth, i, i == 1 ? of_merged : part);
    const FittedTool& found = run_one();
    EXPECT_EQ(found.reason, Reason::none);
    return error_of(found, truth, tool.tip_m).head<3>().norm();
  };
  const double unnoticed = error(1, 1);
  EXPECT_LT(error(1, 2.2), 0.3 * unnoticed);
  EXPECT_EQ(run_one().marker_mask, 15) << "it still counts";
  EXPECT_LT(error(1, 0.5), 0.3 * unnoticed) << "partly hidden";
  EXPECT_GT(error(2.2, 2.2), 0.8 * unnoticed) << "all are smeared alike";
}

TEST_F(RefineFew, BelievesFewWholeMarkersOnlyWhereTheMotionCanHaveBroughtTheTool) {
  Random random(19);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 1, random);
  set_prediction(tool, aside, world_->predictions.tools[0]);
  EXPECT_EQ(run_one().reason, Reason::none);
  for (int i = 0; i < 2; ++i) marker_of(0, i).flags = k_marker_not_isolated;
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
  set_prediction(tool, truth, world_->predictions.tools[0]);
  EXPECT_EQ(run_one().reason, Reason::none);
}

// Two of five markers are merged or half occluded, so three isolated ones remain.
TEST_F(RefineFew, CountsNoMarkerOfAnotherSizeAsWhole) {
  Random random(19);
  Tool tool = test::five_marker_pen();
  tool.marker_radius_m = 0.0055;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 1, random);
  for (const double part : {1.0, 2.2, 0.5}) {
    for (int i = 0; i < 5; ++i) {
      marker_of(0, i).area_px = area_of(tool, truth, i, i < 2 ? part : 1);
    }
    set_prediction(tool, aside, world_->predictions.tools[0]);
    EXPECT_EQ(run_one().reason == Reason::none, part == 1) << part;
    set_prediction(tool, truth, world_->predictions.tools[0]);
    EXPECT_EQ(run_one().reason, Reason::none) << part;
    EXPECT_EQ(run_one().has_relinearised, part != 1) << part;
  }
}

TEST_F(RefineFew, TellsAFilterWhatFewMarkersSayNearWhereItExpectsTheTool) {
  Random random(20);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 1, random);
  Prediction& prediction = world_->predictions.tools[0];
  set_prediction(tool, truth, prediction);
  EXPECT_FALSE(run_one().has_relinearised) << "five that agree need no help";
  drop_marker(0, 4);
  drop_marker(0, 3);
  ASSERT_TRUE(run_one().has_relinearised);
  const UncertainPose told = filter_measurement_of(run_one(), tool, Time{});
  EXPECT_EQ(told.pose.translation, Vector3(run_one().relinearised_T_camera_tool * tool.middle_m()));
  EXPECT_EQ(told.covariance, run_one().relinearised_covariance);
  EXPECT_LT((told.pose.translation - truth * tool.middle_m()).norm(), 0.01);
  prediction = {};
  EXPECT_FALSE(run_one().has_relinearised) << "nothing is expected";
  const UncertainPose alone = filter_measurement_of(run_one(), tool, Time{});
  EXPECT_EQ(alone.pose.translation, Vector3(run_one().T_camera_tool * tool.middle_m()));
}

TEST_F(RefineFew, IsTheLessSureOfThreeMarkersTheLessTheyWereExpected) {
  Random random(17);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  Prediction& prediction = world_->predictions.tools[0];
  const auto sigma_aside = [&](double sigmas) {
    set_prediction(tool, truth, prediction);
    const double sigma_m = std::sqrt(prediction.covariance(0, 0));
    set_prediction(tool, {truth.rotation, truth.translation + Vector3(sigmas * sigma_m, 0, 0)},
                   prediction);
    return std::sqrt(run_one().covariance(0, 0));
  };
  const double all = sigma_aside(0);
  EXPECT_NEAR(sigma_aside(4), all, 1e-4 * all) << "five that agree are no chance";
  drop_marker(0, 4);
  drop_marker(0, 3);
  const double expected = sigma_aside(0);
  EXPECT_EQ(sigma_aside(1), expected) << "no more than noise";
  const double unexpected = sigma_aside(4);
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_GT(unexpected, 1.3 * expected);
  EXPECT_LE(unexpected, std::sqrt(16.0 / 6) * (1 + 1e-9) * expected);
}

TEST_F(RefineFew, ForgivesOnlyWhatTheMotionExplains) {
  Random random(16);
  Tool tool = test::five_marker_pen();
  tool.marker_count = 4;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 0, random);
  world_->assignment.labeling[0].log_prior_ratio_m2 = 1e-5;
  marker_of(0, 2).surface_range_m += 0.03;
  Prediction& prediction = world_->predictions.tools[0];
  set_prediction(tool, truth, prediction);
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_EQ(run_one().marker_mask, 0b1011);
  set_prediction(tool, aside, prediction);
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
}

}  // namespace
}  // namespace glint

// Worst-case loop counts of each node under a cell's limits, and derived fields of a tool.
#include "nodes/node_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/pose/lever_arm.hpp"
#include "nodes/anchor_head.hpp"
#include "nodes/check_frame.hpp"
#include "nodes/follow_motion.hpp"
#include "nodes/locate_rois.hpp"
#include "nodes/name_few.hpp"
#include "nodes/pack_can.hpp"
#include "nodes/pose_nodes.hpp"
#include "nodes/predict_tools.hpp"
#include "nodes/predict_tracks.hpp"
#include "nodes/refine_pose.hpp"
#include "nodes/track_tools.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::node_limits_test {
namespace {

using graph::LoopCounts;

constexpr Limits k_small{
    .tools = 5, .markers_per_tool = 3, .blobs = 65, .lens_steps = 13, .search_steps = 11};

// Five tools in four slices: the first slice has two.
TEST(NodeLimits, ShareTheToolsAmongTheSlices) {
  const int expected[] = {2, 1, 1, 1};
  int sum = 0;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(tools_of(k_small, {i, 4}), expected[i]);
    sum += tools_of(k_small, {i, 4});
  }
  EXPECT_EQ(sum, 5);
  EXPECT_EQ(tools_of(k_small, {0, 1}), 5);
  EXPECT_EQ(tools_of(k_small, {7, 8}), 0);
  EXPECT_EQ(tools_of({.tools = 0}, {3, 4}), 0);
  EXPECT_EQ(tools_of({.tools = 1}, {9, 4}), 0);
}

TEST(NodeLimits, BoundAToolSetAndItsTools) {
  ToolSet set;
  Tool tool;
  for (const int count : {0, 4, 5, 6}) {
    set.count = count;
    EXPECT_EQ(tools_within(set, k_small), std::min(count, 5));
  }
  for (const int count : {0, 2, 3, 4}) {
    tool.marker_count = count;
    EXPECT_EQ(markers_within(tool, k_small), std::min(count, 3));
  }
}

// 65 blobs give 2,080 pairs and fill two words; a tool has three distances and 11 steps.
TEST(WorstCounts, OfCorrespondAreProductsOfTheLimits) {
  EXPECT_EQ(glint::Correspond::worst(k_small),
            (LoopCounts{
                {1, 2, 2 * 65, 2 * 2'080, 2 * 2'080 * 3, 2 * 3 * 65 * 2, 2 * 11, 2 * 11 * 3 * 2}}));
  EXPECT_EQ(glint::Correspond::worst(k_small, {3, 4}),
            (LoopCounts{{1, 1, 65, 2'080, 2'080 * 3, 3 * 65 * 2, 11, 11 * 3 * 2}}));
  Limits limits = k_small;
  limits.blobs = 64;
  EXPECT_EQ(glint::Correspond::worst(limits)[5], 2 * 3 * 64) << "one word";
  limits.markers_per_tool = 5;
  EXPECT_EQ(glint::Correspond::worst(limits)[4], 2 * 2'016 * 10) << "ten distances";
}

TEST(WorstCounts, OfTheOtherNodesAreProductsOfTheLimits) {
  EXPECT_EQ(glint::StampFrame::worst(k_small), (LoopCounts{{1}}));
  EXPECT_EQ(glint::StampFrame{}.counts(), (LoopCounts{{1}}));
  EXPECT_EQ(glint::CheckFrame::worst(k_small), (LoopCounts{{1}}));
  EXPECT_EQ(glint::CheckFrame{}.counts(), (LoopCounts{{1}}));
  EXPECT_EQ(glint::PredictTracks::worst(k_small), (LoopCounts{{1, 5, 5, 15, 15 * 13}}));
  EXPECT_EQ(glint::LocateRois::worst(k_small), (LoopCounts{{1, 5, 4 * 4}}));
  EXPECT_EQ(glint::AssignMarkers::worst(k_small), (LoopCounts{{1, 5, 5, assign_tests_worst(5)}}));
  EXPECT_EQ(glint::NameFew::worst(k_small), (LoopCounts{{1, 5, 15, (15 + 5) * 65}}));
  EXPECT_EQ(glint::AnchorHead::worst(k_small), (LoopCounts{{1, 1}}));
  EXPECT_EQ(glint::FollowMotion::worst(k_small),
            (LoopCounts{{1, 2, 2, 2 * k_static_window_levels}}));
  EXPECT_EQ(glint::FollowMotion::worst(k_small, {1, 4}),
            (LoopCounts{{1, 1, 1, k_static_window_levels}}));
  EXPECT_EQ(glint::TrackTools::worst(k_small), (LoopCounts{{1, 5, 5}}));
  EXPECT_EQ(glint::PredictTools::worst(k_small), (LoopCounts{{1, 5, 5}}));
  EXPECT_EQ(glint::PackCan::worst(k_small), (LoopCounts{{1, 5, 5, 3}}));
}

// Counts of the fit with each of three markers removed in turn, the alternative labeling, the fit
// with the prediction, and the residuals. They grow with the markers; twice the tools give twice
// the counts.
TEST(WorstCounts, OfRefinePoseGrowWithToolsAndMarkers) {
  const LoopCounts one = glint::RefinePose::worst(k_small, {1, 4}),
                   two = glint::RefinePose::worst(k_small);
  EXPECT_EQ(one[0], 1);
  EXPECT_EQ(one[1], 1);
  EXPECT_EQ(two[1], 2);
  for (std::size_t loop = 2; loop < 5; ++loop) EXPECT_EQ(two[loop], 2 * one[loop]) << loop;
  EXPECT_GT(one[4], one[3]) << "several markers a step";
  EXPECT_LE(one[4], 3 * one[3]);
  Limits more = k_small;
  more.markers_per_tool = 6;
  EXPECT_GT(glint::RefinePose::worst(more, {1, 4})[2], one[2]) << "more to leave out";
  EXPECT_GT(glint::RefinePose::worst(more, {1, 4})[4], 2 * one[4]);
}

// A tool whose markers' mean and tip differ, as the camera sees it.
class OfATool : public testing::Test {
 protected:
  OfATool() {
    tool_.marker_count = 3;
    tool_.markers_m = {Vector3(0, 0, 0.3), Vector3(0.06, 0, 0.1), Vector3(0, 0.06, 0.2)};
    tool_.tip_m = Vector3(0.01, -0.02, -0.1);
    tool_.tip_sigma_m = 0.002;
    found_.T_camera_tool = {random_.rotation(), Vector3(0.1, 0.2, 0.6)};
    found_.covariance = test::random_covariance<6>(random_, 0.002);
    found_.relinearised_T_camera_tool = {random_.rotation(), Vector3(0.3, 0.1, 0.5)};
    found_.relinearised_covariance = test::random_covariance<6>(random_, 0.003);
  }
  test::Random random_{7};
  Tool tool_;
  FittedTool found_;
};

TEST_F(OfATool, TheMiddleIsAPoseWithTheTipsCovarianceMovedThere) {
  const Vector3 middle(0.02, 0.02, 0.2);
  const UncertainPose seen = centroid_pose_of(found_, tool_, Time{5});
  EXPECT_EQ(seen.time, Time{5});
  EXPECT_LT((seen.pose.translation - found_.T_camera_tool * middle).norm(), 1e-15);
  EXPECT_EQ(seen.pose.rotation.coeffs(), found_.T_camera_tool.rotation.coeffs());
  const Matrix6 lever =
      pose_by_pose(found_.T_camera_tool.rotation * Vector3(0.01, 0.04, 0.3));  // from the tip
  EXPECT_LT((seen.covariance - lever * found_.covariance * lever.transpose()).norm(), 1e-15);
}

TEST_F(OfATool, AFilterReceivesTheMiddleOrWhatFewMarkersShowOfIt) {
  const UncertainPose plain = filter_measurement_of(found_, tool_, Time{5});
  const UncertainPose middle = centroid_pose_of(found_, tool_, Time{5});
  EXPECT_EQ(plain.pose.translation, middle.pose.translation);
  EXPECT_EQ(plain.covariance, middle.covariance);
  found_.has_relinearised = true;
  const UncertainPose near = filter_measurement_of(found_, tool_, Time{6});
  EXPECT_EQ(near.time, Time{6});
  EXPECT_LT((near.pose.translation - found_.relinearised_T_camera_tool * tool_.middle_m()).norm(),
            1e-15);
  EXPECT_EQ(near.pose.rotation.coeffs(), found_.relinearised_T_camera_tool.rotation.coeffs());
  EXPECT_EQ(near.covariance, found_.relinearised_covariance);
}

TEST_F(OfATool, TheTipIsAnArmFromTheMiddleWithAnErrorOfItsOwn) {
  const TipPosition tip = tip_of(tool_);
  EXPECT_LT((tip.arm_m - Vector3(-0.01, -0.04, -0.3)).norm(), 1e-15);
  EXPECT_EQ(tip.sigma_m, 0.002);
  const Matrix6 of_middle = test::random_covariance<6>(random_, 0.002);
  const Quaternion turn = random_.rotation();
  Matrix6 expected =
      pose_by_pose(turn * tip.arm_m) * of_middle * pose_by_pose(turn * tip.arm_m).transpose();
  for (int axis = 0; axis < 3; ++axis) expected(axis, axis) += 4e-6;
  EXPECT_LT((tip.systematic_of(of_middle, turn) - expected).norm(), 1e-15);
}

// Numerical differentiation: small translations and rotations of the pose, one at a time.
TEST_F(OfATool, APredictedMarkersPlaceMovesWithShiftAndTurn) {
  Prediction prediction;
  prediction.T_camera_tool.rotation = random_.rotation();
  prediction.covariance = test::random_covariance<6>(random_, 0.01);
  const Vector3 from_middle(0.03, -0.08, 0.05);
  Eigen::Matrix<double, 3, 6> j;
  for (int i = 0; i < 3; ++i) {
    const Vector3 lever = prediction.T_camera_tool.rotation * from_middle;
    j.col(i) = Vector3::Unit(i);
    constexpr double k_step = 1e-6;
    j.col(3 + i) = (from_rotation_vector(k_step * Vector3::Unit(i)) * lever -
                    from_rotation_vector(-k_step * Vector3::Unit(i)) * lever) /
                   (2 * k_step);
  }
  const Matrix3 expected = j * prediction.covariance * j.transpose();
  EXPECT_LT((prediction.marker_position_covariance(from_middle) - expected).norm(), 1e-10);
}

TEST_F(OfATool, ALabelingIsTheRivalsWhereThePoseIs) {
  Assignment assignment;
  EXPECT_EQ(&labeling_of(assignment, found_, 3), &assignment.labeling[3]);
  found_.by_alternative = true;
  EXPECT_EQ(&labeling_of(assignment, found_, 3), &assignment.alternative[3]);
}

TEST_F(OfATool, OddsBelowTheLeastAreAmbiguous) {
  found_.odds = k_odds_min;
  EXPECT_FALSE(found_.ambiguous());
  found_.odds = std::nextafter(k_odds_min, 0);
  EXPECT_TRUE(found_.ambiguous());
}

TEST(PenButtonsOfATool, AreTheFirstToolsAlone) {
  const PenButtons buttons{5};
  EXPECT_EQ(buttons.of_tool(0), 5);
  EXPECT_EQ(buttons.of_tool(1), 0);
}

}  // namespace
}  // namespace glint::node_limits_test

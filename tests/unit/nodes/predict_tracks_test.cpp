#include "nodes/predict_tracks.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint {
namespace {

constexpr double k_half_pi = 1.57079632679489661923;

// One tool at 0.5 m, seen at 1 s.
class PredictTracks : public testing::Test {
 protected:
  PredictTracks() {
    node_.camera.width = node_.camera.height = 512;
    node_.camera.fx = node_.camera.fy = 250;
    node_.camera.cx = node_.camera.cy = 256;
    tools_->count = 1;
    tool().marker_count = 3;
    tool().markers_m = {Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0), Vector3(0, 0.06, 0)};
    tool().marker_radius_m = 0.005;
    EXPECT_EQ(prepare_tool(tool()), Reason::none);
    track().alive = track().measured_now = true;
    track().identity = tool().identity;
    track().newest.time = track().motion.time = Time{} + milliseconds(1000);
    place({Quaternion::Identity(), Vector3(0, 0, 0.5)});
  }
  Tool& tool() { return tools_->items[0]; }
  Track& track() { return last_->tracks[0]; }
  void place(const Pose& T_base_tool) {
    track().newest.pose = track().T_camera_tool = T_base_tool;
    track().motion.pose = {T_base_tool.rotation, T_base_tool * tool().middle_m()};
  }
  void set_standard_deviations(double position_m, double rotation_rad) {
    MotionCovariance& p = track().motion.covariance;
    p.setZero();
    p.diagonal().segment<3>(k_position).setConstant(position_m * position_m);
    p.diagonal().segment<3>(k_rotation).setConstant(rotation_rad * rotation_rad);
  }
  const Prediction& predict(std::int64_t gap_ms = 22) {
    graph::Latest<ToolSet> tools;
    tools.set(*tools_, 1, 0);
    FrameVerdict verdict;
    verdict.resynchronised = restarted_;
    verdict.stamp.mid_exposure = Time{} + milliseconds(1000 + gap_ms);
    verdict.accepted = verdict_accepted_;
    node_(verdict, head_, tools, graph::Previous<Anchor>(anchor_),
          graph::Previous<Estimates>(*last_), *predictions_);
    return predictions_->tools[0];
  }

  std::uint32_t verdict_accepted_ = 7;
  std::unique_ptr<ToolSet> tools_ = std::make_unique<ToolSet>();
  bool restarted_ = false;
  HeadPose head_;
  Anchor anchor_;
  std::unique_ptr<Estimates> last_ = std::make_unique<Estimates>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  glint::PredictTracks node_;
};

TEST_F(PredictTracks, HasTheWholeFrameSearchedUnlessEachToolWasSeen) {
  predict();
  EXPECT_FALSE(predictions_->search_whole_frame);
  track().measured_now = false;
  predict();
  EXPECT_TRUE(predictions_->search_whole_frame) << "missed in the last frame";
  track().measured_now = true;
  tools_->count = 2;
  predict();
  EXPECT_FALSE(predictions_->search_whole_frame) << "the second place is empty";
  tools_->items[1] = tool();
  tools_->items[1].identity = tool().identity + 1;
  predict();
  EXPECT_TRUE(predictions_->search_whole_frame) << "the second tool was never found";
  EXPECT_FALSE(predictions_->search_part_of_frame);
  last_->tracks[1].reason = Reason::runs_full;
  predict();
  EXPECT_TRUE(predictions_->search_part_of_frame);
  verdict_accepted_ = 32;
  predict();
  EXPECT_FALSE(predictions_->search_part_of_frame) << "now and then the whole frame";
}

TEST_F(PredictTracks, HandsOnTheOddsOfTheMotion) {
  track().odds = 7;
  EXPECT_EQ(predict().odds, 7);
}

TEST_F(PredictTracks, CountsItsToolsThoseItMovedAndTheirMarkers) {
  predict();
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1, 1, 3}}));
  track().base = ReferenceFrame::world;  // the head's pose is unknown
  predict();
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1, 0, 3}}));
  track().alive = false;
  predict();
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

TEST_F(PredictTracks, GoesOnWithTheMotionThatTheFilterFollowed) {
  track().motion.velocity_m_s = {0.5, 0, 0};
  track().motion.angular_velocity_rad_s = {0, 0, 2};
  const Prediction& found = predict(20);
  const Vector3 middle = found.T_camera_tool * tool().middle_m();
  EXPECT_NEAR(middle.x(), 0.010, 1e-6);
  EXPECT_NEAR(middle.z(), 0.5, 1e-9);
  const Vector3 across = found.T_camera_tool.rotation * Vector3::UnitX();
  EXPECT_NEAR(across.y(), 0.040, 1e-3) << "turned about the markers' middle";
}

// Markers at a focal length of 250 px and 0.5 m: 25 px beside and 30 px below the centre, plus the
// reach and a marker's width on each side.
TEST_F(PredictTracks, BoundsItsMarkersWithTheReachAboutThem) {
  const Prediction& found = predict();
  EXPECT_TRUE(found.in_view);
  const double around = 250 * (found.reach_m + 2 * 0.005) / 0.5;
  EXPECT_NEAR(found.low_px.x(), 256 - 25 - around, 1e-6);
  EXPECT_NEAR(found.low_px.y(), 256 - around, 1e-6);
  EXPECT_NEAR(found.high_px.x(), 256 + 25 + around, 1e-6);
  EXPECT_NEAR(found.high_px.y(), 256 + 30 + around, 1e-6);
  ASSERT_EQ(predictions_->marker_count, 3);
  const Vector2 expected[] = {{231, 256}, {281, 256}, {256, 286}};
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_LT((predictions_->markers_px[m] - expected[m]).norm(), 1e-6) << m;
  }
}

TEST_F(PredictTracks, TakesNoMarkerForNearerThanFiveCentimetres) {
  place({Quaternion::Identity(), Vector3(0, 0, 0.03)});
  tool().markers_m = {Vector3(-0.01, 0, 0), Vector3(0.01, 0, 0), Vector3(0, 0.01, 0)};
  place({Quaternion::Identity(), Vector3(0, 0, 0.03)});
  const Prediction& found = predict();
  const double around = 250 * (found.reach_m + 2 * 0.005) / 0.05;
  EXPECT_NEAR(found.low_px.x(), 256 - 250 * 0.01 / 0.03 - around, 1e-6);
}

// Two of three markers are in front of the camera.
TEST_F(PredictTracks, IsNotInViewWithAMarkerThatHasNoPixel) {
  tool().markers_m[2].z() = -0.6;
  place({Quaternion::Identity(), Vector3(0, 0, 0.5)});
  const Prediction& found = predict();
  EXPECT_TRUE(found.has_prior);
  EXPECT_FALSE(found.in_view);
  EXPECT_EQ(predictions_->marker_count, 2);
  EXPECT_LT(found.low_px.x(), 231);
  EXPECT_TRUE(predictions_->search_whole_frame) << "part of it may be anywhere";
}

TEST_F(PredictTracks, ListsTheMarkersOfAllItsToolsAndNoMoreThanTheCellHas) {
  tools_->count = 3;
  for (const std::size_t t : {1U, 2U}) {
    tools_->items[t] = tool();
    last_->tracks[t] = track();
  }
  (void)predict();
  EXPECT_EQ(predictions_->marker_count, 9);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 3, 3, 9}}));
  node_.limits.tools = 2;
  node_.limits.markers_per_tool = 2;
  (void)predict();
  EXPECT_EQ(predictions_->marker_count, 4);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 2, 2, 4}}));
  EXPECT_FALSE(predictions_->tools[2].has_prior) << "the frame before had it";
}

TEST_F(PredictTracks, HandsOnTheFramesTurnAndTheNoiseThatWasSeen) {
  last_->noise.has_residuals = true;
  last_->noise.range_sigma_m = 0.0021;
  last_->noise.pixel_sigma_px = 0.37;
  track().measured_now = false;
  verdict_accepted_ = 123;
  EXPECT_TRUE(predict().undetected_last);
  EXPECT_EQ(predictions_->frame_number, 123U);
  EXPECT_TRUE(predictions_->noise.has_residuals);
  EXPECT_EQ(predictions_->noise.range_sigma_m, 0.0021);
  EXPECT_EQ(predictions_->noise.pixel_sigma_px, 0.37);
}

TEST_F(PredictTracks, NarrowsTheSearchOnlyForAToolThatIsPresent) {
  last_->tracks[0].reason = Reason::runs_full;
  (void)predict();
  EXPECT_TRUE(predictions_->search_part_of_frame);
  tool().marker_count = 0;
  (void)predict();
  EXPECT_FALSE(predictions_->search_part_of_frame);
  EXPECT_FALSE(predictions_->search_whole_frame) << "there is none to be looked for";
}

TEST_F(PredictTracks, PredictsNothingFromBeforeTheClockRestarted) {
  ASSERT_TRUE(predict().has_prior);
  restarted_ = true;
  EXPECT_FALSE(predict().has_prior);
  EXPECT_EQ(predictions_->marker_count, 0);
}

TEST_F(PredictTracks, ReachesAsFarAsTheCovarianceSaysBetweenAFloorAndACeiling) {
  const double start = 0.5 * 30 * 0.022 * 0.022;
  set_standard_deviations(1e-5, 1e-4);
  EXPECT_NEAR(predict().reach_m, 0.0045 + start, 1e-4) << "a hand at rest may set off";
  set_standard_deviations(0.0025, 1e-4);
  EXPECT_NEAR(predict().reach_m, 8 * 0.0025, 5e-4);
  set_standard_deviations(1e-5, 0.05);
  // The marker furthest from the mean has the largest standard deviation. The bound is at most a
  // fifth too large.
  const double furthest = 8 * 0.05 * (tool().markers_m[0] - tool().middle_m()).norm();
  EXPECT_GE(predict().reach_m, furthest);
  EXPECT_LE(predict().reach_m, 1.2 * furthest);
  set_standard_deviations(1, 1);
  EXPECT_NEAR(predict().reach_m, 0.015 + 0.022 + start, 1e-9);
}

TEST_F(PredictTracks, ReachesFurtherWhereTheLastMeasurementWasASurprise) {
  set_standard_deviations(0.002, 1e-4);
  const double before = predict().reach_m;
  track().nis_ratio = 4;
  EXPECT_NEAR(predict().reach_m, 2 * before, 1e-3);
}

TEST_F(PredictTracks, LooksNowhereElseOnlyForAToolWhoseSpeedItKnows) {
  set_standard_deviations(0.001, 1e-3);
  const auto fast_within = [&](double x, double y, double z) {
    track().motion.covariance.diagonal().segment<3>(k_velocity) = Vector3(x, y, z).cwiseAbs2();
  };
  fast_within(0.1, 0.1, 0.1);
  EXPECT_TRUE(predict().within_reach_only);
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 velocity_sigma = Vector3::Constant(0.1);
    velocity_sigma[axis] = 0.5;  // found once: its standard deviation is that of a hand's speed
    fast_within(velocity_sigma.x(), velocity_sigma.y(), velocity_sigma.z());
    EXPECT_FALSE(predict().within_reach_only) << axis;
    EXPECT_TRUE(predict().follows_motion);
  }
}

TEST_F(PredictTracks, HoldsTheToolBeyondTheHorizonAndReachesWhereItMayBe) {
  set_standard_deviations(1e-4, 1e-3);
  track().motion.velocity_m_s = {0.5, 0, 0};
  const Prediction& found = predict(100);
  EXPECT_NEAR((found.T_camera_tool * tool().middle_m()).x(), 0, 1e-9);
  EXPECT_GT(found.reach_m, 0.05);
}

TEST_F(PredictTracks, TurnsTheCovarianceIntoTheCamera) {
  head_.valid = true;
  head_.T_world_camera.rotation = from_rotation_vector(Vector3(0, 0, k_half_pi));
  track().base = ReferenceFrame::world;
  place(head_.T_world_camera * track().T_camera_tool);
  set_standard_deviations(1e-4, 1e-4);
  track().motion.covariance(0, 0) = 1e-4;  // along the world's x, which is the camera's -y
  const Prediction& found = predict(1);
  ASSERT_TRUE(found.follows_motion);
  EXPECT_NEAR(found.covariance(1, 1), 1e-4, 1e-6);
  EXPECT_LT(found.covariance(0, 0), 1e-6);
  EXPECT_NEAR((found.T_camera_tool * tool().middle_m()).z(), 0.5, 1e-9);
}

TEST_F(PredictTracks, CountsWhatTheHeadsetsErrorMayHaveChangedBySince) {
  head_.valid = true;
  track().base = ReferenceFrame::world;
  set_standard_deviations(1e-4, 1e-4);
  const double alone = predict(22).covariance(0, 0);
  HeadNoise noise;
  noise.rest_position_m = 0.01;
  noise.rest_angle_rad = 0;
  // A correction by a reference body just before does not change the predicted growth.
  const UncertainPose body{head_.time, {}, Matrix6::Identity() * 1e-8};
  for (int sight = 0; sight <= k_body_definition_frames; ++sight) {
    head_.time = Time{} + milliseconds(1 + sight);
    (void)anchor_.state.update(head_, &body, noise);
  }
  // 2 (1 - exp(-22 / 400))
  EXPECT_NEAR(predict(22).covariance(0, 0) - alone, 0.107029 * 1e-4, 1e-9);
}

// The hand's speed bounds the tool's motion in the world, not the drift of the world frame.
TEST_F(PredictTracks, ReachesAsFarAsTheHeadsetMayErr) {
  head_.valid = true;
  track().base = ReferenceFrame::world;
  set_standard_deviations(1e-5, 1e-4);
  const double hand = predict().reach_m;
  HeadNoise noise;
  noise.rest_position_m = 0.1;
  noise.rest_angle_rad = 0;
  (void)anchor_.state.update(head_, nullptr, noise);
  // 2 (1 - exp(-22 / 400)) of the variance
  EXPECT_GT(predict().reach_m, 8 * 0.0327);
  EXPECT_LT(predict().reach_m, 8 * 0.0328 + hand);
}

TEST_F(PredictTracks, HoldsWhatTheCameraSawWhereTheHeadsPoseWentMissing) {
  track().base = ReferenceFrame::world;
  track().motion.velocity_m_s = {0.5, 0, 0};
  const Prediction& found = predict(22);
  EXPECT_FALSE(found.follows_motion);
  EXPECT_EQ(found.T_camera_tool.translation, track().T_camera_tool.translation);
  EXPECT_GT(found.reach_m, 0.04);
}

TEST_F(PredictTracks, ForgetsAToolOlderThanLostAfter) {
  EXPECT_TRUE(predict(250).has_prior);
  EXPECT_FALSE(predict(251).has_prior);
}

TEST_F(PredictTracks, KnowsNothingOfAnotherToolInTheSamePlace) {
  ASSERT_TRUE(predict().has_prior);
  tool().markers_m[0].x() -= 0.002;
  ASSERT_EQ(prepare_tool(tool()), Reason::none);
  EXPECT_FALSE(predict().has_prior);
}

}  // namespace
}  // namespace glint

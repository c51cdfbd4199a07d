#include "nodes/track_tools.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace glint {
namespace {

class TrackToolsInTime : public testing::Test {
 protected:
  TrackToolsInTime() {
    set_->count = 1;
    Tool& tool = set_->items[0];
    tool.marker_count = 3;
    tool.markers_m = {Vector3(0, 0, 0), Vector3(0.06, 0, 0), Vector3(0, 0.06, 0)};
    tool.identity = 5;
  }
  TrackedTool& followed() { return (*followed_)[0].items[0]; }
  const Track& frame() {
    graph::Latest<ToolSet> tools;
    tools.set(*set_, 1, 0);
    FrameVerdict verdict;
    verdict.reason = refused_ ? Reason::frame_late : Reason::none;
    verdict.resynchronised = restarted_;
    verdict.stamp.mid_exposure = followed().estimate.time = Time{} + milliseconds(22) * ++number_;
    verdict.stamp.sequence = static_cast<std::uint32_t>(number_);
    *last_ = *out_;
    node_(verdict, Anchor{}, tools, *fitted_, *followed_, graph::Previous<Estimates>(*last_),
          *out_);
    return out_->tracks[0];
  }
  const Track& found(bool is_publishable = true) {
    followed().reason = Reason::none;
    followed().is_publishable = is_publishable;
    (*fitted_)[0].tools[0].marker_mask = 7;
    return frame();
  }
  const Track& partial_frame(bool is_publishable) {
    followed().reason = Reason::too_few_markers;
    followed().partial_mask = 3;
    followed().is_publishable = is_publishable;
    return frame();
  }
  bool refused_ = false, restarted_ = false;
  int number_ = 0;
  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  std::unique_ptr<graph::Parts<FittedTools, k_tool_partitions>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
  std::unique_ptr<graph::Parts<FollowedTools, k_tool_partitions>> followed_ =
      std::make_unique<graph::Parts<FollowedTools, k_tool_partitions>>();
  std::unique_ptr<Estimates> last_ = std::make_unique<Estimates>(),
                             out_ = std::make_unique<Estimates>();
  TrackTools node_;
};

TEST_F(TrackToolsInTime, MakesAPoseByFewMarkersTheNewestAndKeepsWhyThereAreNoMore) {
  (void)found();
  followed().estimate.pose.translation = {0.1, 0, 0.5};
  const Track& track = partial_frame(true);
  EXPECT_EQ(track.newest.time, Time{} + milliseconds(44));
  EXPECT_EQ(track.marker_mask, 3);
  EXPECT_EQ(track.reason, Reason::too_few_markers);
  EXPECT_FALSE(track.measured_now) << "the whole frame is searched for the others";
  const Vector3 middle = track.newest.pose * set_->items[0].middle_m();
  EXPECT_LT((middle - Vector3(0.1, 0, 0.5)).norm(), 1e-12);
}

TEST_F(TrackToolsInTime, EstimatesTheNoiseFromPosesAndFromNothingElse) {
  (*fitted_)[0].tools[0].residuals = {{9e-6, 1}, {0.04, 4}};
  (void)partial_frame(true);
  EXPECT_FALSE(out_->noise.has_residuals);
  for (int i = 0; i < 2000; ++i) (void)found();
  EXPECT_NEAR(out_->noise.range_sigma_m, 0.003, 1e-4);
  EXPECT_NEAR(out_->noise.pixel_sigma_px, 0.1, 1e-3);
  const double freedom = out_->noise.sums.range.redundancy;
  refused_ = true;
  (void)found();
  EXPECT_EQ(out_->noise.sums.range.redundancy, freedom) << "a refused frame shows nothing";
  EXPECT_TRUE(out_->noise.has_residuals) << "and what was known stays";
}

// With so large a noise estimate every pose may be `imprecise`.
TEST_F(TrackToolsInTime, ComesBackFromTooLargeANoise) {
  (*fitted_)[0].tools[0].residuals = {{4e-4, 1}, {4, 4}};
  for (int i = 0; i < 1000; ++i) (void)found();
  EXPECT_GT(out_->noise.range_sigma_m, 0.015);
  (*fitted_)[0].tools[0].residuals = {{1e-6, 1}, {0.01, 4}};
  for (int i = 0; i < 3000; ++i) (void)found(false);
  EXPECT_LT(out_->noise.range_sigma_m, 0.0012);
}

TEST_F(TrackToolsInTime, KeepsToTheDeclaredNoiseWhereItIsToldTo) {
  node_.estimate_noise = false;
  (*fitted_)[0].tools[0].residuals = {{9e-6, 1}, {0.04, 4}};
  for (int i = 0; i < 10; ++i) (void)found();
  EXPECT_FALSE(out_->noise.has_residuals);
}

TEST_F(TrackToolsInTime, CountsItsToolsAndThoseThatWereFound) {
  (void)found();
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1, 1}}));
  (void)partial_frame(true);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1}}));
}

TEST_F(TrackToolsInTime, LosesAToolWhosePoseByFewMarkersIsTooUnsure) {
  (void)found();
  for (int i = 0; i < 11; ++i) {
    const Track& track = partial_frame(false);
    ASSERT_TRUE(track.alive);
    EXPECT_EQ(track.newest.time, Time{} + milliseconds(22));
    EXPECT_EQ(track.motion.time, Time{} + milliseconds(22) * number_);
    EXPECT_EQ(track.marker_mask, 7);
  }
  EXPECT_FALSE(partial_frame(false).alive) << "250 ms after the last that stood";
}

TEST_F(TrackToolsInTime, FollowsAnAmbiguousPoseWithoutGivingItOut) {
  FittedTool& fit = (*fitted_)[0].tools[0];
  fit.odds = 5;
  followed().ambiguous = true;
  const Track first = found(false);
  EXPECT_TRUE(first.alive && first.unconfirmed);
  EXPECT_FALSE(first.measured_now);
  EXPECT_EQ(first.reason, Reason::ambiguous);
  EXPECT_EQ(first.odds, 5) << "what the next frame's evidence adds to";
  fit.odds = 20;
  followed().ambiguous = false;
  const Track settled = found();
  EXPECT_TRUE(settled.measured_now);
  EXPECT_FALSE(settled.unconfirmed);
  // A tool with a settled hypothesis is predicted through an ambiguous frame ...
  fit.odds = 5;
  followed().ambiguous = true;
  const Track again = found(false);
  EXPECT_FALSE(again.unconfirmed || again.measured_now);
  EXPECT_EQ(again.newest.time, settled.newest.time);
  // ... but not if the other hypothesis was chosen.
  fit.contradicts_track = true;
  EXPECT_TRUE(found(false).unconfirmed);
}

TEST_F(TrackToolsInTime, ShowsTheFiltersPoseWhereTheMarkersAloneAreUnsure) {
  (*fitted_)[0].tools[0].T_camera_tool.translation = {0, 0, 0.6};
  followed().estimate.pose.translation = Vector3(0, 0, 0.5) + set_->items[0].middle_m();
  EXPECT_NEAR(found().T_camera_tool.translation.z(), 0.6, 1e-12);
  followed().use_filter_pose = true;
  EXPECT_NEAR(found().T_camera_tool.translation.z(), 0.5, 1e-12);
  EXPECT_TRUE(out_->tracks[0].is_filter_pose);
}

TEST_F(TrackToolsInTime, CallsNoPoseMeasuredThatIsUnsureButGoesOnByIt) {
  EXPECT_TRUE(found(false).unconfirmed) << "a first pose that is imprecise";
  EXPECT_FALSE(out_->tracks[0].measured_now);
  EXPECT_EQ(out_->tracks[0].reason, Reason::imprecise);
  EXPECT_FALSE(found().unconfirmed);
  const Time sure = found().newest.time;
  followed().estimate.pose.translation.x() = 0.01;
  const Track& track = found(false);
  EXPECT_TRUE(track.alive);
  EXPECT_FALSE(track.measured_now);
  EXPECT_EQ(track.reason, Reason::imprecise);
  EXPECT_EQ(track.newest.time, sure);
  EXPECT_EQ(track.motion.pose.translation.x(), 0.01);
}

TEST_F(TrackToolsInTime, LosesAToolThatIsExchangedOrTakenAway) {
  ASSERT_TRUE(found().alive);
  set_->items[0].identity = 6;
  refused_ = true;
  const Track* track = &frame();
  EXPECT_FALSE(track->alive);
  EXPECT_EQ(track->reason, Reason::tool_changed);
  refused_ = false;
  ASSERT_TRUE(found().alive);
  set_->items[0] = Tool{};
  track = &frame();
  EXPECT_FALSE(track->alive);
  EXPECT_EQ(track->reason, Reason::tool_changed);
  EXPECT_EQ(found().reason, Reason::tool_changed) << "an empty slot finds nothing";
}

TEST_F(TrackToolsInTime, LosesEveryToolWhereTheClockRestarts) {
  for (int i = 0; i < 9; ++i) (void)found();
  ASSERT_TRUE(out_->tracks[0].has_previous);
  number_ = 0;
  restarted_ = true;
  EXPECT_FALSE(found().has_previous) << "the one before has another clock's time";
  number_ = 0;
  followed().reason = Reason::no_labeling;
  const Track& track = frame();
  EXPECT_FALSE(track.alive);
  EXPECT_EQ(track.identity, 5U);
}

TEST_F(TrackToolsInTime, SaysOfASlotThatWasNeverFilledThatThereWasNoFrameYet) {
  refused_ = true;
  EXPECT_EQ(frame().reason, Reason::no_frame_yet);
}

TEST(TrackTools, GivesWhatTheHeadsetItselfIsOffByBesideTheMotionsCovariance) {
  ToolSet set;
  set.count = 1;
  set.items[0].marker_count = 3;
  graph::Latest<ToolSet> tools;
  tools.set(set, 1, 0);
  const auto fitted = std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
  const auto followed = std::make_unique<graph::Parts<FollowedTools, k_tool_partitions>>();
  (*followed)[0].items[0].reason = Reason::none;
  (*followed)[0].items[0].is_publishable = true;
  (*followed)[0].items[0].correlated_covariance(2, 2) = 7e-6;
  (*followed)[0].items[0].estimate.pose.translation = {1, 0, 0};
  (*fitted)[0].tools[0].systematic.calibration.diagonal() << 1e-6, 4e-6, 9e-6, 1e-10, 2e-10, 3e-10;
  Anchor anchor;
  anchor.now.head.valid = true;
  anchor.now.head.T_world_camera.rotation = Quaternion(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  anchor.now.shared.diagonal() << Vector3::Constant(1e-6), Vector3::Constant(4e-6);
  const auto last = std::make_unique<Estimates>(), out = std::make_unique<Estimates>();
  glint::TrackTools node;
  node({}, anchor, tools, *fitted, *followed, graph::Previous<Estimates>(*last), *out);
  EXPECT_NEAR(out->tracks[0].head_covariance(1, 1), 5e-6, 1e-12);
  EXPECT_EQ(out->tracks[0].correlated_covariance(2, 2), 7e-6);
  EXPECT_NEAR(out->tracks[0].calibration_covariance(0, 0), 4e-6, 1e-15) << "turned into the world";
  EXPECT_NEAR(out->tracks[0].calibration_covariance(1, 1), 1e-6, 1e-15);
  EXPECT_NEAR(out->tracks[0].calibration_covariance(3, 3), 2e-10, 1e-18);
  anchor.now.head.valid = false;
  node({}, anchor, tools, *fitted, *followed, graph::Previous<Estimates>(*last), *out);
  EXPECT_TRUE(out->tracks[0].head_covariance.isZero()) << "in the camera's frame it is none";
  EXPECT_NEAR(out->tracks[0].calibration_covariance(0, 0), 1e-6, 1e-15);
}

}  // namespace
}  // namespace glint

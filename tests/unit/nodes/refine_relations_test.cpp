// Metamorphic tests of RefinePose: two fits of the same tool, with a marker removed or never seen,
// with other noise, with an alternative labeling, with a prediction.
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "tests/unit/nodes/refine_pose_scene.hpp"

namespace glint {
namespace {

using test::k_place;
using test::Random;
using test::set_prediction;

class RefineRelations : public test::RefinePoseTest {
 protected:
  // A different noise for each marker.
  void vary_noise() {
    for (int i = 0; i < set_.items[0].marker_count; ++i) {
      Marker& marker = marker_of(0, i);
      marker.range_sigma_m = 0.0005F * static_cast<float>(1 + i);
      marker.sigma_px = {0.02F * static_cast<float>(1 + i), 0.03F * static_cast<float>(1 + i)};
    }
  }
  void add_range_errors(const Tool& tool, double factor) {
    constexpr double k_off[] = {0.008, -0.007, 0.009, -0.008, 0.007};
    for (int i = 0; i < tool.marker_count; ++i)
      marker_of(0, i).surface_range_m += factor * k_off[i];
  }
};

// Markers after the removed one in the list keep their weight, label and share.
TEST_F(RefineRelations, AMarkerLeftOutIsAsOneThatWasNotSeen) {
  Random random(41);
  for (int bad = 0; bad < 6; ++bad) {
    start_over();
    const Tool tool = test::random_tool(random, 6);
    const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
    add_tool(0, tool, truth, 0.5, random);
    vary_noise();
    marker_of(0, bad).surface_range_m += 0.08;
    const FittedTool left_out = run_one();
    drop_marker(0, bad);
    const FittedTool unseen = run_one();
    ASSERT_EQ(left_out.reason, Reason::none) << bad;
    ASSERT_EQ(unseen.reason, Reason::none) << bad;
    EXPECT_EQ(left_out.marker_mask, unseen.marker_mask);
    EXPECT_LT((left_out.T_camera_tool.translation - unseen.T_camera_tool.translation).norm(), 1e-6);
    EXPECT_NEAR(left_out.rms_m, unseen.rms_m, 1e-6);
    EXPECT_LT((left_out.covariance - unseen.covariance).norm(), 1e-4 * unseen.covariance.norm());
    const MarkerResiduals &a = left_out.residuals, &b = unseen.residuals;
    EXPECT_NEAR(a.range.squares, b.range.squares, 1e-3 * std::abs(b.range.squares));
    EXPECT_NEAR(a.range.redundancy, b.range.redundancy, 1e-4);
    EXPECT_NEAR(a.pixel.squares, b.pixel.squares, 1e-3 * std::abs(b.pixel.squares));
    EXPECT_NEAR(a.pixel.redundancy, b.pixel.redundancy, 1e-4);
    const Matrix6& expected = unseen.systematic.calibration;
    EXPECT_LT((left_out.systematic.calibration - expected).norm(), 1e-3 * expected.norm());
    const Matrix6 correlated = unseen.systematic.correlated.sum();
    EXPECT_LT((left_out.systematic.correlated.sum() - correlated).norm(), 1e-3 * correlated.norm());
  }
}

// Chi-square grows with the square of the residuals, and the covariance with chi-square.
TEST_F(RefineRelations, ResidualsBeyondTheNoiseWidenThePoseBySquares) {
  Random random(14);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const auto variance = [&](double factor) {
    start_over();
    add_tool(0, tool, truth, 0, random);
    add_range_errors(tool, factor);
    const FittedTool& found = run_one();
    EXPECT_EQ(found.reason, Reason::none) << factor;
    return found.covariance(2, 2);
  };
  const double at_rest = variance(0), wide = variance(1);
  EXPECT_GT(wide, 4 * at_rest);
  EXPECT_NEAR(variance(0.9), 0.81 * wide, 0.03 * wide);
  EXPECT_NEAR(variance(0.7), 0.49 * wide, 0.03 * wide);
  EXPECT_NEAR(variance(0.1), at_rest, 0.03 * at_rest) << "within the noise";
  start_over();
  add_tool(0, tool, truth, 0, random);
  add_range_errors(tool, 4);
  EXPECT_EQ(run_one().reason, Reason::bad_fit) << "beyond four times the noise";
}

// The noise is larger by the factor of the covariance. A tracked motion is evidence of its own.
TEST_F(RefineRelations, ResidualsBeyondTheNoiseTakeOddsUntilAMotionIsFollowed) {
  Random random(14);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  const FittedTool exact = run_one();
  EXPECT_EQ(exact.odds, k_odds_max);
  add_range_errors(tool, 1);
  const FittedTool wide = run_one();
  EXPECT_NEAR(wide.odds, k_odds_max * exact.covariance.trace() / wide.covariance.trace(), 0.5);
  EXPECT_TRUE(wide.ambiguous());
  set_prediction(tool, truth, world_->predictions.tools[0]);
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_EQ(run_one().odds, k_odds_max);
}

// Until the noise is estimated, its variance may be ten times the declared: a tenth of the
// evidence.
TEST_F(RefineRelations, UnknownNoiseTakesOddsByTheFactorOfItsDoubt) {
  Random random(21);
  const Tool tool = test::flat_tool();
  node_.noise.range_sigma_m = 0.015;
  node_.noise.pixel_sigma_px = 0.3;
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    start_over();
    add_tool(0, tool, test::tilted_pose(tool, 0.3, k_place, random), 1, random);
    world_->predictions.noise = {};
    node_.estimate_noise = false;
    const FittedTool known = run_one();
    node_.estimate_noise = true;
    const FittedTool unknown = run_one();
    EXPECT_EQ(unknown.reason, known.reason);
    EXPECT_EQ(unknown.T_camera_tool.translation, known.T_camera_tool.translation);
    EXPECT_EQ(unknown.covariance, known.covariance);
    if (known.odds >= k_odds_max) continue;
    ++compared;
    EXPECT_NEAR(unknown.odds, known.odds / k_noise_variance_inflation, 1e-9) << trial;
  }
  EXPECT_GT(compared, 10);
}

// Two more fits; no marker of the alternative labeling is removed.
TEST_F(RefineRelations, ARivalIsFittedAndCountedBesideTheLabeling) {
  Random random(22);
  const Tool tool = test::random_tool(random, 5);
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  (void)run_one();
  const graph::LoopCounts alone = node_.counts();
  Labeling& alternative = world_->assignment.alternative[0];
  alternative = world_->assignment.labeling[0];
  std::swap(alternative.marker[0], alternative.marker[1]);
  const FittedTool& found = run_one();
  EXPECT_FALSE(found.by_alternative);
  const graph::LoopCounts both = node_.counts();
  EXPECT_EQ(both[2], alone[2] + 2);
  EXPECT_GT(both[3], alone[3]);
  EXPECT_EQ(both[4] - alone[4], 5 * (both[3] - alone[3]));
  alternative.marker.fill(-1);
  alternative.marker[0] = world_->assignment.labeling[0].marker[0];
  alternative.count = 1;
  EXPECT_EQ(run_one().reason, Reason::none) << "a rival that has no pose takes nothing away";
}

// If the alternative labeling cannot be evaluated, the labeling stands alone.
TEST_F(RefineRelations, ARivalWithAMarkerBehindTheCameraCountsForNothing) {
  Random random(23);
  const Tool tool = test::random_tool(random, 5);
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  const FittedTool alone = run_one();
  const graph::LoopCounts counts = node_.counts();
  Labeling& alternative = world_->assignment.alternative[0];
  alternative = world_->assignment.labeling[0];
  alternative.marker[0] = static_cast<std::int16_t>(world_->markers.count);
  world_->markers.items[static_cast<std::size_t>(world_->markers.count++)].surface_range_m = -1;
  const FittedTool& found = run_one();
  EXPECT_EQ(found.reason, Reason::none);
  EXPECT_EQ(found.T_camera_tool.translation, alone.T_camera_tool.translation);
  EXPECT_EQ(node_.counts(), counts);
}

// One more fit, of the visible markers, linearised at the prediction.
TEST_F(RefineRelations, AnExpectationOfFewMarkersCostsOneFitMore) {
  Random random(20);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 1, random);
  drop_marker(0, 4);
  drop_marker(0, 3);
  (void)run_one();
  const graph::LoopCounts alone = node_.counts();
  EXPECT_EQ(alone[4], 3 * alone[3]);
  set_prediction(tool, truth, world_->predictions.tools[0]);
  ASSERT_TRUE(run_one().has_relinearised);
  EXPECT_EQ(node_.counts()[2], alone[2] + 1);
  EXPECT_GT(node_.counts()[3], alone[3]);
  EXPECT_EQ(node_.counts()[4], 3 * node_.counts()[3]);
}

TEST_F(RefineRelations, FewerStepsAreTakenWhereTheyAreSet) {
  Random random(25);
  const Tool tool = test::flat_tool();  // with four markers the fit removes none
  add_tool(0, tool, test::tilted_pose(tool, 0.7, k_place, random), 1, random);
  (void)run_one();
  const std::int64_t steps = node_.counts()[3];
  node_.settings.steps_max = 1;
  (void)run_one();
  EXPECT_EQ(node_.counts()[3], 2 * 1 + 5 + 5) << "a step of each start, residuals, calibration";
  EXPECT_LT(node_.counts()[3], steps);
  node_.settings.steps_max = k_refine_steps_max + 50;
  (void)run_one();
  EXPECT_EQ(node_.counts()[3], steps) << "no more than worst() counts on";
}

// The covariance is inflated by the squared Mahalanobis distance over its expectation (6).
TEST_F(RefineRelations, ThreeMarkersGrowUnsureByTheirSurprise) {
  Random random(17);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  drop_marker(0, 4);
  drop_marker(0, 3);
  Prediction& prediction = world_->predictions.tools[0];
  set_prediction(tool, truth, prediction);
  const Matrix6 expected_here = run_one().covariance;
  int inflated_count = 0;
  for (const double sigmas : {3.2, 3.6, 4.0}) {
    set_prediction(tool, {truth.rotation, truth.translation + Vector3(sigmas * 0.003, 0, 0)},
                   prediction);
    const FittedTool& found = run_one();
    ASSERT_EQ(found.reason, Reason::none) << sigmas;
    const double inflation = found.covariance.trace() / expected_here.trace();
    const PredictedPose expected = {prediction.T_camera_tool, prediction.covariance,
                                    tool.middle_m()};
    const Matrix6 near = found.relinearised_covariance / inflation;
    const double nis =
        mahalanobis_square(expected, found.relinearised_T_camera_tool, near, tool.middle_m());
    EXPECT_NEAR(inflation, std::max(1.0, nis / 6), 0.02 * inflation) << sigmas;
    inflated_count += inflation > 1.01 ? 1 : 0;
  }
  EXPECT_GT(inflated_count, 0);
}

// The measured mean error is subtracted from the pose for the filter as well.
TEST_F(RefineRelations, AMeasuredMeanErrorIsTakenOffBothPoses) {
  Random random(20);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 1, random);
  drop_marker(0, 4);
  drop_marker(0, 3);
  set_prediction(tool, truth, world_->predictions.tools[0]);
  const FittedTool plain = run_one();
  ASSERT_TRUE(plain.has_relinearised);
  const Vector3 off(0.002, 0, 0);
  node_.correction = {CorrectionFrame::camera, off, Vector3::Zero(), {0, 2}, {-1, 1}, {-1, 1}};
  const FittedTool& found = run_one();
  EXPECT_TRUE(
      (found.T_camera_tool.translation - plain.T_camera_tool.translation).isApprox(off, 1e-9));
  EXPECT_TRUE(
      (found.relinearised_T_camera_tool.translation - plain.relinearised_T_camera_tool.translation)
          .isApprox(off, 1e-9));
}

TEST_F(RefineRelations, AToolOfMoreMarkersThanTheCellsIsFittedByThoseThatItHas) {
  Random random(26);
  const Tool tool = test::random_tool(random, 6);
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  add_tool(0, tool, truth, 0.5, random);
  node_.limits.markers_per_tool = 5;
  EXPECT_EQ(run_one().marker_mask, 0b011111);
  node_.limits.tools = 0;
  run();
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

}  // namespace
}  // namespace glint

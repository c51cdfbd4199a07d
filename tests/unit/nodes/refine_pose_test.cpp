#include <cstdio>

#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "tests/unit/nodes/refine_pose_scene.hpp"

namespace glint {
namespace {

using test::error_of;
using test::k_pixel_sigma_px;
using test::k_place;
using test::k_range_sigma_m;
using test::Random;
using test::set_prediction;

class RefinePose : public test::RefinePoseTest {};

TEST_F(RefinePose, BeatsTheRigidFitOnNoisyMarkersAndSaysHowSureItIs) {
  Random random(1);
  Tool tool = test::five_marker_pen();
  tool.tip_m = test::mean_of_markers(tool) - Vector3(0, 0, 0.15);
  constexpr int k_trials = 3000;
  int left_out = 0;
  double nees = 0, squares = 0, rigid_squares = 0;
  for (int trial = 0; trial < k_trials; ++trial) {
    start_over();
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 1), k_place, random);
    add_tool(0, tool, truth, 1, random);
    const FittedTool& found = run_one();
    ASSERT_EQ(found.reason, Reason::none);
    left_out += found.marker_mask == 31 ? 0 : 1;
    const Vector6 error = error_of(found, truth, tool.tip_m);
    nees += error.dot(pose_factor(found.covariance).value.solve(error)) / (6 * k_trials);
    squares += error.head<3>().squaredNorm();
    std::array<Vector3, 5> measured;
    for (int i = 0; i < 5; ++i) {
      const Marker& marker = marker_of(0, i);
      measured[static_cast<std::size_t>(i)] =
          marker.ray * (marker.surface_range_m + tool.centre_offset_m());
    }
    const RigidFit rigid = fit_rigid({tool.markers_m.data(), 5}, measured);
    rigid_squares += (rigid.transform * tool.tip_m - truth * tool.tip_m).squaredNorm();
  }
  const double part = std::sqrt(squares / rigid_squares);
  std::printf("  tip: %.2f mm rms, %.2f of the rigid fit's; NEES/6 %.3f\n",
              1e3 * std::sqrt(squares / k_trials), part, nees);
  EXPECT_LT(part, 0.7);
  EXPECT_LE(left_out, 3);      // 0.3 expected by the tail of chi-square
  EXPECT_NEAR(nees, 1, 0.05);  // 3,000 means of six squares: standard deviation 0.01
}

// Markers with three times the declared noise. Their residuals show it; once the noise estimate
// contains it, the covariance is consistent with the error.
TEST_F(RefinePose, WeighsMarkersByTheNoiseThatWasSeenAndStatesTheirResiduals) {
  Random random(31);
  const Tool tool = test::random_tool(random, 6);
  constexpr int k_trials = 1000;
  double nees = 0;
  MarkerResiduals sums;
  world_->predictions.noise = {{}, 3 * k_range_sigma_m, 3 * k_pixel_sigma_px, true};
  for (int trial = 0; trial < k_trials; ++trial) {
    start_over();
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 1), k_place, random);
    add_tool(0, tool, truth, 3, random);
    const FittedTool& found = run_one();
    ASSERT_EQ(found.reason, Reason::none);
    const Vector6 error = error_of(found, truth, tool.tip_m);
    nees += error.dot(pose_factor(found.covariance).value.solve(error)) / (6 * k_trials);
    sums.range.squares += found.residuals.range.squares;
    sums.range.redundancy += found.residuals.range.redundancy;
    sums.pixel.squares += found.residuals.pixel.squares;
    sums.pixel.redundancy += found.residuals.pixel.redundancy;
  }
  EXPECT_NEAR(nees, 1, 0.08);
  EXPECT_NEAR(std::sqrt(sums.range.squares / sums.range.redundancy), 3 * k_range_sigma_m,
              0.05 * 3 * k_range_sigma_m);
  EXPECT_NEAR(std::sqrt(sums.pixel.squares / sums.pixel.redundancy), 3 * k_pixel_sigma_px,
              0.05 * 3 * k_pixel_sigma_px);
  EXPECT_NEAR((sums.range.redundancy + sums.pixel.redundancy) / k_trials, 3 * 6 - 6, 0.01);
}

// Their residuals would be in metres and state nothing about pixels.
TEST_F(RefinePose, StatesNoResidualsOfPointsWithoutAnImage) {
  Random random(32);
  const Tool tool = test::random_tool(random, 6);
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  for (int i = 0; i < 6; ++i) marker_of(0, i).along_x = marker_of(0, i).along_y = Vector3::Zero();
  const FittedTool& found = run_one();
  ASSERT_EQ(found.reason, Reason::none);
  EXPECT_EQ(found.residuals.pixel.redundancy, 0);
}

TEST_F(RefinePose, LeavesOutOneBadMarkerOfFiveAndTheMaskSaysSo) {
  Random random(2);
  for (int bad = 0; bad < 6; ++bad) {
    if (bad == 1) continue;
    start_over();
    const Tool tool = test::random_tool(random, 6);
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    add_tool(0, tool, truth, 0, random);
    drop_marker(0, 1);  // so that the indices of the visible markers differ from the tool's
    marker_of(0, bad).surface_range_m += 0.05;
    const FittedTool& found = run_one();
    ASSERT_EQ(found.reason, Reason::none) << bad;
    EXPECT_EQ(found.marker_mask, 0b111101 & ~(1 << bad));
    EXPECT_LT(error_of(found, truth, tool.tip_m).norm(), 1e-5);
    EXPECT_LT(found.rms_m, 1e-6) << "the marker left out counts no more";
  }
}

TEST_F(RefinePose, StatesTheMeanDistanceThatIsLeft) {
  Random random(3);
  const Tool tool = test::five_marker_pen();
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  const FittedTool& found = run_one();
  ASSERT_EQ(found.reason, Reason::none);
  double squares = 0;
  for (int i = 0; i < 5; ++i) {
    const Marker& marker = marker_of(0, i);
    const Vector3 measured = marker.ray * (marker.surface_range_m + tool.centre_offset_m());
    squares += (found.T_camera_tool * tool.markers_m[static_cast<std::size_t>(i)] - measured)
                   .squaredNorm();
  }
  EXPECT_NEAR(found.rms_m, std::sqrt(squares / 5), 1e-12);
}

TEST_F(RefinePose, WeighsABlurredMarkerLess) {
  Random random(4);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  double off[2];
  for (const int known : {0, 1}) {
    start_over();
    add_tool(0, tool, truth, 0, random);
    marker_of(0, 2).surface_range_m += 0.004;
    if (known == 1) marker_of(0, 2).range_sigma_m = 0.02F;
    const FittedTool& found = run_one();
    ASSERT_EQ(found.reason, Reason::none);
    off[known] = error_of(found, truth, tool.tip_m).head<3>().norm();
  }
  EXPECT_LT(off[1], 0.2 * off[0]);
}

TEST_F(RefinePose, SaysWhyAToolHasNoPoseAndGivesNone) {
  Random random(5);
  const Tool flat = test::flat_tool();
  const Pose truth = test::tilted_pose(flat, 0.5, k_place, random);
  const auto reason_of = [&] {
    const FittedTool& found = run_one();
    EXPECT_EQ(found.marker_mask, 0);
    EXPECT_TRUE(found.covariance.isZero());
    EXPECT_TRUE(found.T_camera_tool.translation.isZero());
    return found.reason;
  };
  add_tool(0, flat, truth, 0, random);
  marker_of(0, 1).surface_range_m += 0.03;  // with four markers the fit cannot remove one
  EXPECT_EQ(reason_of(), Reason::bad_fit);
  marker_of(0, 1).surface_range_m = -1;
  EXPECT_EQ(reason_of(), Reason::out_of_range);
  drop_marker(0, 1);
  drop_marker(0, 2);
  EXPECT_EQ(reason_of(), Reason::too_few_markers);

  start_over();
  Tool line = flat;
  for (int i = 0; i < 4; ++i) {
    line.markers_m[static_cast<std::size_t>(i)] = Vector3(0, 0.03 * (i + 0.1 * i * i), 0);
  }
  add_tool(0, line, truth, 0, random);
  EXPECT_EQ(reason_of(), Reason::collinear);

  start_over();
  add_tool(0, flat, truth, 0, random);
  world_->assignment.reason[0] = Reason::markers_assigned_elsewhere;
  EXPECT_EQ(reason_of(), Reason::markers_assigned_elsewhere);
  verdict_.reason = Reason::frame_late;
  EXPECT_EQ(reason_of(), Reason::frame_late);
}

TEST_F(RefinePose, FitsEachToolInOneSliceAlike) {
  Random random(6);
  for (int t = 0; t < 7; ++t) {
    const Tool tool = test::random_tool(random, 4 + t % 3);
    add_tool(t, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  }
  run();
  const FittedTools whole = world_->fitted;
  graph::LoopCounts sum{};
  const graph::LoopCounts together = node_.counts();
  world_->fitted = {};
  for (int slice = 0; slice < k_tool_partitions; ++slice) {
    FittedTools before = world_->fitted;
    run({slice, k_tool_partitions});
    for (std::size_t loop = 0; loop < glint::RefinePose::k_loops.size(); ++loop)
      sum[loop] += node_.counts()[loop];
    for (int t = 0; t < 7; ++t) {
      const FittedTool& found = world_->fitted.tools[static_cast<std::size_t>(t)];
      const bool own = t % k_tool_partitions == slice;
      const FittedTool& expected = (own ? whole : before).tools[static_cast<std::size_t>(t)];
      EXPECT_EQ(found.reason, expected.reason) << t;
      EXPECT_EQ(found.rms_m, expected.rms_m) << t;
    }
  }
  for (std::size_t loop = 1; loop < glint::RefinePose::k_loops.size(); ++loop) {
    EXPECT_EQ(sum[loop], together[loop]) << glint::RefinePose::k_loops[loop];
  }
  EXPECT_EQ(together[1], 7);
  EXPECT_GE(together[2], 14);  // two initial guesses each
}

TEST_F(RefinePose, NeverRunsItsLoopsMoreOftenThanItSays) {
  Random random(7);
  node_.limits.tools = 2;
  node_.limits.markers_per_tool = 6;
  node_.settings = {100, 5, 100};
  const graph::LoopCounts worst = glint::RefinePose::worst(node_.limits, {0, 1});
  graph::LoopCounts most{};
  for (int trial = 0; trial < 300; ++trial) {
    start_over();
    for (int t = 0; t < 3; ++t) {
      const Tool tool = test::random_tool(random, 5 + random.below(3));
      const Pose pose = test::tilted_pose(tool, random.within(0, 1.5), k_place, random);
      add_tool(t, tool, pose, 1, random);
      // In every other trial few markers are isolated and the tool has a prediction.
      const bool few = trial % 2 == 1;
      Prediction& prediction = world_->predictions.tools[static_cast<std::size_t>(t)];
      prediction = {};
      if (few) set_prediction(tool, pose, prediction);
      for (int i = 3; few && i < tool.marker_count; ++i)
        marker_of(t, i).flags = k_marker_not_isolated;
      for (int bad = 0; bad < (few ? 1 : 2); ++bad)
        marker_of(t, bad).surface_range_m *= random.within(0.3, 3);
      Labeling& alternative = world_->assignment.alternative[static_cast<std::size_t>(t)];
      alternative = world_->assignment.labeling[static_cast<std::size_t>(t)];
      std::swap(alternative.marker[0], alternative.marker[1]);
    }
    run();
    EXPECT_TRUE(graph::within(node_.counts(), worst)) << trial;
    for (std::size_t i = 0; i < glint::RefinePose::k_loops.size(); ++i)
      most[i] = std::max(most[i], node_.counts()[i]);
  }
  EXPECT_EQ(most[1], 2);
  EXPECT_EQ(most[2], worst[2]);
  EXPECT_GT(most[4], worst[4] / 2);
}

// At 14 degrees from face-on, with 15 mm and 0.3 px of noise, the mirrored pose is about as likely.
TEST_F(RefinePose, IsAmbiguousWhereTheMirroredPoseIsNearlyAsLikelyUntilTheMotionDecides) {
  Random random(21);
  const Tool tool = test::flat_tool();
  node_.noise.range_sigma_m = 0.015;
  node_.noise.pixel_sigma_px = 0.3;
  int ambiguous = 0, decided = 0, apart = 0, restarted = 0;
  constexpr int k_trials = 200;
  for (int trial = 0; trial < k_trials; ++trial) {
    start_over();
    const Pose truth = test::tilted_pose(tool, 0.25, k_place, random);
    add_tool(0, tool, truth, 1, random);
    Prediction& prediction = world_->predictions.tools[0];
    prediction = {};
    ambiguous += run_one().ambiguous() ? 1 : 0;
    set_prediction(tool, truth, prediction);
    decided += run_one().ambiguous() ? 0 : 1;
    // Long tracked on the wrong branch: the prediction is the mirrored pose.
    set_prediction(tool, depth_flipped(truth, Vector3::UnitX(), test::mean_of_markers(tool)),
                   prediction);
    prediction.odds = 0;
    const FittedTool& wrong = run_one();
    apart += wrong.odds < k_odds_max ? 1 : 0;
    restarted += wrong.contradicts_track ? 1 : 0;
  }
  EXPECT_GT(ambiguous, 0.5 * k_trials);
  EXPECT_GT(decided, 0.9 * k_trials);
  EXPECT_GT(restarted, 0.5 * k_trials) << "odds of zero let the frame decide";
  EXPECT_GT(apart, 0.5 * k_trials);
}

// Three markers at 14 degrees from face-on: noise of 3 mm rejects the mirrored pose, 9 mm does not.
TEST_F(RefinePose, IsAmbiguousUntilTheNoiseIsKnown) {
  Random random(24);
  const Tool tool = test::flat_tool();
  node_.noise.range_sigma_m = 0.003;
  int at_first = 0, later = 0;
  constexpr int k_trials = 100;
  for (int trial = 0; trial < k_trials; ++trial) {
    start_over();
    add_tool(0, tool, test::tilted_pose(tool, 0.25, k_place, random), 1, random);
    drop_marker(0, 3);
    later += run_one().ambiguous() ? 1 : 0;
    node_.estimate_noise = true;
    at_first += run_one().ambiguous() ? 1 : 0;
    node_.estimate_noise = false;
  }
  EXPECT_LT(later, 0.15 * k_trials);
  EXPECT_GT(at_first, 0.4 * k_trials);
}

// All four markers are isolated, but the standard deviation of their most likely pose is below that
// of their ranges.
TEST_F(RefinePose, StatesOfAFlatToolFaceOnWhatItsRangesShow) {
  Random random(23);
  const Tool tool = test::flat_tool();
  node_.noise.range_sigma_m = 0.005;
  const Pose truth = test::tilted_pose(tool, 0.1, k_place, random);
  add_tool(0, tool, truth, 1, random);
  const double turn_alone =
      refine_pose(test::weighted_view(tool, truth, {0.01, 0, 0.01, 2.5e-5}, 1, random), tool.tip_m)
          .covariance.bottomRightCorner<3, 3>()
          .trace();
  const FittedTool first = run_one();
  EXPECT_FALSE(first.has_relinearised) << "nothing is expected";
  const double turn = first.covariance.bottomRightCorner<3, 3>().trace();
  EXPECT_GT(turn, 1.2 * turn_alone);
  set_prediction(tool, truth, world_->predictions.tools[0]);
  EXPECT_TRUE(run_one().has_relinearised);
}

TEST_F(RefinePose, TakesTheRivalLabelingWhereTheNoiseExplainsItBetter) {
  Random random(22);
  const Tool tool = test::random_tool(random, 5);
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  Labeling& labeling = world_->assignment.labeling[0];
  Labeling& alternative = world_->assignment.alternative[0];
  alternative = labeling;
  std::swap(labeling.marker[0], labeling.marker[1]);
  const FittedTool& found = run_one();
  EXPECT_EQ(found.reason, Reason::none);
  EXPECT_TRUE(found.by_alternative);
  EXPECT_EQ(&labeling_of(world_->assignment, found, 0), &alternative);
}

TEST_F(RefinePose, CountsTheMarkersOfItsFitsAndTheirSteps) {
  Random random(8);
  const Tool tool = test::flat_tool();
  add_tool(0, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  run();
  EXPECT_EQ(node_.counts()[0], 1);
  EXPECT_EQ(node_.counts()[1], 1);
  EXPECT_EQ(node_.counts()[2], 2);
  EXPECT_GE(node_.counts()[3], 4);
  EXPECT_EQ(node_.counts()[4], 4 * node_.counts()[3]);
}

TEST_F(RefinePose, LeavesOneOfFourOutOnlyWhereAllLieWhereTheyWerePredicted) {
  Random random(13);
  Tool tool = test::five_marker_pen();
  tool.marker_count = 4;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  marker_of(0, 2).surface_range_m += 0.03;
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
  world_->assignment.labeling[0].log_prior_ratio_m2 = 1e-5;
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_EQ(run_one().marker_mask, 0b1011);
  EXPECT_LT(error_of(run_one(), truth, tool.tip_m).head<3>().norm(), 0.0005);
}

TEST_F(RefinePose, IsLessSureOfMarkersThatAreOffByMoreThanTheirNoise) {
  Random random(14);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  const Matrix6 tight_covariance = run_one().covariance;
  const double off[] = {0.008, -0.007, 0.009, -0.008, 0.007};  // about five sigmas each
  for (int i = 0; i < tool.marker_count; ++i) marker_of(0, i).surface_range_m += off[i];
  const FittedTool& found = run_one();
  ASSERT_EQ(found.reason, Reason::none);
  EXPECT_EQ(found.marker_mask, 31);
  EXPECT_GT(found.covariance(2, 2), 4 * tight_covariance(2, 2));
  const Vector6 error = error_of(found, truth, tool.tip_m);
  EXPECT_LT(error.dot(pose_factor(found.covariance).value.solve(error)), 20);
}

}  // namespace
}  // namespace glint

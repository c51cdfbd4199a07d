#include "nodes/refine_pose.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <numbers>

#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint {
namespace {

using test::Random;

const Vector3 k_place(0.08, -0.05, 0.5);
constexpr double k_pixel_sigma_px = 0.1, k_range_sigma_m = 0.0015;

class RefinePose : public testing::Test {
 protected:
  RefinePose() {
    node_.noise = {k_range_sigma_m, k_pixel_sigma_px, 253};
    world_->assignment.reason.fill(Reason::too_few_markers);
  }

  // Tool number t, its markers seen in the reverse of their order, with noise of `share` sigmas.
  void add_tool(int t, const Tool& tool, const Pose& truth, double share, Random& random) {
    const auto at = static_cast<std::size_t>(t);
    set_.count = std::max(set_.count, t + 1);
    set_.items[at] = tool;
    world_->assignment.reason[at] = Reason::none;
    Labeling& labeling = world_->assignment.labeling[at];
    labeling = {};
    labeling.marker.fill(-1);
    labeling.count = tool.marker_count;
    const CameraModel camera = test::pinhole();
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
  void forget(int t, int i) {
    Labeling& labeling = world_->assignment.labeling[static_cast<std::size_t>(t)];
    labeling.marker[static_cast<std::size_t>(i)] = -1;
    --labeling.count;
  }
  void start_over() { world_->markers.count = set_.count = 0; }
  const FittedTools& run(graph::Slice slice = {0, 1}) {
    tools_.set(set_, 1, 0);
    node_(verdict_, world_->markers, tools_, world_->predictions, world_->assignment, slice,
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

Vector6 error_of(const FittedTool& found, const Pose& truth, const Vector3& tip) {
  Vector6 error;
  error << found.T_camera_tool * tip - truth * tip,
      rotation_vector(found.T_camera_tool.rotation * truth.rotation.conjugate());
  return error;
}

// Foretold to 3 mm and 2 degrees at the middle of the markers.
void foretell(const Tool& tool, const Pose& T_camera_tool, Prediction& prediction) {
  prediction.follows_motion = true;
  prediction.T_camera_tool = T_camera_tool;
  prediction.covariance.diagonal() << Vector3::Constant(9e-6), Vector3::Constant(1.2e-3);
  ASSERT_GT(tool.marker_count, 0);
}

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
  EXPECT_LE(left_out, 3);      // 0.3 by chi-square's tail
  EXPECT_NEAR(nees, 1, 0.05);  // 3,000 means of six squares: 0.01, 1 sigma
}

TEST_F(RefinePose, LeavesOutOneBadMarkerOfFiveAndTheMaskSaysSo) {
  Random random(2);
  for (int bad = 0; bad < 6; ++bad) {
    if (bad == 1) continue;
    start_over();
    const Tool tool = test::random_tool(random, 6);
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    add_tool(0, tool, truth, 0, random);
    forget(0, 1);  // so that the seen markers' numbers are not the tool's
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
  marker_of(0, 1).surface_range_m += 0.03;  // of four none can be left out
  EXPECT_EQ(reason_of(), Reason::bad_fit);
  marker_of(0, 1).surface_range_m = -1;
  EXPECT_EQ(reason_of(), Reason::out_of_range);
  forget(0, 1);
  forget(0, 2);
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
  world_->assignment.reason[0] = Reason::taken_by_other;
  EXPECT_EQ(reason_of(), Reason::taken_by_other);
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
  for (int slice = 0; slice < k_tool_slices; ++slice) {
    FittedTools before = world_->fitted;
    run({slice, k_tool_slices});
    for (std::size_t loop = 0; loop < glint::RefinePose::k_loops.size(); ++loop)
      sum[loop] += node_.counts()[loop];
    for (int t = 0; t < 7; ++t) {
      const FittedTool& found = world_->fitted.tools[static_cast<std::size_t>(t)];
      const bool own = t % k_tool_slices == slice;
      const FittedTool& expected = (own ? whole : before).tools[static_cast<std::size_t>(t)];
      EXPECT_EQ(found.reason, expected.reason) << t;
      EXPECT_EQ(found.rms_m, expected.rms_m) << t;
    }
  }
  for (std::size_t loop = 1; loop < glint::RefinePose::k_loops.size(); ++loop) {
    EXPECT_EQ(sum[loop], together[loop]) << glint::RefinePose::k_loops[loop];
  }
  EXPECT_EQ(together[1], 7);
  EXPECT_GE(together[2], 14);  // two starts each
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
      // Of every other one few are whole, and where they are is expected.
      const bool few = trial % 2 == 1;
      Prediction& prediction = world_->predictions.tools[static_cast<std::size_t>(t)];
      prediction = {};
      if (few) foretell(tool, pose, prediction);
      for (int i = 3; few && i < tool.marker_count; ++i) marker_of(t, i).flags = k_marker_uneven;
      for (int bad = 0; bad < (few ? 1 : 2); ++bad)
        marker_of(t, bad).surface_range_m *= random.within(0.3, 3);
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
  world_->assignment.labeling[0].predicted_worth_m2 = 1e-5;
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_EQ(run_one().marker_mask, 0b1011);
  EXPECT_LT(error_of(run_one(), truth, tool.tip_m).head<3>().norm(), 0.0005);
}

TEST_F(RefinePose, IsLessSureOfMarkersThatAreOffByMoreThanTheirNoise) {
  Random random(14);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  const Matrix6 sure = run_one().covariance;
  const double off[] = {0.008, -0.007, 0.009, -0.008, 0.007};  // some five sigmas, all of them
  for (int i = 0; i < tool.marker_count; ++i) marker_of(0, i).surface_range_m += off[i];
  const FittedTool& found = run_one();
  ASSERT_EQ(found.reason, Reason::none);
  EXPECT_EQ(found.marker_mask, 31);
  EXPECT_GT(found.covariance(2, 2), 4 * sure(2, 2));
  const Vector6 error = error_of(found, truth, tool.tip_m);
  EXPECT_LT(error.dot(pose_factor(found.covariance).value.solve(error)), 20);
}

TEST_F(RefinePose, BelievesThreeMarkersOnlyWhereTheMotionCanHaveBroughtTheTool) {
  Random random(15);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 1, random);
  Prediction& prediction = world_->predictions.tools[0];
  foretell(tool, aside, prediction);
  EXPECT_EQ(run_one().reason, Reason::none) << "five that agree are no chance";
  forget(0, 4);
  forget(0, 3);
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
  EXPECT_TRUE(run_one().covariance.isZero());
  foretell(tool, truth, prediction);
  EXPECT_EQ(run_one().reason, Reason::none);
  foretell(tool, aside, prediction);
  prediction.covariance *= 100;  // long hidden
  EXPECT_EQ(run_one().reason, Reason::none);
  prediction = {};  // it is not known how it moved
  EXPECT_EQ(run_one().reason, Reason::none);
}

// What a marker's blob covers when it is `part` of its disc, in the pinhole's pixels.
std::uint32_t area_of(const Tool& tool, const Pose& truth, int i, double part) {
  const Vector3 point = truth * tool.markers_m[static_cast<std::size_t>(i)];
  const double radius_px = 253 * tool.marker_radius_m / point.norm() + k_rim_px;
  return static_cast<std::uint32_t>(part * std::numbers::pi * radius_px * radius_px);
}

TEST_F(RefinePose, IsLessSureOfAMarkerWhoseBlobIsLargerThanTheOthers) {
  Random random(18);
  Tool tool = test::five_marker_pen();
  tool.marker_radius_m = 0.0055;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  forget(0, 4);  // of five the bad one would be left out
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

TEST_F(RefinePose, BelievesFewWholeMarkersOnlyWhereTheMotionCanHaveBroughtTheTool) {
  Random random(19);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 1, random);
  foretell(tool, aside, world_->predictions.tools[0]);
  EXPECT_EQ(run_one().reason, Reason::none);
  for (int i = 0; i < 2; ++i) marker_of(0, i).flags = k_marker_uneven;
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
  foretell(tool, truth, world_->predictions.tools[0]);
  EXPECT_EQ(run_one().reason, Reason::none);
}

TEST_F(RefinePose, TellsAFilterWhatFewMarkersSayNearWhereItExpectsTheTool) {
  Random random(20);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 1, random);
  Prediction& prediction = world_->predictions.tools[0];
  foretell(tool, truth, prediction);
  EXPECT_FALSE(run_one().tells_near) << "five that agree need no help";
  forget(0, 4);
  forget(0, 3);
  ASSERT_TRUE(run_one().tells_near);
  const UncertainPose told = told_middle_of(run_one(), tool, Time{});
  EXPECT_EQ(told.pose.translation, Vector3(run_one().near_T_camera_tool * tool.middle_m()));
  EXPECT_EQ(told.covariance, run_one().near_covariance);
  EXPECT_LT((told.pose.translation - truth * tool.middle_m()).norm(), 0.01);
  prediction = {};
  EXPECT_FALSE(run_one().tells_near) << "nothing is expected";
  const UncertainPose alone = told_middle_of(run_one(), tool, Time{});
  EXPECT_EQ(alone.pose.translation, Vector3(run_one().T_camera_tool * tool.middle_m()));
}

TEST_F(RefinePose, IsTheLessSureOfThreeMarkersTheLessTheyWereExpected) {
  Random random(17);
  Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  add_tool(0, tool, truth, 0, random);
  Prediction& prediction = world_->predictions.tools[0];
  const auto sigma_aside = [&](double sigmas) {
    foretell(tool, truth, prediction);
    const double sigma_m = std::sqrt(prediction.covariance(0, 0));
    foretell(tool, {truth.rotation, truth.translation + Vector3(sigmas * sigma_m, 0, 0)},
             prediction);
    return std::sqrt(run_one().covariance(0, 0));
  };
  const double all = sigma_aside(0);
  EXPECT_EQ(sigma_aside(4), all) << "five that agree are no chance";
  forget(0, 4);
  forget(0, 3);
  const double expected = sigma_aside(0);
  EXPECT_EQ(sigma_aside(1), expected) << "no more than noise";
  const double unexpected = sigma_aside(4);
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_GT(unexpected, 1.3 * expected);
  EXPECT_LE(unexpected, std::sqrt(16.0 / 6) * (1 + 1e-9) * expected);
}

TEST_F(RefinePose, ForgivesOnlyWhatTheMotionExplains) {
  Random random(16);
  Tool tool = test::five_marker_pen();
  tool.marker_count = 4;
  const Pose truth = test::tilted_pose(tool, 0.7, k_place, random);
  const Pose aside{truth.rotation, truth.translation + Vector3(0.03, 0, 0)};
  add_tool(0, tool, truth, 0, random);
  world_->assignment.labeling[0].predicted_worth_m2 = 1e-5;
  marker_of(0, 2).surface_range_m += 0.03;
  Prediction& prediction = world_->predictions.tools[0];
  foretell(tool, truth, prediction);
  EXPECT_EQ(run_one().reason, Reason::none);
  EXPECT_EQ(run_one().marker_mask, 0b1011);
  foretell(tool, aside, prediction);
  EXPECT_EQ(run_one().reason, Reason::bad_fit);
}

TEST_F(RefinePose, TakesAMeasuredMeanErrorOffWhereItHolds) {
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

}  // namespace
}  // namespace glint

// Work counts and output fields of refine_pose and of the labeling decision, against single fits.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "kernels/pose/decide_labeling.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::refine_work_test {
namespace {

using test::Random;

const Vector3 k_place(0.08, -0.05, 0.5);
const MarkerVariance k_usual{0.01, 0, 0.01, 0.002 * 0.002};
const MarkerVariance k_noisy{0.01, 0, 0.01, 0.005 * 0.005};

void expect_work(const RefineWork& work, int fits, int steps, int marker_steps) {
  EXPECT_EQ(work.fits, fits);
  EXPECT_EQ(work.steps, steps);
  EXPECT_EQ(work.marker_steps, marker_steps);
}

TEST(RefineWork, MaximumIsTwoFitsOfAllAndOfAllButEach) {
  // steps_max, rejected_max, rejection_steps_max, markers_kept_min
  expect_work(refine_work_max(8, {3, 1, 2, 4}), 2 * 9, 2 * 3 + 8 * 2 * 2,
              2 * 3 * 8 + 8 * 2 * 2 * 7);
  expect_work(refine_work_max(5, {7, 1, 3, 4}), 2 * 6, 2 * 7 + 5 * 2 * 3,
              2 * 7 * 5 + 5 * 2 * 3 * 4);
  expect_work(refine_work_max(4, {7, 1, 3, 4}), 2, 14, 56);
  expect_work(refine_work_max(4, {7, 1, 3, 3}), 2 * 5, 14 + 4 * 6, 56 + 4 * 6 * 3);
  expect_work(refine_work_max(8, {7, 0, 3, 4}), 2, 14, 14 * 8);
  const RefineSettings both{3, 1, 2, 4}, none{3, 0, 2, 4};
  expect_work(decide_work_max(8, both), 8 * (2 + 18), 8 * (6 + 38), 8 * (48 + 48 + 224));
  expect_work(decide_work_max(8, none), 8 * 2, 8 * 6, 8 * 48);
  RefineWork sum{1, 20, 300};
  sum += RefineWork{4, 50, 600};
  expect_work(sum, 5, 70, 900);
}

TEST(RefineWork, IsAStepForEachMarkerOfAllAndOneFewerOfThoseLeftOut) {
  Random random(1);
  const Tool tool = test::five_marker_pen();
  for (int trial = 0; trial < 20; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
    markers[static_cast<std::size_t>(trial % 5)].range_m += 0.05;
    RefineSettings all_stay;
    all_stay.rejected_max = 0;
    const RefineWork all = refine_pose(markers, tool.tip_m, nullptr, all_stay).work;
    EXPECT_EQ(all.fits, 2);
    EXPECT_EQ(all.marker_steps, 5 * all.steps);
    const RefinedPose pose = refine_pose(markers, tool.tip_m);
    ASSERT_EQ(pose.rejected, trial % 5);
    EXPECT_EQ(pose.work.fits, 2 * 6);
    EXPECT_GE(pose.work.steps, all.steps + 5 * 2 * 1);
    EXPECT_EQ(pose.work.marker_steps, all.marker_steps + 4 * (pose.work.steps - all.steps));
  }
}

// Without a rigid fit from the markers, a single fit starts from the prior.
TEST(RefineWork, OfOneOrTwoMarkersIsOneFit) {
  Random random(2);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
  const PosePrior prior{truth, 1e6 * Matrix6::Identity(), tool.tip_m};
  for (const std::size_t seen : {1U, 2U, 3U}) {
    const RefinedPose pose = refine_pose({markers.data(), seen}, tool.tip_m, &prior);
    ASSERT_EQ(pose.reason, Reason::none);
    EXPECT_EQ(pose.work.fits, seen < 3 ? 1 : 2);
    EXPECT_EQ(pose.degrees_of_freedom, 3 * static_cast<int>(seen));
    if (seen < 3) {
      EXPECT_FALSE(pose.other.exists);
    }
  }
}

// The pose and the second minimum each equal a fit that starts near it.
TEST(RefinePoseFields, AreThoseOfAFitThatBeginsAtEachMinimum) {
  Random random(3);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool), tip = mean + Vector3(0.01, 0.02, 0.15);
  int others = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 0.8), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_noisy, 1, random);
    PredictedPose expected{truth, Matrix6::Identity() * 1e-4, mean};
    expected.T_camera_tool.translation += Vector3(0.003, -0.002, 0.004);
    const RefinedPose pose = refine_pose(markers, tip, nullptr, {}, &expected);
    ASSERT_EQ(pose.reason, Reason::none);
    const auto expect_fit = [&](const Pose& at, const Matrix6& covariance, double chi_square) {
      const WeightedFit fit = fit_weighted(markers, mean, at, nullptr, k_refine_steps_max);
      EXPECT_NEAR(fit.chi_square, chi_square, 2e-3);
      const Matrix6 own = moved_covariance(pose_factor(fit.information).value.inverse(),
                                           fit.T_camera_tool.rotation * (tip - mean));
      EXPECT_LT((own - covariance).norm(), 2e-2 * own.norm());
    };
    expect_fit(pose.T_camera_tool, pose.covariance, pose.chi_square);
    EXPECT_DOUBLE_EQ(pose.mahalanobis_square,
                     mahalanobis_square(expected, pose.T_camera_tool, pose.covariance, tip));
    if (!pose.other.exists) continue;
    ++others;
    expect_fit(pose.other.T_camera_tool, pose.other.covariance,
               pose.chi_square + pose.other.delta_chi_square);
    EXPECT_DOUBLE_EQ(
        pose.other.mahalanobis_square,
        mahalanobis_square(expected, pose.other.T_camera_tool, pose.other.covariance, tip));
    EXPECT_LE(pose.chi_square + pose.mahalanobis_square,
              pose.chi_square + pose.other.delta_chi_square + pose.other.mahalanobis_square)
        << "the sum decides";
  }
  EXPECT_GT(others, 40);
}

// Tilted by less than 29 degrees, and the flip nearly as likely.
TEST(RefinePoseFields, AreShallowBelowATiltWhereTheFlipIsNearlyAsLikely) {
  Random random(4);
  const Tool tool = test::flat_tool();
  const auto is_shallow = [&](double degrees, const MarkerVariance& variance) {
    const Pose truth = test::tilted_pose(tool, degrees * 0.017453292519943, {0, 0, 0.5}, random);
    const auto markers = test::weighted_view(tool, truth, variance, 0, random);
    return refine_pose(markers, tool.tip_m).shallow;
  };
  const MarkerVariance imprecise{0.25, 0, 0.25, 0.03 * 0.03};
  EXPECT_TRUE(is_shallow(5, imprecise));
  EXPECT_TRUE(is_shallow(28, imprecise));
  EXPECT_FALSE(is_shallow(30, imprecise)) << "tilted";
  EXPECT_FALSE(is_shallow(28, {1e-4, 0, 1e-4, 1e-8})) << "the flip does not fit";
}

struct View {
  Markers markers;
  MarkerObservations sights;
  Labelings labelings;
};

// The tool's markers and `copies` correct labelings.
void fill(View& view, const Tool& tool, const Pose& pose, int copies, Random& random) {
  const CameraModel camera = test::pinhole();
  view.markers.count = 0;
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 centre = pose * tool.markers_m[static_cast<std::size_t>(i)];
    const Vector2 pixel = project(camera, centre).value + 0.1 * random.vector(1).head<2>();
    int lens_steps = 0;
    const LocalRays rays = local_rays(camera, pixel, k_ray_steps_max, lens_steps).value;
    const auto at = static_cast<std::size_t>(view.markers.count++);
    view.markers.items[at] = Marker{};
    view.markers.items[at].ray = rays.ray;
    view.markers.items[at].surface_range_m =
        centre.norm() + 0.002 * random.normal() - tool.centre_offset_m();
    view.sights[at] = {rays, k_usual};
  }
  view.labelings = {};
  view.labelings.count = copies;
  for (Labeling& labeling : view.labelings.items) {
    labeling.marker.fill(-1);
    labeling.count = tool.marker_count;
    for (int i = 0; i < tool.marker_count; ++i)
      labeling.marker[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(i);
  }
}

DecidedLabeling decide(const View& view, const Tool& tool, const RefineSettings& settings = {}) {
  return decide_labeling(view.markers, view.sights, tool, view.labelings, nullptr, settings);
}

TEST(DecideWork, IsTheSumOfTheFitsOfEachLabelingThatIsLookedAt) {
  Random random(5);
  const Tool tool = test::five_marker_pen();
  auto view = std::make_unique<View>();
  fill(*view, tool, test::tilted_pose(tool, 0.5, k_place, random), 1, random);
  const RefineWork one = decide(*view, tool).work;
  EXPECT_EQ(one.fits, 2);
  for (const int copies : {2, 5, k_labelings_max}) {
    view->labelings.count = copies;
    const RefineWork work = decide(*view, tool).work;
    expect_work(work, copies * one.fits, copies * one.steps, copies * one.marker_steps);
  }
  view->labelings.count = k_labelings_max + 3;
  EXPECT_EQ(decide(*view, tool).work.fits, 2 * k_labelings_max) << "no more than are kept";
  view->labelings.count = -1;
  EXPECT_EQ(decide(*view, tool).work.fits, 0);
  EXPECT_EQ(decide(*view, tool).reason, Reason::no_labeling);
  // After a labeling that passes the test, labelings of fewer markers are not fitted.
  view->labelings.count = 3;
  view->labelings.items[1].marker[4] = -1;
  view->labelings.items[1].count = 4;
  EXPECT_EQ(decide(*view, tool).work.fits, 2);
}

// Each has one bad marker. The first labeling that passes without one marker is chosen; the others
// are not fitted again.
TEST(DecideWork, EndsWithTheFirstThatIsExplainedWithoutOneMarker) {
  Random random(6);
  const Tool tool = test::five_marker_pen();
  auto view = std::make_unique<View>();
  fill(*view, tool, test::tilted_pose(tool, 0.5, k_place, random), 3, random);
  view->markers.items[3].surface_range_m += 0.05;
  const DecidedLabeling decided = decide(*view, tool);
  EXPECT_EQ(decided.chosen, 0);
  EXPECT_EQ(decided.reason, Reason::none);
  EXPECT_EQ(decided.pose.rejected, 3);
  EXPECT_EQ(decided.work.fits, 3 * 2 + 2 * 6);
  EXPECT_GT(decided.delta_chi_square, 1e8);
  RefineSettings all_stay;
  all_stay.rejected_max = 0;
  const DecidedLabeling none = decide(*view, tool, all_stay);
  EXPECT_EQ(none.chosen, -1);
  EXPECT_EQ(none.reason, Reason::bad_fit);
  EXPECT_EQ(none.work.fits, 3 * 2) << "no second pass";
}

// Least chi-square among the labelings with the most markers, and the excess of the next one.
TEST(DecideLabelingFields, AreTheLeastChiSquareAndTheNextOnesDistance) {
  Random random(7);
  const Tool square = test::tool_of<4>({{0, 0, 0}, {0, 60, 0}, {0, 60, 60}, {0, 0, 60}});
  auto view = std::make_unique<View>();
  int reordered = 0;
  for (int trial = 0; trial < 30; ++trial) {
    fill(*view, square, test::tilted_pose(square, 0.5, k_place, random), 4, random);
    for (std::int16_t turn = 0; turn < 4; ++turn)
      for (std::int16_t i = 0; i < 4; ++i)
        view->labelings.items[std::size_t(turn)].marker[std::size_t(i)] =
            static_cast<std::int16_t>((i + turn) % 4);
    std::vector<double> chi_squares;
    const Labelings all = view->labelings;
    view->labelings.count = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      view->labelings.items[0] = all.items[k];
      const DecidedLabeling alone = decide(*view, square);
      chi_squares.push_back(alone.chosen == 0 ? alone.pose.chi_square : 1e9);
    }
    view->labelings = all;
    const DecidedLabeling decided = decide(*view, square);
    ASSERT_GE(decided.chosen, 0);
    std::vector<double> sorted = chi_squares;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_DOUBLE_EQ(decided.pose.chi_square, sorted[0]);
    EXPECT_EQ(chi_squares[static_cast<std::size_t>(decided.chosen)], sorted[0]);
    if (sorted[1] < 1e8) {
      EXPECT_NEAR(decided.delta_chi_square, sorted[1] - sorted[0], 1e-9);
    }
    reordered += decided.chosen > 0 ? 1 : 0;
  }
  EXPECT_GT(reordered, 5);
}

}  // namespace
}  // namespace glint::refine_work_test

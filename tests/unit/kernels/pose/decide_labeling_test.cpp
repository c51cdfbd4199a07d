#include "kernels/pose/decide_labeling.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::decide_labeling_test {
namespace {

using test::Random;

struct View {
  Markers markers;
  MarkerObservations sights;
  Labelings labelings;
};

const MarkerVariance k_noisy{0.01, 0, 0.01, 0.003 * 0.003};
const Vector3 k_place(0.05, -0.04, 0.5);

void add(View& view, const Tool& tool, const Vector3& centre, Random& random) {
  const CameraModel camera = test::pinhole();
  const double right = random.normal(), down = random.normal();
  const Vector2 pixel = project(camera, centre).value + 0.1 * Vector2(right, down);
  int lens_steps = 0;
  const LocalRays rays = local_rays(camera, pixel, k_ray_steps_max, lens_steps).value;
  const auto at = static_cast<std::size_t>(view.markers.count++);
  view.markers.items[at].ray = rays.ray;
  view.markers.items[at].surface_range_m =
      centre.norm() + 0.003 * random.normal() - tool.centre_offset_m();
  view.sights[at] = {rays, k_noisy};
}

// Fills the view with all the tool's markers in order, and the correct labeling.
void fill(View& view, const Tool& tool, const Pose& pose, Random& random) {
  view.markers.count = 0;
  for (int i = 0; i < tool.marker_count; ++i)
    add(view, tool, pose * tool.markers_m[static_cast<std::size_t>(i)], random);
  view.labelings = {};
  view.labelings.count = 1;
  Labeling& labeling = view.labelings.items[0];
  labeling.marker.fill(-1);
  labeling.count = tool.marker_count;
  for (int i = 0; i < tool.marker_count; ++i)
    labeling.marker[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(i);
}

void add_swapped(View& view, int a, int b) {
  Labeling swapped = view.labelings.items[0];
  std::swap(swapped.marker[static_cast<std::size_t>(a)],
            swapped.marker[static_cast<std::size_t>(b)]);
  view.labelings.items[static_cast<std::size_t>(view.labelings.count++)] = swapped;
}

TEST(DecideLabeling, TakesTheOneThatTheNoiseExplainsWhereverItStands) {
  Random random(1);
  const Tool tool = test::flat_tool();
  auto view = std::make_unique<View>();
  for (int trial = 0; trial < 50; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    fill(*view, tool, truth, random);
    add_swapped(*view, 0, 2);
    add_swapped(*view, 1, 3);
    std::swap(view->labelings.items[0], view->labelings.items[2]);
    const DecidedLabeling decided =
        decide_labeling(view->markers, view->sights, tool, view->labelings, nullptr, {});
    ASSERT_EQ(decided.reason, Reason::none);
    EXPECT_EQ(decided.chosen, 2);
    EXPECT_LT((decided.pose.T_camera_tool * tool.markers_m[0] - truth * tool.markers_m[0]).norm(),
              0.02);
  }
}

// Search and decision together, in views where the least rms alone is often wrong.
TEST(DecideLabeling, NamesMarkersThatTheLeastUnweightedResidualMixesUp) {
  Random random(2);
  const Tool tool = test::flat_tool();
  auto view = std::make_unique<View>();
  auto scratch = std::make_unique<CorrespondScratch>();
  CorrespondSettings settings;
  settings.focal_px = 253;
  settings.range_sigma_m = 0.003;
  settings.max_rms_m = 0.009;
  settings.gate_sigmas = 8;
  int wrong_by_rms = 0, wrong = 0, none = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    fill(*view, tool, test::tilted_pose(tool, random.within(0, 0.8), k_place, random), random);
    const Labeling truth = view->labelings.items[0];
    propose_labelings(view->markers, tool, settings, nullptr, *scratch, view->labelings);
    const DecidedLabeling decided =
        decide_labeling(view->markers, view->sights, tool, view->labelings, nullptr, {});
    none += decided.chosen < 0 ? 1 : 0;
    wrong_by_rms += view->labelings.items[0].marker == truth.marker ? 0 : 1;
    if (decided.chosen < 0) continue;
    const Labeling& named = view->labelings.items[static_cast<std::size_t>(decided.chosen)];
    wrong += named.marker == truth.marker ? 0 : 1;
  }
  std::printf("  of 2000 the least rms is wrong in %d, chi-square in %d, none explained in %d\n",
              wrong_by_rms, wrong, none);
  EXPECT_GT(wrong_by_rms, 5);  // otherwise the test has no effect
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(none, 3);
}

TEST(DecideLabeling, PrefersMoreMarkersAndLeavesOneOutOnlyWhereNothingElseFits) {
  Random random(3);
  const Tool tool = test::five_marker_pen();
  auto view = std::make_unique<View>();
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  fill(*view, tool, truth, random);
  Labeling four = view->labelings.items[0];
  four.marker[1] = -1;
  four.count = 4;
  view->labelings.items[1] = four;
  view->labelings.count = 2;
  const auto decide = [&] {
    return decide_labeling(view->markers, view->sights, tool, view->labelings, nullptr, {});
  };
  EXPECT_EQ(decide().chosen, 0);
  view->markers.items[1].surface_range_m += 0.05;
  EXPECT_EQ(decide().chosen, 1);
  EXPECT_EQ(decide().pose.rejected, -1);
  view->labelings.count = 1;
  EXPECT_EQ(decide().chosen, 0);
  EXPECT_EQ(decide().pose.rejected, 1);
}

TEST(DecideLabeling, TellsHowMuchWorseTheNextOneIsInEitherOrder) {
  Random random(4);
  const Tool square = test::tool_of<4>({{0, 0, 0}, {0, 60, 0}, {0, 60, 60}, {0, 0, 60}});
  auto view = std::make_unique<View>();
  fill(*view, square, test::tilted_pose(square, 0.5, k_place, random), random);
  Labeling turned = view->labelings.items[0];
  turned.marker = {1, 2, 3, 0, -1, -1, -1, -1};
  view->labelings.items[1] = turned;
  view->labelings.count = 2;
  const auto decide = [&] {
    return decide_labeling(view->markers, view->sights, square, view->labelings, nullptr, {});
  };
  const DecidedLabeling first = decide();
  std::swap(view->labelings.items[0], view->labelings.items[1]);
  const DecidedLabeling second = decide();
  EXPECT_EQ(first.chosen, 1 - second.chosen);
  EXPECT_NEAR(first.delta_chi_square, second.delta_chi_square, 1e-9);
  EXPECT_LT(first.delta_chi_square, 1);  // a square is symmetric
  view->labelings.count = 1;
  EXPECT_GT(decide().delta_chi_square, 1e6);
}

TEST(DecideLabeling, SaysWhyThereIsNone) {
  Random random(5);
  const Tool tool = test::flat_tool();
  auto view = std::make_unique<View>();
  fill(*view, tool, test::tilted_pose(tool, 0.5, k_place, random), random);
  const auto reason = [&] {
    return decide_labeling(view->markers, view->sights, tool, view->labelings, nullptr, {}).reason;
  };
  EXPECT_EQ(reason(), Reason::none);
  view->sights[1].variance.range_m2 = 0;
  EXPECT_EQ(reason(), Reason::out_of_range);
  view->sights[1].variance.range_m2 = 1e-6;
  view->markers.items[1].surface_range_m += 0.1;
  EXPECT_EQ(reason(), Reason::bad_fit);
  view->labelings.count = 0;
  EXPECT_EQ(reason(), Reason::no_labeling);
  view->labelings.reason = Reason::search_full;
  EXPECT_EQ(reason(), Reason::search_full);
}

// Eight labelings of eight markers: all but the first have two markers swapped, and every other
// trial has two wrong ranges. Each is fitted twice, also without each marker.
TEST(DecideLabeling, EndsWithinItsDeclaredWorkAtItsWorstWithTheSameBitsEverywhere) {
  Random random(6);
  test::BitHash hash;
  auto view = std::make_unique<View>();
  const RefineSettings settings{4, 1};
  const RefineWork worst = decide_work_max(8, settings);
  RefineWork most;
  for (int trial = 0; trial < 40; ++trial) {
    const Tool tool = test::random_tool(random, 8);
    fill(*view, tool, test::tilted_pose(tool, random.within(0, 1.4), k_place, random), random);
    for (int k = 1; k < k_labelings_max; ++k) add_swapped(*view, 0, k);
    if (trial % 2 == 1) {
      view->markers.items[3].surface_range_m += 0.2;
      view->markers.items[5].surface_range_m -= 0.2;
    }
    const DecidedLabeling decided =
        decide_labeling(view->markers, view->sights, tool, view->labelings, nullptr, settings);
    EXPECT_LE(decided.work.fits, worst.fits);
    EXPECT_LE(decided.work.steps, worst.steps);
    EXPECT_LE(decided.work.marker_steps, worst.marker_steps);
    most.fits = std::max(most.fits, decided.work.fits);
    hash.add(decided.chosen);
    hash.add(decided.pose.chi_square);
    hash.add(decided.pose.T_camera_tool);
  }
  EXPECT_EQ(most.fits, worst.fits);
  EXPECT_EQ(hash.value(), 6384857369323064698u);
}

}  // namespace
}  // namespace glint::decide_labeling_test

// Evaluation of an alignment: counts of each kind of model pixel by hand, shares, and step counts.
#include "kernels/registration/judge_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "kernels/registration/judge_links.hpp"

namespace glint::judge_alignment_test {
namespace {

constexpr int k_width = 16, k_height = 12, k_pixels = k_width * k_height;
constexpr int k_on_model = 8 * 6;

// A square 1 m ahead, on columns 4 to 11 of rows 3 to 8. Neighbouring pixels are 62 mm apart, so
// that each pixel's nearest scene point is its own.
struct Square {
  Pinhole camera{k_width, k_height, 16, 16, 8, 6};
  std::vector<Vector3f> corners = {
      {-0.25f, -0.1875f, 1}, {0.25f, -0.1875f, 1}, {0.25f, 0.1875f, 1}, {-0.25f, 0.1875f, 1}};
  std::vector<Face> faces = {{0, 1, 2}, {0, 2, 3}};
  std::vector<float> depth = std::vector<float>(k_pixels, 3.0f);
  std::vector<std::uint8_t> mask;
  ScoreSettings settings{0.02, 0.25};
  AlignmentScratch scratch;
  int set = 0;  // number of model pixels assigned

  Square() { EXPECT_EQ(scratch.prepare(2, k_pixels, 4), Reason::none); }
  static std::size_t pixel_of(int i) {
    return static_cast<std::size_t>((3 + i / 8) * k_width + 4 + i % 8);
  }
  // Assigns a depth to the next model pixels.
  void next(int count, float depth_m, int mask_value = 1) {
    for (int i = 0; i < count; ++i, ++set) {
      depth[pixel_of(set)] = depth_m;
      if (!mask.empty()) mask[pixel_of(set)] = static_cast<std::uint8_t>(mask_value);
    }
  }
  [[nodiscard]] SceneView view() const { return {camera, depth, mask, {corners, faces}, {}}; }
  [[nodiscard]] AlignmentScore judged() {
    EXPECT_EQ(set, k_on_model);
    const SceneView one[] = {view()};
    return score_alignment(one, {}, settings, scratch);
  }
};

TEST(JudgeAlignment, CountsEachKindOfPixelUpToItsLimit) {
  Square scene;
  scene.next(5, 0);
  scene.next(7, 0.7f);    // in front: hidden
  scene.next(3, 0.75f);   // at the limit: not hidden
  scene.next(4, 1.3f);    // behind: seen through
  scene.next(2, 1.25f);   // at the limit: not seen through
  scene.next(1, 1.03f);   // near, but not an inlier
  scene.next(2, 1.015f);  // an inlier
  scene.next(24, 1);
  const AlignmentScore judged = scene.judged();
  EXPECT_EQ(judged.reason, Reason::none);
  EXPECT_EQ(judged.rendered, 48);
  EXPECT_EQ(judged.measured, 43);
  EXPECT_EQ(judged.occluded, 7);
  EXPECT_EQ(judged.free_space_violations, 4);
  EXPECT_EQ(judged.inliers, 26);
  EXPECT_EQ(judged.mask_pixels, 0);
  EXPECT_EQ(judged.mask_covered, 0);
  EXPECT_NEAR(judged.median_m, k_distance_step_m / 2, 1e-12);
  const AlignmentScratch::View& memory = scene.scratch.views[0];
  const OutlineCounts outline =
      count_outline(scene.view(), memory.z, memory.triangle, scene.settings.far_m);
  EXPECT_EQ(judged.outline.falls, outline.falls);
  EXPECT_EQ(judged.outline.continues, outline.continues);
  EXPECT_GT(judged.outline.falls, 0);
}

// A scene pixel that the mask excludes hides the model at any distance in front of it, and is not
// used as a scene point.
TEST(JudgeAlignment, CountsByTheMaskWhatIsNotTheModel) {
  Square scene;
  scene.mask.assign(k_pixels, 0);
  for (std::size_t i = 0; i < 6; ++i) scene.mask[i] = 2;  // six masked pixels, measured
  scene.depth[0] = 0;                                     // except the first
  scene.next(6, 0.99f, 0);                                // just in front
  scene.next(5, 1, 0);                                    // at the model
  scene.next(4, 1.3f, 0);                                 // behind
  scene.next(3, 0.99f, 1);
  scene.next(2, 0, 1);
  scene.next(28, 1, 1);
  const AlignmentScore judged = scene.judged();
  EXPECT_EQ(judged.measured, 46);
  EXPECT_EQ(judged.occluded, 6);
  EXPECT_EQ(judged.free_space_violations, 4);
  EXPECT_EQ(judged.inliers, 31);
  EXPECT_EQ(judged.mask_pixels, 5 + 31);
  EXPECT_EQ(judged.mask_covered, 31);
}

TEST(JudgeAlignment, AddsUpOverViews) {
  Square scene;
  scene.next(10, 1.3f);
  scene.next(8, 0.5f);
  scene.next(30, 1);
  const AlignmentScore one = scene.judged();
  const SceneView twice[] = {scene.view(), scene.view()};
  const AlignmentScore two = score_alignment(twice, {}, scene.settings, scene.scratch);
  EXPECT_EQ(two.rendered, 2 * one.rendered);
  EXPECT_EQ(two.measured, 2 * one.measured);
  EXPECT_EQ(two.occluded, 2 * one.occluded);
  EXPECT_EQ(two.free_space_violations, 2 * one.free_space_violations);
  EXPECT_EQ(two.inliers, 2 * one.inliers);
  EXPECT_EQ(two.outline.falls, 2 * one.outline.falls);
  EXPECT_EQ(two.median_m, one.median_m);
  const SceneView thrice[] = {twice[0], twice[0], twice[0]};
  EXPECT_EQ(score_alignment(thrice, {}, scene.settings, scene.scratch).reason,
            Reason::not_prepared);
}

// For an even number of distances, the lower of the two middle ones.
TEST(JudgeAlignment, HasTheMiddleDistanceForItsMedian) {
  for (const auto& [near, far, is_near] :
       {std::tuple{2, 1, true}, std::tuple{1, 1, true}, std::tuple{1, 2, false},
        std::tuple{20, 21, false}, std::tuple{24, 24, true}}) {
    Square scene;
    scene.next(near, 1);
    scene.next(far, 1.03f);  // up to 1.04 times as far along the ray
    scene.next(k_on_model - near - far, 0);
    const double median = scene.judged().median_m;
    EXPECT_GE(median, is_near ? k_distance_step_m / 2 : 0.03) << near << ' ' << far;
    EXPECT_LE(median, is_near ? k_distance_step_m / 2 : 0.0313) << near << ' ' << far;
  }
}

TEST(JudgeAlignment, LeavesWhatIsHiddenOutOfItsMedian) {
  Square scene;
  scene.next(30, 0.5f);
  scene.next(k_on_model - 30, 1);
  EXPECT_NEAR(scene.judged().median_m, k_distance_step_m / 2, 1e-12);
}

// A distance beyond the histogram's last step counts in that step.
TEST(JudgeAlignment, HasAMedianOfNoMoreThanTheReachOfItsSearches) {
  Square scene;
  scene.next(k_on_model, 1.2f);
  EXPECT_NEAR(scene.judged().median_m, k_distance_steps * k_distance_step_m, 1e-4);
}

TEST(JudgeAlignment, TakesTheStepsOfItsPixelsInSlicesOfAnySize) {
  Square scene;
  scene.depth.assign(k_pixels, 0);  // the grid is empty: a search takes no steps
  scene.set = k_on_model;
  const SceneView one[] = {scene.view()};
  constexpr int k_slots = 512;  // of a grid for 192 points
  const int expected = k_pixels * (k_scene_pixel_steps + k_outline_pixel_steps) +
                       k_slots * (k_grid_clear_steps + k_grid_sum_steps) +
                       k_on_model * k_score_steps;
  const SceneView twice[] = {one[0], one[0]};  // a second view, which later runs must not use
  EXPECT_EQ(score_alignment(twice, {}, scene.settings, scene.scratch).rendered, 2 * k_on_model);
  AlignmentScoring run;
  for (const int budget : {1, 100, SliceSize::k_steps_max}) {
    for (const float depth : {0.0f, -1.0f}) {  // not measured: no search
      scene.depth.assign(k_pixels, depth);
      run.start({}, scene.settings);
      int steps = 0;
      for (bool done = false; !done;) {
        StepBudget left(budget);
        done = run.step(one, left, scene.scratch);
        steps += budget - left.left();
        ASSERT_LE(budget - left.left(), budget + k_score_steps + k_outline_pixel_steps);
      }
      EXPECT_EQ(steps, expected) << budget;
      EXPECT_EQ(run.result().rendered, k_on_model);
      EXPECT_EQ(run.result().measured, 0);
    }
  }
  StepBudget more;
  EXPECT_TRUE(run.step(one, more, scene.scratch)) << "it has ended";
  EXPECT_EQ(more.left(), SliceSize::k_steps_max);
}

// The steps of each search count as well: as many as a separate search takes.
TEST(JudgeAlignment, TakesTheStepsOfItsSearches) {
  Square scene;
  scene.next(k_on_model, 1);
  const SceneView one[] = {scene.view()};
  AlignmentScore judged = scene.judged();
  ASSERT_EQ(judged.inliers, k_on_model);
  const AlignmentScratch::View& memory = scene.scratch.views[0];
  StepBudget searches;
  for (int i = 0; i < k_on_model; ++i) {
    (void)memory.grid.nearest(memory.seen[static_cast<std::size_t>(i)].point,
                              static_cast<float>(k_distance_steps * k_distance_step_m), searches);
  }
  const auto steps_of = [&] {
    AlignmentScoring run;
    run.start({}, scene.settings);
    StepBudget budget;
    while (!run.step(one, budget, scene.scratch)) {
    }
    return budget.left();
  };
  const int found = steps_of();
  scene.faces.clear();  // no model to evaluate
  const SceneView empty[] = {scene.view()};
  AlignmentScoring run;
  run.start({}, scene.settings);
  StepBudget budget;
  while (!run.step(empty, budget, scene.scratch)) {
  }
  EXPECT_EQ(budget.left() - found,
            k_on_model * k_score_steps + SliceSize::k_steps_max - searches.left());
}

TEST(Judgement, HasTheSharesOfItsCounts) {
  AlignmentScore j;
  EXPECT_EQ(j.inlier_share(), 0);
  EXPECT_EQ(j.seen_through_share(), 0);
  EXPECT_EQ(j.unhidden_seen_through_share(), 0);
  EXPECT_EQ(j.mask_share(), 0);
  EXPECT_EQ(j.visible_share(), 0);
  EXPECT_EQ(j.outline_share(), 1);
  j.rendered = 100, j.measured = 50, j.occluded = 10, j.inliers = 30, j.free_space_violations = 5;
  j.mask_pixels = 8, j.mask_covered = 6;
  j.outline.falls = 10, j.outline.continues = 30;
  EXPECT_DOUBLE_EQ(j.inlier_share(), 0.75);
  EXPECT_DOUBLE_EQ(j.seen_through_share(), 0.1);
  EXPECT_DOUBLE_EQ(j.unhidden_seen_through_share(), 0.125);
  EXPECT_DOUBLE_EQ(j.mask_share(), 0.75);
  EXPECT_DOUBLE_EQ(j.visible_share(), 0.4);
  EXPECT_DOUBLE_EQ(j.outline_share(), 0.5);
  // All measured pixels are hidden; then all but one.
  j.occluded = 50;
  EXPECT_EQ(j.inlier_share(), 0);
  EXPECT_EQ(j.unhidden_seen_through_share(), 0);
  EXPECT_EQ(j.visible_share(), 0);
  j.occluded = 49;
  EXPECT_EQ(j.inlier_share(), 30);
  EXPECT_EQ(j.unhidden_seen_through_share(), 5);
  EXPECT_DOUBLE_EQ(j.visible_share(), 0.01);
  j = {};
  j.rendered = j.measured = j.free_space_violations = j.mask_pixels = j.mask_covered = 1;
  EXPECT_EQ(j.visible_share(), 1);
  EXPECT_EQ(j.seen_through_share(), 1);
  EXPECT_EQ(j.mask_share(), 1);
}

// Each of the square's two faces is one link.
TEST(JudgeLinks, CountsTheSameKindsByLink) {
  Square scene;
  scene.next(5, 0);
  scene.next(7, 0.7f);
  scene.next(3, 0.75f);
  scene.next(4, 1.3f);
  scene.next(2, 1.25f);
  scene.next(1, 1.03f);
  scene.next(26, 1);
  const AlignmentScore judged = scene.judged();
  const SceneView one[] = {scene.view()};
  const std::vector<std::uint16_t> numbers = {3, 1};
  const std::span<const std::uint16_t> links[] = {numbers};
  const LinkScores found = score_links(one, links, {}, scene.settings, scene.scratch);
  ASSERT_EQ(found.reason, Reason::none);
  const LinkCounts &a = found.links[3], &b = found.links[1];
  EXPECT_GT(a.looked_at, 10);
  EXPECT_GT(b.looked_at, 10);
  EXPECT_EQ(a.looked_at + b.looked_at, judged.measured - judged.occluded);
  EXPECT_EQ(a.explained + b.explained, judged.inliers);
  EXPECT_EQ(a.free_space_violations + b.free_space_violations, judged.free_space_violations);
  // Reference: counts of the first face's pixels.
  LinkCounts upper;
  for (int i = 0; i < k_on_model; ++i) {
    const std::size_t pixel = Square::pixel_of(i);
    if (scene.scratch.views[0].triangle[pixel] != 0) continue;
    const float depth = scene.depth[pixel];
    if (depth == 0 || depth == 0.7f) continue;
    ++upper.looked_at;
    upper.explained += depth == 1 ? 1 : 0;
    upper.free_space_violations += depth == 1.3f ? 1 : 0;
  }
  EXPECT_EQ(a.looked_at, upper.looked_at);
  EXPECT_EQ(a.explained, upper.explained);
  EXPECT_EQ(a.free_space_violations, upper.free_space_violations);
  // A face without a link number adds nothing, nor does a number that is not a link's.
  const std::span<const std::uint16_t> first[] = {std::span(numbers).first(1)};
  const LinkScores fewer = score_links(one, first, {}, scene.settings, scene.scratch);
  EXPECT_EQ(fewer.links[3].looked_at, a.looked_at);
  EXPECT_EQ(fewer.links[1].looked_at, 0);
  const std::vector<std::uint16_t> last = {k_robot_links_max - 1, k_robot_links_max};
  const std::span<const std::uint16_t> of_last[] = {last};
  const LinkScores at_end = score_links(one, of_last, {}, scene.settings, scene.scratch);
  EXPECT_EQ(at_end.links[k_robot_links_max - 1].looked_at, a.looked_at);
}

TEST(JudgeLinks, LeavesOutWhatTheMaskExcludesInFrontAlone) {
  Square scene;
  scene.mask.assign(k_pixels, 0);
  scene.next(6, 0.99f, 0);
  scene.next(5, 1, 0);
  scene.next(37, 1, 1);
  const SceneView one[] = {scene.view()};
  const std::vector<std::uint16_t> numbers = {0, 0};
  const std::span<const std::uint16_t> links[] = {numbers};
  const LinkScores found = score_links(one, links, {}, scene.settings, scene.scratch);
  EXPECT_EQ(found.links[0].looked_at, 42);
  EXPECT_EQ(found.links[0].explained, 37);
  EXPECT_EQ(found.links[0].free_space_violations, 0);
}

TEST(JudgeLinks, AddsUpOverTheViewsThatHaveNumbers) {
  Square scene;
  scene.next(k_on_model, 1);
  const SceneView two[] = {scene.view(), scene.view()};
  const std::vector<std::uint16_t> numbers = {0, 0}, others = {1, 1};
  const std::span<const std::uint16_t> both[] = {numbers, others}, second[] = {{}, others};
  const LinkScores found = score_links(two, both, {}, scene.settings, scene.scratch);
  EXPECT_EQ(found.links[0].explained, k_on_model);
  EXPECT_EQ(found.links[1].explained, k_on_model);
  const LinkScores one = score_links(two, second, {}, scene.settings, scene.scratch);
  EXPECT_EQ(one.links[0].looked_at, 0);
  EXPECT_EQ(one.links[1].looked_at, k_on_model);
  const LinkScores first =
      score_links(two, std::span(both).first(1), {}, scene.settings, scene.scratch);
  EXPECT_EQ(first.links[0].looked_at, k_on_model);
  EXPECT_EQ(first.links[1].looked_at, 0);
}

}  // namespace
}  // namespace glint::judge_alignment_test

#include "kernels/registration/judge_links.hpp"

#include <gtest/gtest.h>

#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::judge_links_test {
namespace {

using test::k_truth;

// The arm of three boxes in front of a wall; each box is a link.
struct ArmScene {
  test::BoxArm model;
  Pinhole camera{320, 240, 300, 300, 160, 120};
  std::vector<float> depth = std::vector<float>(320 * 240);
  std::vector<std::int32_t> face = std::vector<std::int32_t>(320 * 240);
  std::vector<std::uint16_t> numbers;
  AlignmentScratch scratch;

  ArmScene() {
    EXPECT_EQ(scratch.prepare(1, 320 * 240, 64), Reason::none);
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, k_truth, camera, {depth, face, corners}),
              Reason::none);
    for (float& z : depth) z = z == 0 ? 2.2f : z;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      numbers.push_back(static_cast<std::uint16_t>(f / 12));
    }
  }
  [[nodiscard]] LinkScores judged(const std::vector<std::uint8_t>& mask = {}) {
    const SceneView view{camera, depth, mask, {model.corners, model.faces}, {}};
    const std::span<const std::uint16_t> links(numbers);
    return score_links({&view, 1}, {&links, 1}, k_truth, {}, scratch);
  }
  // Offsets the depth of link 2's pixels.
  void move_hand(float by_m) {
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (face[i] >= 24) depth[i] += by_m;
    }
  }
};

TEST(JudgeLinks, ExplainsEveryLinkOfARobotThatIsThere) {
  ArmScene scene;
  const LinkScores found = scene.judged();
  ASSERT_EQ(found.reason, Reason::none);
  for (std::size_t l = 0; l < 3; ++l) {
    EXPECT_GT(found.links[l].looked_at, 200) << l;
    EXPECT_EQ(found.links[l].explained, found.links[l].looked_at) << l;
    EXPECT_EQ(found.links[l].free_space_violations, 0) << l;
  }
  EXPECT_EQ(found.links[3].looked_at, 0);
}

TEST(JudgeLinks, CountsALinkThatIsElsewhereByItself) {
  ArmScene scene;
  scene.move_hand(0.3f);
  const LinkScores found = scene.judged();
  EXPECT_EQ(found.links[0].explained, found.links[0].looked_at);
  EXPECT_EQ(found.links[2].free_space_violations, found.links[2].looked_at);
  EXPECT_LT(found.links[2].explained, found.links[2].looked_at / 4);
}

TEST(JudgeLinks, LeavesOutWhatIsHidden) {
  ArmScene scene;
  scene.move_hand(-0.3f);
  const LinkScores found = scene.judged();
  EXPECT_EQ(found.links[2].looked_at, 0);
  EXPECT_GT(found.links[1].looked_at, 200);
}

TEST(JudgeLinks, AddsNothingWithoutNumbers) {
  ArmScene scene;
  scene.numbers.clear();
  const LinkScores found = scene.judged();
  EXPECT_EQ(found.reason, Reason::none);
  for (const LinkCounts& link : found.links) EXPECT_EQ(link.looked_at, 0);
  scene.numbers.assign(36, k_robot_links_max);
  for (const LinkCounts& link : scene.judged().links) EXPECT_EQ(link.looked_at, 0);
}

TEST(JudgeLinks, TakesNothingFromTheHeapAndStatesASmallScratch) {
  ArmScene scene;
  {
    const HeapCount heap;
    (void)scene.judged();
    EXPECT_EQ(heap.count(), 0u);
  }
  ASSERT_EQ(scene.scratch.prepare(1, 100, 64), Reason::none);
  EXPECT_EQ(scene.judged().reason, Reason::not_prepared);
}

}  // namespace
}  // namespace glint::judge_links_test

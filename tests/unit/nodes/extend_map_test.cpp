// Node ExtendMap: bounded slices of work, each depth image exactly once, and its progress report.
#include "nodes/extend_map.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace glint::extend_map_test {
namespace {

constexpr int k_side = 32;

// A wall at 1 m in front of a small camera.
class ExtendMapTest : public testing::Test {
 protected:
  ExtendMapTest() {
    node_.settings = limited_for_slices(MapSettings{});
    node_.settings.voxels_max = 4'096;
    node_.settings.planes.points_min = 100;
    memory_.resize(MapSlices::bytes(node_.settings));
    node_.memory = memory_;
    node_.images_per_map = 2;
    node_.limits.background_steps = 500;
    EXPECT_EQ(node_.prepare(), Reason::none);
    shown_.image.picture = {k_side, k_side, depth_};
    shown_.image.camera.width = shown_.image.camera.height = k_side;
    shown_.image.camera.fx = shown_.image.camera.fy = 40;
    shown_.image.camera.cx = shown_.image.camera.cy = 16;
  }
  // Runs all slices of a depth image, each within the declared maximum. Returns the steps.
  int run(std::uint64_t number) {
    shown_.number = number;
    int steps = 0;
    do {
      node_(shown_, progress_);
      EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, progress_.steps}}));
      EXPECT_TRUE(graph::within(node_.counts(), ExtendMap::worst(node_.limits)));
      EXPECT_EQ(progress_.free, node_.map().idle());
      steps += progress_.steps;
    } while (!progress_.free);
    return steps;
  }

  std::vector<float> depth_ = std::vector<float>(k_side * k_side, 1.0F);
  std::vector<std::byte> memory_;
  ExtendMap node_;
  ShownDepth shown_;
  MapProgress progress_;
};

TEST_F(ExtendMapTest, AddsEachPictureOnceAndMakesAMapOfSoMany) {
  EXPECT_GT(run(1), 500) << "several slices";
  EXPECT_EQ(progress_.totals.pictures, 1);
  EXPECT_EQ(progress_.totals.maps, 0);
  EXPECT_GT(progress_.totals.voxels, 0);
  EXPECT_EQ(run(1), 0) << "the same number is the same picture";
  EXPECT_EQ(progress_.totals.pictures, 1);
  EXPECT_GT(run(2), 0);
  EXPECT_EQ(progress_.totals.pictures, 2);
  EXPECT_EQ(progress_.totals.maps, 1);
}

TEST_F(ExtendMapTest, MakesAMapWhenItIsAskedTo) {
  (void)run(1);
  ASSERT_EQ(progress_.totals.maps, 0);
  node_.start_map();
  EXPECT_FALSE(node_.map().idle());
  EXPECT_GT(run(1), 0);
  EXPECT_EQ(progress_.totals.maps, 1);
  EXPECT_EQ(progress_.totals.pictures, 1);
}

// An image that arrives while another is in progress is processed after it.
TEST_F(ExtendMapTest, TakesUpTheNextPictureOnceItIsFree) {
  shown_.number = 1;
  node_(shown_, progress_);
  ASSERT_FALSE(progress_.free);
  (void)run(2);
  EXPECT_EQ(progress_.totals.pictures, 1);
  EXPECT_GT(run(2), 0);
  EXPECT_EQ(progress_.totals.pictures, 2);
}

TEST_F(ExtendMapTest, MakesNoneWithoutMemoryAndRefusesTooLittle) {
  ExtendMap none;
  EXPECT_EQ(none.prepare(), Reason::none);
  shown_.number = 1;
  none(shown_, progress_);
  EXPECT_TRUE(progress_.free);
  EXPECT_EQ(progress_.steps, 0);
  EXPECT_EQ(none.counts(), (graph::LoopCounts{{1, 0}}));
  node_.memory = std::span(memory_).first(memory_.size() / 2);
  EXPECT_EQ(node_.prepare(), Reason::not_prepared);
}

TEST_F(ExtendMapTest, MayTakeOneItemMoreThanItsSteps) {
  EXPECT_EQ(ExtendMap::worst(node_.limits), (graph::LoopCounts{{1, 500 + k_map_item_steps_max}}));
}

}  // namespace
}  // namespace glint::extend_map_test

// Image nodes: each passes its settings to its kernel and returns the kernel's counts.
#include "nodes/image_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace glint::image_nodes_test {
namespace {

using graph::LoopCounts;

constexpr int k_width = 96, k_height = 64;

// Three bright squares in three bands, at 0.5 m.
class ImageNodes : public testing::Test {
 protected:
  ImageNodes() {
    for (const auto& [left, top] : {std::array{10, 5}, std::array{40, 20}, std::array{70, 50}}) {
      for (int y = top; y < top + 6; ++y) {
        for (int x = left; x < left + 6; ++x) {
          bright_[static_cast<std::size_t>(y * k_width + x)] = 5'000;
        }
      }
    }
    frame_.reflectivity_16 = {bright_.data(), k_width, k_height};
    frame_.depth = {depth_.data(), k_width, k_height};
    limits_.width = k_width;
    limits_.height = k_height;
    limits_.blobs = 9;
    rois_.count = 2;
    rois_.items[0] = {0, 0, 50, k_height};
    rois_.items[1] = {50, 0, k_width, k_height};
  }
  // Runs RoiThreshold for each band.
  void threshold() {
    RoiThreshold node;
    node.threshold = 1'000;
    node.limits = limits_;
    for (int band = 0; band < k_row_bands; ++band) {
      node(frame_, rois_, {band, k_row_bands}, (*bands_)[band]);
    }
  }

  std::vector<std::uint16_t> bright_ = std::vector<std::uint16_t>(k_width * k_height, 100);
  std::vector<std::uint16_t> depth_ = std::vector<std::uint16_t>(k_width * k_height, 500);
  Frame frame_;
  Limits limits_;
  Rois rois_;
  std::unique_ptr<graph::Parts<Runs, k_row_bands>> bands_ =
      std::make_unique<graph::Parts<Runs, k_row_bands>>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
};

TEST_F(ImageNodes, ThresholdTheirBandAndCountItsStretchesBlocksAndRuns) {
  RoiThreshold node;
  node.threshold = 1'000;
  node.limits = limits_;
  LoopCounts sum{};
  for (int band = 0; band < k_row_bands; ++band) {
    auto expected = std::make_unique<Runs>(), found = std::make_unique<Runs>();
    const ThresholdWork work =
        threshold_runs(frame_, rois_, 1'000, {band, k_row_bands}, *expected, limits_);
    node(frame_, rois_, {band, k_row_bands}, *found);
    EXPECT_EQ(node.counts(), (LoopCounts{{1, work.stretches, work.blocks, work.runs}})) << band;
    EXPECT_EQ(found->count, expected->count);
    EXPECT_TRUE(graph::within(node.counts(), RoiThreshold::worst(limits_)));
    for (std::size_t loop = 0; loop < 4; ++loop) sum[loop] += node.counts()[loop];
  }
  EXPECT_EQ(sum[1], 2 * k_height) << "each row of each ROI";
  EXPECT_EQ(sum[3], 3 * 6);
  const ThresholdWork worst = threshold_work_max(limits_, k_row_bands);
  EXPECT_EQ(RoiThreshold::worst(limits_),
            (LoopCounts{{1, worst.stretches, worst.blocks, worst.runs}}));
}

TEST_F(ImageNodes, FindBlobsOfAllBandsAndCountTheirRunsAndPixels) {
  threshold();
  predictions_->marker_count = 2;
  predictions_->markers_px[0] = {12, 7};
  predictions_->markers_px[1] = {42, 22};
  FindBlobs node;
  node.limits = limits_;
  auto blobs = std::make_unique<Blobs>();
  node(frame_, *bands_, *predictions_, *blobs);
  EXPECT_EQ(blobs->count, 3);
  std::array<const Runs*, k_row_bands> in_order{};
  for (int i = 0; i < k_row_bands; ++i) in_order[static_cast<std::size_t>(i)] = &(*bands_)[i];
  auto scratch = std::make_unique<BlobScratch>();
  auto expected = std::make_unique<Blobs>();
  const BlobWork work = find_blobs(frame_, in_order, node.settings,
                                   {std::span(predictions_->markers_px.data(), 2), false, 0},
                                   *scratch, *expected, limits_);
  EXPECT_EQ(node.counts(),
            (LoopCounts{{1, work.runs, work.distances, work.blobs, work.pixels, work.rescans}}));
  EXPECT_EQ(node.counts()[1], 3 * 6);
  EXPECT_EQ(node.counts()[3], 3);
  EXPECT_GT(node.counts()[4], 3 * 36);
  const BlobWork worst = blob_work_max(limits_);
  EXPECT_EQ(
      FindBlobs::worst(limits_),
      (LoopCounts{{1, worst.runs, worst.distances, worst.blobs, worst.pixels, worst.rescans}}));
}

TEST_F(ImageNodes, BackProjectBlobsAndCountTheirPixelsAndSamples) {
  threshold();
  auto blobs = std::make_unique<Blobs>();
  FindBlobs find;
  find.limits = limits_;
  find(frame_, *bands_, *predictions_, *blobs);
  ASSERT_EQ(blobs->count, 3);
  BackProject node;
  node.limits = limits_;
  node.camera.width = k_width;
  node.camera.height = k_height;
  node.camera.fx = node.camera.fy = 250;
  node.camera.cx = 48;
  node.camera.cy = 32;
  ASSERT_EQ(node.prepare(), Reason::none);
  auto markers = std::make_unique<Markers>(), expected = std::make_unique<Markers>();
  node(frame_, *blobs, *markers);
  const BackProjectWork work = back_project(frame_, *blobs, node.camera, sphere_offset(node.camera),
                                            node.depth, node.nominal, *expected, limits_);
  EXPECT_EQ(
      node.counts(),
      (LoopCounts{{1, work.blobs, work.lens_steps, work.pixels, work.samples, work.unwrapped}}));
  EXPECT_EQ(node.counts()[1], 3);
  EXPECT_GT(node.counts()[4], 0);
  ASSERT_EQ(markers->count, expected->count);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(markers->items[i].ray, expected->items[i].ray);
    EXPECT_EQ(markers->items[i].surface_range_m, expected->items[i].surface_range_m);
  }
  const BackProjectWork worst = back_project_work_max(limits_);
  EXPECT_EQ(BackProject::worst(limits_),
            (LoopCounts{
                {1, worst.blobs, worst.lens_steps, worst.pixels, worst.samples, worst.unwrapped}}));
}

}  // namespace
}  // namespace glint::image_nodes_test

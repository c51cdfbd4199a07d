#include "platform/apps/board/worst_frames.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "kernels/image/roi_threshold.hpp"

namespace glint::worst_frames_test {
namespace {

constexpr std::uint16_t k_threshold = 100;

struct Drawn {
  int runs = 0;
  bool full = false;
  int bright = 0;
};

Drawn drawn(WorstFrame kind) {
  FrameBuffer pixels;
  pixels.width = k_width_max;
  pixels.height = k_height_max;
  pixels.reflectivity_16.resize(std::size_t{k_width_max} * k_height_max);
  draw(kind, k_threshold + 1, 0, 500, pixels);
  const Frame frame = pixels.view({}, {}, 1);
  Drawn result;
  auto runs = std::make_unique<Runs>();
  for (int band = 0; band < k_row_bands; ++band) {
    threshold_runs(frame, whole_frame(frame), k_threshold, {band, k_row_bands}, *runs);
    result.runs += runs->count;
    result.full = result.full || runs->reason == Reason::runs_full;
  }
  for (const std::uint16_t pixel : pixels.reflectivity_16) result.bright += pixel > k_threshold;
  return result;
}

TEST(WorstFrames, FillTheRunsOfEveryBand) {
  for (const WorstFrame kind :
       {WorstFrame::comb, WorstFrame::dots, WorstFrame::checkerboard, WorstFrame::noise}) {
    const Drawn found = drawn(kind);
    EXPECT_EQ(found.runs, k_row_bands * k_runs_per_band_max) << name_of(kind);
    EXPECT_TRUE(found.full) << name_of(kind);
  }
}

TEST(WorstFrames, HaveTheBrightPixelsTheyAreNamedFor) {
  constexpr int all = k_width_max * k_height_max;
  EXPECT_EQ(drawn(WorstFrame::all_bright).bright, all);
  EXPECT_EQ(drawn(WorstFrame::all_bright).runs, k_height_max);
  EXPECT_EQ(drawn(WorstFrame::comb).bright, all / 2);
  EXPECT_EQ(drawn(WorstFrame::dots).bright, all / 4);
  EXPECT_EQ(drawn(WorstFrame::checkerboard).bright, all / 2);
  EXPECT_NEAR(drawn(WorstFrame::noise).bright, all / 2, all / 100);
}

}  // namespace
}  // namespace glint::worst_frames_test

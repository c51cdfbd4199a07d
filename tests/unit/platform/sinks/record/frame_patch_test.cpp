// Pixels of a frame that a recording keeps: planes, sizes, regions enlarged and clipped.
#include "platform/sinks/record/frame_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint::frame_patch_test {
namespace {

bool operator==(const Roi& a, const Roi& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

// A frame whose pixels are never read.
Frame frame_of_size(int width, int height) {
  static const std::uint16_t pixel = 0;
  Frame frame;
  frame.reflectivity_16 = {&pixel, width, height};
  return frame;
}

TEST(FramePatch, KeepsWhatAFrameSaysOfItself) {
  Frame frame = frame_of_size(7, 5);
  frame.mid_exposure = {11};
  frame.stamp_sigma = {22};
  frame.arrival = {33};
  frame.sequence = 44;
  for (const FrameLayout& layout : {whole_frame_layout(frame), roi_layout(frame, {}, 3)}) {
    EXPECT_EQ(layout.mid_exposure, Time{11});
    EXPECT_EQ(layout.stamp_sigma, Duration{22});
    EXPECT_EQ(layout.arrival, Time{33});
    EXPECT_EQ(layout.sequence, 44u);
    EXPECT_EQ(layout.width, 7);
    EXPECT_EQ(layout.height, 5);
    EXPECT_EQ(layout.reflectivity_bits, 16);
    EXPECT_FALSE(layout.has_depth);
  }
  EXPECT_EQ(whole_frame_layout(frame).rectangle_count, 1);
  EXPECT_EQ(roi_layout(frame, {}, 3).rectangle_count, 0);
}

TEST(FramePatch, TakesSizesThatItsFieldsHold) {
  constexpr int k_last = 65535;
  const std::pair<int, int> taken[] = {{1, 1}, {k_last, 1}, {1, k_last}, {k_last, k_last}};
  for (const auto& [width, height] : taken) {
    const FrameLayout layout = whole_frame_layout(frame_of_size(width, height));
    EXPECT_EQ(layout.width, width);
    EXPECT_EQ(layout.height, height);
    ASSERT_EQ(layout.rectangle_count, 1);
    EXPECT_TRUE(layout.rectangles[0] == (Roi{0, 0, width, height}));
  }
  const std::pair<int, int> refused[] = {{0, 1},  {1, 0},          {-1, 1},
                                         {1, -1}, {k_last + 1, 1}, {1, k_last + 1}};
  for (const auto& [width, height] : refused) {
    const Frame frame = frame_of_size(width, height);
    const Rois rois{{Roi{0, 0, 1, 1}}, 1};
    for (const FrameLayout& layout : {whole_frame_layout(frame), roi_layout(frame, rois, 0)}) {
      EXPECT_EQ(layout.width, 0) << width << ' ' << height;
      EXPECT_EQ(layout.height, 0);
      EXPECT_EQ(layout.reflectivity_bits, 0);
      EXPECT_EQ(layout.rectangle_count, 0);
      EXPECT_EQ(pixel_bytes(layout), 0u);
    }
  }
}

TEST(FramePatch, HasDepthWhereItsPlaneIsOfTheSameSize) {
  static const std::uint16_t pixel = 0;
  const std::pair<int, int> sizes[] = {{7, 5}, {6, 5}, {7, 4}, {5, 7}};
  for (const auto& [width, height] : sizes) {
    Frame frame = frame_of_size(7, 5);
    frame.depth = {&pixel, width, height};
    EXPECT_EQ(whole_frame_layout(frame).has_depth, width == 7 && height == 5) << width;
    frame.depth.pixels = nullptr;
    EXPECT_FALSE(whole_frame_layout(frame).has_depth);
  }
}

TEST(FramePatch, CountsTheBytesOfEachPlaneOfEachRectangle) {
  FrameLayout layout;
  const Roi small{2, 3, 5, 7}, large{0, 0, 10, 6};  // 12 and 60 pixels
  layout.rectangles[0] = small;
  layout.rectangles[1] = large;
  layout.rectangle_count = 2;
  for (const int bits : {0, 8, 16}) {
    for (const bool has_depth : {false, true}) {
      layout.reflectivity_bits = static_cast<std::uint8_t>(bits);
      layout.has_depth = has_depth;
      const auto bright = static_cast<std::size_t>(bits / 8),
                 far = std::size_t{has_depth ? 2u : 0u};
      EXPECT_EQ(reflectivity_bytes(layout, small), 12 * bright);
      EXPECT_EQ(depth_bytes(layout, large), 60 * far);
      EXPECT_EQ(pixel_bytes(layout), 72 * (bright + far));
    }
  }
}

TEST(FramePatch, GrowsEachRegionByTheMarginUpToTheBorder) {
  const Frame frame = frame_of_size(100, 80);
  struct Case {
    Roi region, kept;
  };
  const Case cases[] = {
      {{40, 30, 50, 44}, {33, 23, 57, 51}},   {{7, 7, 9, 9}, {0, 0, 16, 16}},
      {{6, 30, 50, 44}, {0, 23, 57, 51}},     {{40, 6, 50, 44}, {33, 0, 57, 51}},
      {{40, 30, 94, 44}, {33, 23, 100, 51}},  {{40, 30, 50, 74}, {33, 23, 57, 80}},
      {{-20, 30, -5, 44}, {0, 23, 2, 51}},    {{40, -20, 50, -5}, {33, 0, 57, 2}},
      {{105, 30, 110, 44}, {98, 23, 100, 51}}};
  for (const Case& one : cases) {
    const FrameLayout layout = roi_layout(frame, Rois{{one.region}, 1}, 7);
    ASSERT_EQ(layout.rectangle_count, 1);
    EXPECT_TRUE(layout.rectangles[0] == one.kept) << one.region.x0 << ' ' << one.region.y0;
  }
  for (const Roi& outside :
       {Roi{-20, 30, -7, 44}, Roi{107, 30, 110, 44}, Roi{40, -20, 50, -7}, Roi{40, 87, 50, 90},
        Roi{40, 30, 40, 44}, Roi{40, 30, 50, 30}, Roi{50, 30, 40, 44}, Roi{40, 44, 50, 30}}) {
    EXPECT_EQ(roi_layout(frame, Rois{{outside}, 1}, 7).rectangle_count, 0) << outside.x0;
  }
}

TEST(FramePatch, KeepsAFrameWholeAsSoonAsItsRegionsHoldAsManyPixels) {
  const Frame frame = frame_of_size(10, 8);
  const FrameLayout most = roi_layout(frame, Rois{{Roi{0, 0, 10, 7}, Roi{0, 7, 9, 8}}, 2}, 0);
  EXPECT_EQ(most.rectangle_count, 2) << "one pixel is not kept";
  const FrameLayout all = roi_layout(frame, Rois{{Roi{0, 0, 10, 4}, Roi{0, 0, 10, 4}}, 2}, 0);
  ASSERT_EQ(all.rectangle_count, 1) << "they overlap";
  EXPECT_TRUE(all.rectangles[0] == (Roi{0, 0, 10, 8}));
  EXPECT_EQ(roi_layout(frame, Rois{{Roi{4, 4, 5, 5}}, 1}, 20).rectangle_count, 1);
  EXPECT_EQ(roi_layout(frame, Rois{{Roi{4, 4, 5, 5}}, 1}, 20).rectangles[0].x0, 0);
}

TEST(FramePatch, LooksAtAsManyRegionsAsThereAre) {
  const Frame frame = frame_of_size(1000, 1000);
  Rois rois;
  for (Roi& roi : rois.items) roi = {1, 1, 2, 2};
  for (const int count : {-1, 0, 1, k_tools_max, k_tools_max + 1}) {
    rois.count = count;
    EXPECT_EQ(roi_layout(frame, rois, 0).rectangle_count, std::clamp(count, 0, k_tools_max));
  }
}

// Rectangle by rectangle: reflectivity, then depth, each row by row.
TEST(FramePatch, CopiesTheRowsOfItsRectanglesInTheirOrder) {
  for (const int bits : {8, 16}) {
    const FrameBuffer buffer = sample_frame(9, 6, bits);
    const Frame frame = buffer.view({}, {}, 0);
    const FrameLayout layout = roi_layout(frame, Rois{{Roi{2, 1, 5, 3}, Roi{8, 5, 9, 6}}, 2}, 0);
    std::vector<std::uint8_t> pixels(pixel_bytes(layout)), expected;
    copy_pixels(frame, layout, pixels);
    const auto put = [&expected](unsigned value, int bytes) {
      for (int i = 0; i < bytes; ++i) expected.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    };
    for (const Roi& roi : {Roi{2, 1, 5, 3}, Roi{8, 5, 9, 6}}) {
      for (const bool depth : {false, true}) {
        for (int y = roi.y0; y < roi.y1; ++y) {
          for (int x = roi.x0; x < roi.x1; ++x) {
            const auto at = static_cast<std::size_t>(9 * y + x);
            if (depth) put(buffer.depth[at], 2);
            if (!depth && bits == 8) put(buffer.reflectivity_8[at], 1);
            if (!depth && bits == 16) put(buffer.reflectivity_16[at], 2);
          }
        }
      }
    }
    EXPECT_EQ(pixels, expected) << bits;
  }
}

}  // namespace
}  // namespace glint::frame_patch_test

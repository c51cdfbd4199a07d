// Messages with more elements than their type allows, or pixels that do not match the rectangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint::message_limits_test {
namespace {

// A frame message, written field by field.
struct FrameText {
  std::uint16_t width = 6, height = 4;
  std::uint8_t bits = 8;
  bool has_depth = true, in_images = false;
  struct Rectangle {
    std::uint16_t x, y, width, height;
    std::size_t bright, far;  // bytes
  };
  std::vector<Rectangle> rectangles;

  [[nodiscard]] std::optional<FrameMessage> read(const ImageRows& reflectivity = {},
                                                 const ImageRows& depth = {}) const {
    CdrWriter to;
    put_header(to, {}, "");
    to.put(std::int64_t{1});
    to.put(std::int64_t{2});
    to.put(std::uint32_t{3});
    to.put(width);
    to.put(height);
    to.put(bits);
    to.put(has_depth);
    to.put(in_images);
    to.put_length(rectangles.size());
    for (const Rectangle& r : rectangles) {
      for (const std::uint16_t number : {r.x, r.y, r.width, r.height}) to.put(number);
      to.put_bytes(Bytes(r.bright, 0xAB));
      to.put_bytes(Bytes(r.far, 0xCD));
    }
    return read_frame(to.bytes(), reflectivity, depth);
  }
};

TEST(FrameMessage, HoldsTheRowsOfItsRectangleAndNoByteMore) {
  for (const std::size_t bright : {23, 24, 25}) {
    for (const std::size_t far : {46, 48, 50}) {
      FrameText text;
      text.rectangles = {{0, 0, 6, 4, bright, far}};
      EXPECT_EQ(text.read().has_value(), bright == 24 && far == 48) << bright << ' ' << far;
      text.has_depth = false;
      EXPECT_FALSE(text.read()) << "depth of a frame without";
      text.rectangles[0].far = 0;
      EXPECT_EQ(text.read().has_value(), bright == 24) << bright;
    }
  }
  FrameText wide;
  wide.bits = 16;
  wide.rectangles = {{0, 0, 6, 4, 48, 48}};
  EXPECT_TRUE(wide.read());
  wide.rectangles = {{0, 0, 6, 4, 24, 48}};
  EXPECT_FALSE(wide.read());
  FrameText none;
  none.bits = 0;
  none.rectangles = {{0, 0, 6, 4, 0, 48}};
  EXPECT_TRUE(none.read());
  none.rectangles = {{0, 0, 6, 4, 1, 48}};
  EXPECT_FALSE(none.read()) << "reflectivity of a frame without";
}

TEST(FrameMessage, HasItsRectanglesInsideTheFrame) {
  for (std::uint16_t x = 0; x <= 7; ++x) {
    for (std::uint16_t y = 0; y <= 5; ++y) {
      FrameText text;
      text.rectangles = {{x, y, 2, 1, 2, 4}};
      const auto frame = text.read();
      ASSERT_EQ(frame.has_value(), x + 2 <= 6 && y + 1 <= 4) << x << ' ' << y;
      if (!frame) continue;
      for (int i = 0; i < 24; ++i) {
        const bool inside = i / 6 == y && i % 6 >= x && i % 6 < x + 2;
        const auto at = static_cast<std::size_t>(i);
        EXPECT_EQ(frame->pixels.reflectivity_8[at], inside ? 0xAB : 0);
        EXPECT_EQ(frame->pixels.depth[at], inside ? 0xCDCD : 0);
      }
    }
  }
}

// One pixel, one row, one column, and an empty rectangle.
TEST(FrameMessage, TakesRectanglesOfAnySize) {
  for (std::uint16_t width = 0; width <= 6; ++width) {
    for (std::uint16_t height = 0; height <= 4; ++height) {
      FrameText text;
      const std::size_t pixels = std::size_t{width} * height;
      text.rectangles = {{0, 0, width, height, pixels, 2 * pixels}};
      const auto frame = text.read();
      ASSERT_TRUE(frame) << width << ' ' << height;
      const auto& bright = frame->pixels.reflectivity_8;
      EXPECT_EQ(std::count(bright.begin(), bright.end(), 0xAB), static_cast<long>(pixels));
      EXPECT_EQ(frame->pixels.depth.size(), 24U);
    }
  }
}

TEST(FrameMessage, HoldsAsManyRectanglesAsThereMayBeTools) {
  FrameText text;
  text.rectangles.assign(k_patch_rectangles_max, {0, 0, 1, 1, 1, 2});
  EXPECT_TRUE(text.read());
  text.rectangles.push_back(text.rectangles[0]);
  EXPECT_FALSE(text.read());
}

TEST(FrameMessage, AsksForNoMorePixelsThanACameraHas) {
  FrameText text;
  text.width = k_width_max;
  text.height = k_height_max;
  const auto whole = text.read();
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->pixels.reflectivity_8.size(), std::size_t{k_width_max} * k_height_max);
  EXPECT_TRUE(whole->pixels.reflectivity_16.empty());
  text.width = k_width_max + 1;
  EXPECT_FALSE(text.read());
  text.width = 1;
  text.height = 65535;  // another shape with fewer pixels
  EXPECT_TRUE(text.read());
}

TEST(FrameMessage, TakesItsPixelsFromTheImagesWhereItSaysSo) {
  ImageRows bright, far;
  bright.rows.assign(24, 0x11);
  far.rows.assign(48, 0x22);
  FrameText text;
  EXPECT_EQ(text.read(bright, far)->pixels.reflectivity_8[0], 0) << "not asked for";
  text.in_images = true;
  const auto frame = text.read(bright, far);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->pixels.reflectivity_8, std::vector<std::uint8_t>(24, 0x11));
  EXPECT_EQ(frame->pixels.depth, std::vector<std::uint16_t>(24, 0x2222));
  EXPECT_FALSE(text.read({}, far));
  EXPECT_FALSE(text.read(bright, {}));
  text.has_depth = false;
  EXPECT_TRUE(text.read(bright, {}));
  EXPECT_TRUE(text.read(bright, far)) << "a depth image of an earlier frame";
  EXPECT_TRUE(text.read(bright, far)->pixels.depth.empty());
}

TEST(ImageMessage, GivesBackItsShapeAndItsRows) {
  CdrWriter to;
  write_image(to, {}, {3, 2, 2, "mono16"}, Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  const auto image = read_image(to.bytes());
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 3u);
  EXPECT_EQ(image->height, 2u);
  EXPECT_EQ(image->step, 6u);
  EXPECT_EQ(image->rows, (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  for (std::size_t length = 0; length < to.bytes().size(); ++length)
    EXPECT_FALSE(read_image(to.bytes().first(length))) << length;
  for (const std::size_t rows : {11, 13}) {
    write_image(to, {}, {3, 2, 2, "mono16"}, Bytes(rows));
    EXPECT_FALSE(read_image(to.bytes())) << rows;
  }
}

// Kind and policy of an overrun share a byte: tests all 256 values.
TEST(ChoiceMessage, TakesTheOverrunsThatThereAreAndNoOther) {
  CdrWriter to;
  ChoiceRecord choice = sample_choice(1);
  write_message(to, choice, {});
  const Bytes bytes(to.bytes().begin(), to.bytes().end());
  // Group and overrun are after the 16 bytes of the header and two 8-byte numbers.
  constexpr std::size_t k_overrun_at = 4 + 16 + 8 + 8 + 1;
  ASSERT_EQ(bytes[k_overrun_at - 1], choice.group);
  ASSERT_EQ(bytes[k_overrun_at], 2 + 4 * 2);
  for (unsigned value = 0; value < 256; ++value) {
    Bytes other = bytes;
    other[k_overrun_at] = static_cast<std::uint8_t>(value);
    const unsigned kind = value % 4, policy = value / 4;
    const auto read = read_choice(other);
    ASSERT_EQ(read.has_value(), value == 0 || (kind >= 1 && policy <= 3)) << value;
    if (!read) continue;
    EXPECT_EQ(static_cast<unsigned>(read->overrun.kind), kind);
    EXPECT_EQ(static_cast<unsigned>(read->overrun.policy), policy);
    EXPECT_EQ(read->overrun.after_node, value == 0 ? 0 : choice.overrun.after_node);
  }
}

// The length of a list, and of the lists after it, is bounded by the type or by the first list.
TEST(MessageLists, AreNotLongerThanTheirType) {
  CdrWriter to;
  put_header(to, {}, "");
  to.put(std::int64_t{1});
  to.put(std::uint64_t{2});
  to.put(std::uint8_t{0});
  to.put(std::uint8_t{0});
  to.put(std::int64_t{3});
  to.put_length(k_recorded_versions + 1);
  for (int i = 0; i <= k_recorded_versions; ++i) to.put(std::uint64_t{4});
  EXPECT_FALSE(read_choice(to.bytes()));
  to.begin();
  put_header(to, {}, "");
  to.put(std::int64_t{1});
  to.put(std::int64_t{2});
  to.put(std::uint32_t{3});
  to.put(std::uint8_t{0});
  to.put_length(0xFFFFFFFF);
  EXPECT_FALSE(read_markers(to.bytes()));
}

TEST(MarkersMessage, HasTheSameNumberInEachOfItsLists) {
  CdrWriter to;
  write_message(to, sample_markers(3), {});
  const Bytes bytes(to.bytes().begin(), to.bytes().end());
  int lists = 0;
  for (std::size_t at = 40; at + 4 <= bytes.size(); at += 4) {  // after header and time stamps
    if (get_little_endian(std::span(bytes).subspan(at, 4)) != 3) continue;
    ++lists;
    for (const std::uint8_t other : {2, 4}) {
      Bytes changed = bytes;
      changed[at] = other;
      EXPECT_FALSE(read_markers(changed)) << at;
    }
  }
  EXPECT_EQ(lists, 4);
}

TEST(MarkersMessage, NamesAReasonThatThereIsForMissingMarkers) {
  for (int value = 0; value < 256; ++value) {
    MarkerFrame frame = sample_markers(1);
    frame.markers.incomplete = static_cast<Reason>(value);
    CdrWriter to;
    write_message(to, frame, {});
    const auto read = read_markers(to.bytes());
    ASSERT_EQ(read.has_value(), value <= static_cast<int>(k_last_reason)) << value;
    if (!read) continue;
    EXPECT_EQ(read->markers.incomplete, frame.markers.incomplete);
  }
}

}  // namespace
}  // namespace glint::message_limits_test

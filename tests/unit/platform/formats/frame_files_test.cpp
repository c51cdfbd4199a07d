#include "platform/formats/frame_files.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "platform/input_error.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

using test::message_of;
using test::TemporaryFolder;

constexpr std::size_t k_pixels = std::size_t{512} * 512;

void put(std::string& bytes, std::size_t at, int value) {
  bytes[at] = static_cast<char>(value & 0xFF);
  bytes[at + 1] = static_cast<char>(value >> 8 & 0xFF);
}

std::string refusal(const std::string& path, FrameFileLayout layout) {
  return message_of<InputError>([&] { (void)load_frame(path, layout); });
}

TEST(FrameFiles, MoveTheBrightnessOfAdiBackByItsColumns) {
  const TemporaryFolder folder;
  std::string bytes(k_pixels * 5, '\0');
  const std::size_t depth_at = 7 * 512 + 100, bright_at = depth_at + 32;
  put(bytes, depth_at * 5, 0x1234);
  bytes[bright_at * 5 + 2] = '\x55';  // confidence
  put(bytes, bright_at * 5 + 3, 0xFEDC);
  put(bytes, (8 * 512 + 3) * 5 + 3, 777);  // the first 32 columns hold no pixel
  const FrameBuffer frame = load_frame(folder.write("f.bin", bytes), FrameFileLayout::adi);
  EXPECT_EQ(frame.width, 512);
  EXPECT_EQ(frame.height, 512);
  EXPECT_EQ(frame.depth[depth_at], 0x1234);
  EXPECT_EQ(frame.reflectivity_16[depth_at], 0xFEDC);
  std::size_t bright = 0;
  for (const std::uint16_t value : frame.reflectivity_16) bright += value != 0;
  EXPECT_EQ(bright, 1u);
}

TEST(FrameFiles, ReadAhatDepthThenBrightness) {
  const TemporaryFolder folder;
  std::string bytes(k_pixels * 4, '\0');
  put(bytes, 2 * 1000, 640);
  put(bytes, 2 * (k_pixels + 1000), 0x8001);
  const FrameBuffer frame = load_frame(folder.write("f.bin", bytes), FrameFileLayout::ahat);
  EXPECT_EQ(frame.depth[1000], 640);
  EXPECT_EQ(frame.reflectivity_16[1000], 0x8001);
}

TEST(FrameFiles, ReadAPairOfPgmFromEitherName) {
  const TemporaryFolder folder;
  const std::string depth = folder.write(
      "1.pgm", std::string("P5\n# by hand\n2 1\n65535\n") + std::string("\x01\x02\x00\x03", 4));
  const std::string bright =
      folder.write("1_ab.pgm", std::string("P5 2 1 65535 ") + std::string("\x10\x00\x00\x0a", 4));
  for (const std::string& path : {depth, bright}) {
    const FrameBuffer frame = load_frame(path, FrameFileLayout::pgm);
    EXPECT_EQ(frame.width, 2);
    EXPECT_EQ(frame.height, 1);
    EXPECT_EQ(frame.depth, (std::vector<std::uint16_t>{0x0102, 3}));
    EXPECT_EQ(frame.reflectivity_16, (std::vector<std::uint16_t>{0x1000, 10}));
  }
}

TEST(FrameFiles, RefuseAWrongSizeSayingFoundAndExpected) {
  const TemporaryFolder folder;
  const std::string path = folder.write("f.bin", std::string(1000, 'x'));
  EXPECT_EQ(refusal(path, FrameFileLayout::adi).rfind(path + ": 1000 bytes; expected 1310720", 0),
            0u);
  EXPECT_EQ(refusal(path, FrameFileLayout::ahat).rfind(path + ": 1000 bytes; expected 1048576", 0),
            0u);
  const std::string longer = folder.write("g.bin", std::string(k_pixels * 4 + 1, 'x'));
  EXPECT_NE(refusal(longer, FrameFileLayout::ahat).find("1048577 bytes"), std::string::npos);
  EXPECT_NE(refusal(folder.path("none"), FrameFileLayout::adi).find("cannot be read"),
            std::string::npos);
}

TEST(FrameFiles, RefusePicturesThatAreNotSixteenBitPgm) {
  const TemporaryFolder folder;
  const struct {
    std::string bytes, expected;
  } cases[] = {
      {"P2 2 1 65535 1 2", "does not begin with P5"},
      {"P5 2 1 255 ab", "255; expected a maxval for 16 bits"},
      {"P5 2 1 70000 abcd", "70000; expected a maxval"},
      {"P5 1025 1 65535 ", "1025; expected a width from 1 to 1024"},
      {"P5 0 1 65535 ", "0; expected a width"},
      {"P5 2 x", "no number; expected a height"},
      {"P5 2 1 65535 abc", "3 bytes of pixels; expected 4"},
      {"P5 2 1 65535 abcde", "5 bytes of pixels; expected 4"},
      {"P5 2 1 65535", "0 bytes of pixels; expected 4"},
      {"P5 99999999999999999999 1 65535 ", "expected a width"},
      {"", "does not begin with P5"},
  };
  for (const auto& c : cases) {
    const std::string path = folder.write("1.pgm", c.bytes);
    const std::string message = refusal(path, FrameFileLayout::pgm);
    EXPECT_EQ(message.rfind(path, 0), 0u) << message;
    EXPECT_NE(message.find(c.expected), std::string::npos) << message;
  }
}

TEST(FrameFiles, RefuseAPgmWithoutItsTwinOrWithOneOfAnotherSize) {
  const TemporaryFolder folder;
  const std::string depth = folder.write("1.pgm", "P5 2 1 65535 abcd");
  EXPECT_NE(refusal(depth, FrameFileLayout::pgm).find("1_ab.pgm: cannot be read"),
            std::string::npos);
  folder.write("1_ab.pgm", "P5 1 2 65535 abcd");
  EXPECT_NE(refusal(depth, FrameFileLayout::pgm).find("1 x 2; expected 2 x 1"), std::string::npos);
  EXPECT_NE(refusal("frame.bin", FrameFileLayout::pgm).find("does not end in .pgm"),
            std::string::npos);
}

TEST(FrameFiles, KnowTheirLayoutsByName) {
  EXPECT_EQ(frame_file_layout_of("adi"), FrameFileLayout::adi);
  EXPECT_EQ(frame_file_layout_of("ahat"), FrameFileLayout::ahat);
  EXPECT_EQ(frame_file_layout_of("pgm"), FrameFileLayout::pgm);
  EXPECT_NE(
      message_of<InputError>([] { (void)frame_file_layout_of("png"); }).find("adi, ahat or pgm"),
      std::string::npos);
}

TEST(FrameFiles, ReadARealOfficeInWhichNothingIsAsBrightAsAMarker) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(data ? data : "") + "/tof_ab/adi_frame_mode3.bin";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real frame at GLINT_TEST_DATA";
  const FrameBuffer frame = load_frame(path, FrameFileLayout::adi);
  std::size_t bright = 0, far = 0;
  for (std::size_t i = 0; i < k_pixels; ++i) {
    bright += frame.reflectivity_16[i] > 1280;
    far += frame.depth[i] > 500 && frame.depth[i] < 8000;
  }
  EXPECT_LE(bright, 1u);
  EXPECT_GT(far, k_pixels * 8 / 10);
}

}  // namespace
}  // namespace glint

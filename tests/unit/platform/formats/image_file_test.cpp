#include "platform/formats/image_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

using test::message_of;
using test::TemporaryFolder;
using Values = std::vector<std::uint16_t>;

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift));
  return bytes;
}

std::string chunk(const std::string& kind, const std::string& data) {
  const std::string named = kind + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + named +
         big_endian(static_cast<std::uint32_t>(sum));
}

// A PNG by its specification, with zlib only: `rows` includes each row's filter byte 0.
std::string png(std::uint32_t width, std::uint32_t height, int depth, int colour_type,
                const std::string& rows, const std::string& before_pixels = "") {
  std::string packed(rows.size() + 100, '\0');
  uLongf length = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &length,
           reinterpret_cast<const Bytef*>(rows.data()), rows.size());
  packed.resize(length);
  const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(depth) +
                             static_cast<char>(colour_type) + std::string(3, '\0');
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", header) + before_pixels + chunk("IDAT", packed) +
         chunk("IEND", "");
}

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out.push_back(static_cast<char>(value));
  return out;
}

TEST(PictureFile, ReadsEachKindOfPng) {
  const TemporaryFolder folder;
  const struct {
    std::string name, file;
    int channels, bits;
    Values values;
  } cases[] = {
      {"grey, 8 bits", png(2, 2, 8, 0, bytes({0, 1, 2, 0, 3, 255})), 1, 8, {1, 2, 3, 255}},
      {"grey, 16 bits", png(2, 1, 16, 0, bytes({0, 1, 2, 255, 254})), 1, 16, {0x102, 0xFFFE}},
      {"grey, 1 bit", png(3, 1, 1, 0, bytes({0, 0xA0})), 1, 8, {255, 0, 255}},
      {"grey and alpha", png(1, 1, 8, 4, bytes({0, 7, 0})), 3, 8, {7, 7, 7}},
      {"colours", png(1, 2, 8, 2, bytes({0, 1, 2, 3, 0, 4, 5, 6})), 3, 8, {1, 2, 3, 4, 5, 6}},
      {"colours, 16 bits",
       png(1, 1, 16, 2, bytes({0, 1, 0, 2, 0, 3, 9})),
       3,
       16,
       {0x100, 0x200, 0x309}},
      {"colours and alpha", png(1, 1, 8, 6, bytes({0, 1, 2, 3, 0})), 3, 8, {1, 2, 3}},
      {"palette",
       png(2, 1, 8, 3, bytes({0, 1, 0}), chunk("PLTE", bytes({1, 2, 3, 4, 5, 6}))),
       3,
       8,
       {4, 5, 6, 1, 2, 3}},
  };
  for (const auto& c : cases) {
    const Image picture = read_image_file(folder.write("a.png", c.file));
    EXPECT_EQ(picture.channels, c.channels) << c.name;
    EXPECT_EQ(picture.bits, c.bits) << c.name;
    EXPECT_EQ(picture.values, c.values) << c.name;
    EXPECT_EQ(c.values.size(),
              static_cast<std::size_t>(picture.width * picture.height * picture.channels))
        << c.name;
  }
}

TEST(PictureFile, ReadsPgmOf8And16Bits) {
  const TemporaryFolder folder;
  const Image shallow = read_image_file(folder.write("a.pgm", "P5 2 1 255 " + bytes({200, 3})));
  EXPECT_EQ(shallow.values, (Values{200, 3}));
  EXPECT_EQ(shallow.bits, 8);
  const Image deep = read_image_file(folder.write("a.pgm", "P5 1 1 4095 " + bytes({2, 1})));
  EXPECT_EQ(deep.values, (Values{0x201}));
  EXPECT_EQ(deep.bits, 16);
}

TEST(PictureFile, RefusesWhatIsNoWholePicture) {
  const TemporaryFolder folder;
  const std::string whole = png(2, 2, 8, 0, bytes({0, 1, 2, 0, 3, 4}));
  std::string wrong_sum = whole;
  wrong_sum[45] ^= 1;  // in IDAT
  const struct {
    std::string file, expected;
  } cases[] = {
      {whole.substr(0, whole.size() - 20), "incomplete image: "},
      {whole.substr(0, 20), "not an image; expected a PNG"},
      {wrong_sum, "incomplete image: "},
      {png(2, 2, 3, 0, "0"), "invalid image: "},
      {png(16'000, 4'000, 16, 2, "0"), "bytes, too few for 16000 x 4000 pixels"},
      {png(16'385, 1, 8, 0, "0"), ":byte 16: 16385 x 1 pixels; expected at most 16384 a side"},
      {png(16'000, 16'000, 8, 0, "0"), ":byte 16: 16000 x 16000 pixels"},
      {"P5 16385 1 255 ", "16385; expected a width from 1 to 16384"},
      {"P5 16000 16000 255 ", "16000 x 16000 pixels"},
      {"P5 1 1 0 a", "0; expected a maxval"},
  };
  for (const auto& c : cases) {
    const std::string path = folder.write("a.png", c.file);
    const std::string message = message_of<InputError>([&] { (void)read_image_file(path); });
    EXPECT_EQ(message.rfind(path, 0), 0u) << message << " for " << c.expected;
    EXPECT_NE(message.find(c.expected), std::string::npos) << message << " for " << c.expected;
  }
  EXPECT_NE(message_of<InputError>([&] { (void)read_image_file(folder.path("")); }), "");
  EXPECT_NE(message_of<InputError>([&] { (void)read_image_file("/nonexistent/a.png"); }), "");
}

TEST(PictureFile, AWrittenPngHoldsTheValues) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> values(3 * 5 * 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(37 * i);
  const std::string path = folder.path("a.png");
  for (const int channels : {1, 3}) {
    const int width = channels == 1 ? 9 : 3;
    write_png(path, width, 5, channels, values.data(), "a place");
    const Image read = read_png(path, "");
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, 5);
    EXPECT_EQ(read.channels, channels);
    EXPECT_EQ(read.values, Values(values.begin(), values.end()));
  }
}

}  // namespace
}  // namespace glint

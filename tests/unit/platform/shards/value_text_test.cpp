// Values as text: equal bits after reading, and a refusal of any other text.
#include "platform/shards/value_text.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace glint {
namespace {

enum class Colour : std::int8_t { red = -3, green = 7 };

struct Inner {
  std::string name;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

struct Fourteen {
  std::uint64_t large = 0;
  bool yes = false;
  Colour colour = Colour::red;
  float single = 0;
  double first = 0, second = 0, third = 0;
  std::array<std::int64_t, 2> pair{};
  std::vector<Inner> inners;
  std::vector<std::vector<int>> nested;
  std::string text;
  int a = 0, b = 0;
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
};

Fourteen example() {
  Fourteen value;
  value.large = std::numeric_limits<std::uint64_t>::max();
  value.yes = true;
  value.colour = Colour::green;
  value.single = 0.1F;
  value.first = -0.0;
  value.second = std::numeric_limits<double>::denorm_min();
  value.third = -std::numeric_limits<double>::infinity();
  value.pair = {std::numeric_limits<std::int64_t>::min(), 1};
  value.inners = {{"", {0.1, 1.0 / 3, 1e300}}, {"two words\nand a line", {1, 2, 3}}};
  value.nested = {{}, {1, 2}};
  value.text = "7 8";
  value.a = -1;
  value.b = 2;
  value.matrix << 1, 2, 3, std::sqrt(2.0);
  return value;
}

TEST(ValueText, ReadsBackEqualBits) {
  const Fourteen value = example();
  std::string text;
  append_value(value, text);
  Fourteen read;
  ValueReader reader(text, "here");
  reader.read(read);
  reader.end();
  std::string again;
  append_value(read, again);
  EXPECT_EQ(again, text);
  EXPECT_EQ(read.large, value.large);
  EXPECT_TRUE(read.yes);
  EXPECT_EQ(read.colour, Colour::green);
  EXPECT_EQ(read.single, 0.1F);
  EXPECT_TRUE(std::signbit(read.first));
  EXPECT_EQ(read.second, value.second);
  EXPECT_EQ(read.third, value.third);
  EXPECT_EQ(read.inners.at(1).name, value.inners[1].name);
  EXPECT_EQ(read.inners.at(0).place, value.inners[0].place);
  EXPECT_EQ(read.nested, value.nested);
  EXPECT_EQ(read.text, "7 8");
  EXPECT_EQ(read.matrix, value.matrix);
}

TEST(ValueText, KeepsNoNumber) {
  std::string text;
  append_value(std::numeric_limits<double>::quiet_NaN(), text);
  double read = 0;
  ValueReader(text, "here").read(read);
  EXPECT_TRUE(std::isnan(read));
}

TEST(ValueText, RoundTripsRandomBits) {
  std::uint64_t bits = 88172645463325252U;
  for (int i = 0; i < 10'000; ++i) {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    const auto value = std::bit_cast<double>(bits);
    std::string text;
    append_value(value, text);
    double read = 0;
    ValueReader(text, "here").read(read);
    if (std::isnan(value)) continue;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(read), bits) << text;
  }
}

TEST(ValueText, RefusesOtherText) {
  for (const char* text : {"", "x ", "1", "99999999999999999999999999 "}) {
    int value = 0;
    EXPECT_THROW(ValueReader(text, "here").read(value), InputError) << text;
  }
  std::string word;
  EXPECT_THROW(ValueReader("9 short ", "here").read(word), InputError);
  std::vector<int> many;
  EXPECT_THROW(ValueReader("1000000000000 1 ", "here").read(many), InputError);
  int one = 0;
  ValueReader left("1 2 ", "here");
  left.read(one);
  EXPECT_THROW(left.end(), InputError);
}

}  // namespace
}  // namespace glint

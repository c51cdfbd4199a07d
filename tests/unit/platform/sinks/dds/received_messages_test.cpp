// Decoding of hostile messages without a network: arbitrary lengths and counts.
#include "platform/sinks/dds/received_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/unit/platform/sinks/dds/inputs.hpp"

namespace glint {
namespace {

constexpr Duration k_start{1'700'000'000'000'000'000};
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

bool heard(JointText text) {
  ReceivedJoints to;
  return read_message(bytes_of(text.message()), k_start, Time{5}, to);
}

TEST(Heard, TakesJointsByNameWithTheirTime) {
  JointText text({"shoulder", "elbow"}, {0.5, -1.25});
  ReceivedJoints joints;
  ASSERT_TRUE(read_message(bytes_of(text.message()), k_start, Time{5}, joints));
  EXPECT_EQ(joints.count, 2);
  EXPECT_STREQ(joints.names[1].data(), "elbow");
  EXPECT_EQ(joints.positions[1], -1.25);
  EXPECT_EQ(joints.time, Time{5});  // the message has no time stamp
  JointStateMessage stamped = text.message();
  stamped.header.stamp = {1'700'000'001, 250};
  ASSERT_TRUE(read_message(bytes_of(stamped), k_start, Time{5}, joints));
  EXPECT_EQ(joints.time, Time{1'000'000'250});
}

TEST(Heard, RefusesJointsThatAreNotWholeNotFiniteOrTooMany) {
  EXPECT_FALSE(heard({{}, {}}));
  EXPECT_FALSE(heard({{"a", "b"}, {1}}));
  EXPECT_FALSE(heard({{"a"}, {1, 2}}));
  EXPECT_FALSE(heard({{"a"}, {k_nan}}));
  EXPECT_FALSE(heard({{""}, {1}}));
  EXPECT_TRUE(heard({{std::string(63, 'n')}, {1}}));
  EXPECT_FALSE(heard({{std::string(64, 'n')}, {1}}));
  EXPECT_TRUE(heard({std::vector<std::string>(64, "j"), std::vector<double>(64, 0.1)}));
  EXPECT_FALSE(heard({std::vector<std::string>(65, "j"), std::vector<double>(65, 0.1)}));
}

TEST(Heard, TakesAGuessWithARotationOfLengthOne) {
  std::string frame = "hmd_world";
  PoseCovarianceMessage message = guess_message(frame);
  ReceivedInitialPose guess;
  ASSERT_TRUE(read_message(bytes_of(message), k_start, Time{5}, guess));
  EXPECT_STREQ(guess.frame.data(), "hmd_world");
  EXPECT_EQ(guess.pose.translation, Vector3(1, 2, 3));
  EXPECT_NEAR(guess.pose.rotation.z(), 1, 1e-12);
  EXPECT_NEAR(guess.pose.rotation.norm(), 1, 1e-15);
  EXPECT_EQ(guess.covariance(1, 2), 8);
  message.pose.pose.orientation.z = 0;
  EXPECT_FALSE(read_message(bytes_of(message), k_start, Time{5}, guess));
  message = guess_message(frame);
  message.pose.pose.position.y = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(read_message(bytes_of(message), k_start, Time{5}, guess));
  message = guess_message(frame);
  message.pose.covariance[35] = k_nan;
  EXPECT_FALSE(read_message(bytes_of(message), k_start, Time{5}, guess));
  std::string long_name(64, 'f');
  EXPECT_FALSE(read_message(bytes_of(guess_message(long_name)), k_start, Time{5}, guess));
}

TEST(Heard, TakesADescriptionUpToItsLargestSize) {
  std::string text(k_received_description_max, 'u');
  ReceivedDescription heard_text;
  ASSERT_TRUE(read_message(bytes_of(TextMessage{text.data()}), heard_text));
  EXPECT_EQ(heard_text.urdf, text);
  text += 'u';
  EXPECT_FALSE(read_message(bytes_of(TextMessage{text.data()}), heard_text));
  std::string empty;
  EXPECT_FALSE(read_message(bytes_of(TextMessage{empty.data()}), heard_text));
}

// No bytes of another process are trusted: not a length, not a terminating zero.
TEST(Heard, RefusesEveryPartOfAMessage) {
  JointText text({"shoulder", "elbow"}, {0.5, -1.25});
  const auto whole = bytes_of(text.message());
  const std::size_t positions_end = whole.size() - 2 * sizeof(std::uint32_t);  // then empty arrays
  for (std::size_t size = 0; size < positions_end; ++size) {
    ReceivedJoints joints;
    EXPECT_FALSE(read_message(std::span(whole).first(size), k_start, Time{5}, joints)) << size;
  }
  std::string name = "glint";
  auto bytes = bytes_of(TextMessage{name.data()});
  EXPECT_EQ(text_of(bytes), "glint");
  bytes.back() = 'x';
  EXPECT_EQ(text_of(bytes), "");
  bytes.back() = 0;
  bytes[bytes.size() - 3] = 0;
  EXPECT_EQ(text_of(bytes), "");
  bytes[4] = 0xFF;
  EXPECT_EQ(text_of(bytes), "");
}

TEST(Heard, TakesNoOtherByteThanZeroAndOneAsAButton) {
  bool pressed = false;
  for (const int byte : {0, 1, 2, 255}) {
    const std::vector<std::uint8_t> bytes{0, 1, 0, 0, static_cast<std::uint8_t>(byte)};
    EXPECT_EQ(read_message(bytes, pressed), byte <= 1) << byte;
    EXPECT_EQ(pressed, byte == 1) << byte;
  }
  EXPECT_FALSE(read_message(std::vector<std::uint8_t>{0, 1, 0, 0}, pressed));
}

}  // namespace
}  // namespace glint

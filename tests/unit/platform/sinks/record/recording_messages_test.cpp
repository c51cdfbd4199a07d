// Bytes of a single recorded message: as ROS reads it, in older formats, and damaged.
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

// Reads by the CDR rules alone: 4 bytes of encapsulation, then numbers aligned to their size.
struct RosBytes {
  std::vector<std::uint8_t> payload;
  std::size_t at = 4;
  template <class Number>
  Number take() {
    at += (sizeof(Number) - (at - 4) % sizeof(Number)) % sizeof(Number);
    Number value{};
    if (at + sizeof value <= payload.size()) std::memcpy(&value, &payload[at], sizeof value);
    at += sizeof value;
    return value;
  }
  std::string text() {
    const auto length = take<std::uint32_t>();
    if (at + length > payload.size() || length == 0) return "no text";
    const std::string found(reinterpret_cast<const char*>(&payload[at]), length - 1);
    at += length;
    return found;
  }
  Time stamp() {
    const auto seconds = take<std::int32_t>();
    return {seconds * 1'000'000'000LL + take<std::uint32_t>()};
  }
};

// By schema: the last message of each.
std::map<std::string, RosBytes> ros_messages(const std::string& path) {
  std::map<std::string, RosBytes> messages;
  McapReader reader(path);
  while (const auto message = reader.next()) {
    messages[message->schema->name] = {{message->payload.begin(), message->payload.end()}};
  }
  return messages;
}

void expect_pose(RosBytes& bytes, const Pose& pose) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(bytes.take<double>(), pose.translation[axis]);
  for (int part = 0; part < 4; ++part) {
    EXPECT_EQ(bytes.take<double>(), pose.rotation.coeffs()[part]) << part;  // x, y, z, w
  }
}

TEST(Recording, HoldsEachPoseInTheMessagesOfRos) {
  const TemporaryFolder folder;
  RecordingWriter writer(folder.file("run.mcap"), sample_info(RecordingLevel::roi));
  PoseSample sample = sample_output(5);
  sample.tool = 3;
  writer.write_output(sample, record_of(sample));
  ASSERT_TRUE(writer.close().complete());
  auto messages = ros_messages(folder.file("run.mcap"));
  const Time stamp = sample.tick + sample_info(RecordingLevel::roi).unix_offset;
  for (const char* schema :
       {"geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped"}) {
    SCOPED_TRACE(schema);
    ASSERT_EQ(messages.count(schema), 1u);
    RosBytes& bytes = messages[schema];
    EXPECT_EQ(bytes.stamp(), stamp);
    EXPECT_EQ(bytes.text(), frame_name(sample.frame));
    expect_pose(bytes, sample.pose);
  }
  RosBytes& covariance = messages["geometry_msgs/msg/PoseWithCovarianceStamped"];
  for (int i = 0; i < 36; ++i) {
    EXPECT_EQ(covariance.take<double>(), sample.covariance(i / 6, i % 6)) << i;
  }
  RosBytes& transforms = messages["tf2_msgs/msg/TFMessage"];
  EXPECT_EQ(transforms.take<std::uint32_t>(), 1u);
  EXPECT_EQ(transforms.stamp(), stamp);
  EXPECT_EQ(transforms.text(), frame_name(sample.frame));
  EXPECT_NE(transforms.text(), "no text");
  expect_pose(transforms, sample.pose);
}

TEST(Recording, StampsItsOwnMessagesByUnixTime) {
  constexpr Duration offset = milliseconds(1'700'000'000'000);
  constexpr Time time{2'500'000'007};
  PoseSample output = sample_output(5);
  output.tick = time;
  ChoiceRecord choice = sample_choice(1);
  choice.nominal = time;
  HeadPose head = sample_head_pose(1);
  head.time = time;
  RobotFrameRecord robot;
  robot.time = time;
  PenButtonsRecord buttons;
  buttons.time = time;
  ButtonEvent event;
  event.time = time;
  const auto expect_stamp = [&](const char* what, const auto& write) {
    CdrWriter to;
    write(to);
    RosBytes bytes{{to.bytes().begin(), to.bytes().end()}};
    EXPECT_EQ(bytes.stamp(), time + offset) << what;
  };
  expect_stamp("head pose", [&](CdrWriter& to) { write_message(to, head, offset); });
  expect_stamp("choice", [&](CdrWriter& to) { write_message(to, choice, offset); });
  expect_stamp("robot", [&](CdrWriter& to) { write_message(to, robot, offset); });
  expect_stamp("held buttons", [&](CdrWriter& to) { write_message(to, buttons, offset); });
  expect_stamp("button", [&](CdrWriter& to) { write_message(to, event, offset); });
  expect_stamp("output",
               [&](CdrWriter& to) { write_output_message(to, output, record_of(output), offset); });
}

TEST(Recording, ReadsAChoiceOfARecordingMadeBeforeOverrunsWereWritten) {
  ChoiceRecord old = sample_choice(3);
  old.overrun = {};
  CdrWriter writer;
  write_message(writer, old, {});
  const auto read = read_choice(writer.bytes().first(writer.bytes().size() - 1));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(*read, old);
}

TEST(Recording, RefusesAnOverrunThatIsNoneOfItsKinds) {
  CdrWriter writer;
  write_message(writer, sample_choice(3), {});
  EXPECT_TRUE(read_choice(writer.bytes()).has_value());
  EXPECT_FALSE(read_choice(writer.bytes().first(writer.bytes().size() - 1)).has_value());
  ChoiceRecord foreign = sample_choice(3);
  foreign.overrun.kind = static_cast<graph::OverrunKind>(4);
  CdrWriter other;
  write_message(other, foreign, {});
  EXPECT_FALSE(read_choice(other.bytes()).has_value());
}

// The time stamp's standard deviation is the last field; older recordings lack it.
TEST(Recording, ReadsAFrameWithoutItsStampsSigmaButNoneWithAPartOfIt) {
  FrameBuffer buffer = sample_frame(8, 6, 16);
  Frame frame = buffer.view({100}, {200}, 9);
  frame.stamp_sigma = {123'456};
  const FrameLayout layout = whole_frame_layout(frame);
  std::vector<std::uint8_t> pixels(pixel_bytes(layout));
  copy_pixels(frame, layout, pixels);
  CdrWriter writer;
  write_message(writer, FramePatch{layout, pixels}, PixelStorage::in_message, {});
  const auto message = writer.bytes();
  const auto read = read_frame(message, {}, {});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stamp_sigma.nanoseconds, 123'456);
  for (std::size_t missing = 1; missing < 8; ++missing)
    EXPECT_FALSE(read_frame(message.first(message.size() - missing), {}, {})) << missing;
  const auto older = read_frame(message.first(message.size() - 8), {}, {});
  ASSERT_TRUE(older);
  EXPECT_EQ(older->stamp_sigma.nanoseconds, 0);
}

// Older formats lack the last fields: the time stamp's standard deviation, the reason for
// incomplete markers, the fields for a tool's own depth bias, the rotations, the markers' standard
// deviations.
TEST(Recording, ReadsMarkersOfOlderRecordings) {
  CdrWriter writer;
  write_message(writer, sample_markers(3), {});
  // sigmas: one padding byte, count, three floats a marker. turns: count, four padding bytes, six
  // doubles a marker. depths: count, a float and two bytes a marker; the last one without padding.
  const std::size_t sigmas = 1 + 4 + 3 * 3 * 4, turns = 4 + 4 + 3 * 6 * 8, depths = 4 + 2 * 8 + 6;
  // Five padding bytes, then eight.
  const std::size_t stamp = 5 + 8;
  const auto with_stamp = writer.bytes();
  EXPECT_FALSE(read_markers(with_stamp.first(with_stamp.size() - 1)));
  const auto with_incomplete = with_stamp.first(with_stamp.size() - stamp);
  const auto message = with_incomplete.first(with_incomplete.size() - 1);
  const auto complete = read_markers(message);
  ASSERT_TRUE(complete);
  EXPECT_EQ(complete->markers.incomplete, Reason::none);
  const auto all = message.first(message.size() - depths);
  const auto without_depths = read_markers(all);
  ASSERT_TRUE(without_depths);
  EXPECT_EQ(without_depths->markers.items[2].along_y, Vector3(0.0, 0.007, 0.0));
  EXPECT_EQ(without_depths->markers.items[2].peak, 0);
  EXPECT_FALSE(read_markers(message.first(message.size() - 1)));
  const auto without_turns = read_markers(all.first(all.size() - turns));
  ASSERT_TRUE(without_turns);
  EXPECT_EQ(without_turns->markers.items[2].sigma_px[0], 0.25F);
  EXPECT_TRUE(without_turns->markers.items[2].along_y.isZero());
  EXPECT_FALSE(read_markers(all.first(all.size() - turns - 1)));
  const auto read = read_markers(all.first(all.size() - turns - sigmas));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->markers.count, 3);
  EXPECT_EQ(read->markers.items[2].flags, k_marker_annulus_depth);
  EXPECT_EQ(read->markers.items[2].sigma_px[0], 0);
  EXPECT_FALSE(read_markers(all.first(all.size() - 1)));
}

TEST(Recording, RefusesHeldButtonsThatAreNotWholeOrThatThePenHasNot) {
  CdrWriter writer;
  write_message(writer, PenButtonsRecord{1, {2}, 7}, {});
  EXPECT_TRUE(read_pen_buttons(writer.bytes()).has_value());
  EXPECT_FALSE(read_pen_buttons(writer.bytes().first(writer.bytes().size() - 1)).has_value());
  write_message(writer, PenButtonsRecord{1, {2}, 8}, {});
  EXPECT_FALSE(read_pen_buttons(writer.bytes()).has_value());
}

TEST(Recording, RefusesARobotsFrameThatIsNotWholeOrOfNoState) {
  CdrWriter writer;
  RobotFrameRecord frame;
  write_message(writer, frame, {});
  EXPECT_TRUE(read_robot_frame(writer.bytes()).has_value());
  EXPECT_FALSE(read_robot_frame(writer.bytes().first(writer.bytes().size() - 1)).has_value());
  frame.state = static_cast<RegistrationState>(4);
  write_message(writer, frame, {});
  EXPECT_FALSE(read_robot_frame(writer.bytes()).has_value());
}

TEST(Recording, RefusesAButtonThatIsNotInTheList) {
  CdrWriter writer;
  write_message(writer, ButtonEvent{{1}, Button::finish, true}, {});
  EXPECT_TRUE(read_button(writer.bytes()).has_value());
  EXPECT_FALSE(read_button(writer.bytes().first(writer.bytes().size() - 1)).has_value());
  write_message(writer, ButtonEvent{{1}, static_cast<Button>(k_button_count), true}, {});
  EXPECT_FALSE(read_button(writer.bytes()).has_value());
}

}  // namespace
}  // namespace glint

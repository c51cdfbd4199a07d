// Every field of every Glint message type, and truncated messages.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/message_parts.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint::message_fields_test {
namespace {

constexpr Duration k_offset = milliseconds(1'700'000'000'000);
constexpr Time k_time{2'500'000'007};

template <class Message>
Bytes written(const Message& message) {
  CdrWriter to;
  write_message(to, message, k_offset);
  return {to.bytes().begin(), to.bytes().end()};
}

FramePatch patch_of(std::span<const std::uint8_t> pixels) {
  FramePatch patch;
  patch.layout.mid_exposure = k_time;
  patch.layout.width = 7;
  patch.layout.height = 5;
  patch.layout.reflectivity_bits = 8;
  patch.layout.rectangles[0] = {1, 2, 5, 4};
  patch.layout.rectangle_count = 1;
  patch.pixels = pixels;
  return patch;
}

Bytes written_frame() {
  const Bytes pixels{1, 2, 3, 4, 5, 6, 7, 8};
  CdrWriter to;
  write_message(to, patch_of(pixels), PixelStorage::in_message, k_offset);
  return {to.bytes().begin(), to.bytes().end()};
}

Bytes written_output() {
  PoseSample sample = sample_output(5);
  sample.tick = k_time;
  CdrWriter to;
  write_output_message(to, sample, Bytes{9, 8, 7}, k_offset);
  return {to.bytes().begin(), to.bytes().end()};
}

RobotFrameRecord robot_frame() {
  RobotFrameRecord frame;
  frame.version = (std::uint64_t{1} << 40) + 7;
  frame.time = k_time;
  frame.state = RegistrationState::refused;
  frame.T_world_robot = {Quaternion(0.1, 0.2, 0.3, 0.4), Vector3(5, 6, 7)};
  frame.rms_m = 0.25;
  frame.in_reference = true;
  return frame;
}

// One message of each kind with time k_time, and whether the reader accepts given bytes.
struct Kind {
  std::string name, frame;
  Bytes bytes;
  bool (*is_read)(MessageBytes);
};

std::vector<Kind> kinds() {
  HeadPose head = sample_head_pose(1);
  MarkerFrame markers = sample_markers(2);
  ChoiceRecord choice = sample_choice(3);
  head.time = markers.mid_exposure = choice.nominal = k_time;
  const std::string camera(k_camera_frame), world(k_world_frame), robot(k_robot_frame);
  return {
      {"frame", camera, written_frame(),
       [](MessageBytes b) { return read_frame(b, {}, {}).has_value(); }},
      {"head", world, written(head), [](MessageBytes b) { return read_head_pose(b).has_value(); }},
      {"markers", camera, written(markers),
       [](MessageBytes b) { return read_markers(b).has_value(); }},
      {"choice", "", written(choice), [](MessageBytes b) { return read_choice(b).has_value(); }},
      {"output", robot, written_output(),
       [](MessageBytes b) { return read_output(b).has_value(); }},
      {"dropped", camera, written(DroppedInput{{1}, k_time, 3, Reason::frame_late}),
       [](MessageBytes b) { return read_dropped(b).has_value(); }},
      {"robot", world, written(robot_frame()),
       [](MessageBytes b) { return read_robot_frame(b).has_value(); }},
      {"held", "", written(PenButtonsRecord{1, k_time, 5}),
       [](MessageBytes b) { return read_pen_buttons(b).has_value(); }},
      {"button", "", written(ButtonEvent{k_time, Button::finish, true}),
       [](MessageBytes b) { return read_button(b).has_value(); }}};
}

TEST(MessageFields, BeginWithTheUnixTimeAndTheFrameOfTheirKind) {
  for (const Kind& kind : kinds()) {
    CdrReader from(kind.bytes);
    EXPECT_EQ(stamp_of(from), k_time + k_offset) << kind.name;
    EXPECT_EQ(from.get_text(), kind.frame) << kind.name;
    EXPECT_FALSE(from.failed()) << kind.name;
  }
}

// Fields that older recordings lack may be missing, each completely. A replay ignores the bytes
// after an output's record: one padding byte and an 8-byte number.
TEST(MessageFields, AreAllThereOrTheMessageIsRefused) {
  const std::map<std::string, std::size_t> lengths_taken{
      {"frame", 2}, {"markers", 6}, {"output", 10}};
  for (const Kind& kind : kinds()) {
    std::size_t taken = 0;
    for (std::size_t length = 0; length <= kind.bytes.size(); ++length) {
      taken += kind.is_read(MessageBytes(kind.bytes).first(length)) ? 1 : 0;
    }
    EXPECT_TRUE(kind.is_read(kind.bytes)) << kind.name;
    const auto found = lengths_taken.find(kind.name);
    EXPECT_EQ(taken, found == lengths_taken.end() ? 1 : found->second) << kind.name;
  }
}

TEST(MessageFields, FollowTheEncapsulationOfLittleEndianCdr) {
  for (const Kind& kind : kinds()) {
    for (const std::size_t at : {0, 1}) {
      Bytes other = kind.bytes;
      other[at] ^= 1;  // big endian, or another representation
      EXPECT_FALSE(kind.is_read(other)) << kind.name << ' ' << at;
    }
    for (std::size_t length = 0; length < 4; ++length)
      EXPECT_FALSE(kind.is_read(MessageBytes(kind.bytes).first(length))) << kind.name;
  }
}

TEST(MessageFields, OfADroppedInputComeBack) {
  const DroppedInput input{{11}, {22}, 33, Reason::frame_duplicate};
  const DroppedInput back = read_dropped(written(input)).value();
  EXPECT_EQ(back.mid_exposure, input.mid_exposure);
  EXPECT_EQ(back.arrival, input.arrival);
  EXPECT_EQ(back.sequence, input.sequence);
  EXPECT_EQ(back.reason, input.reason);
}

TEST(MessageFields, OfAHeadPoseComeBack) {
  for (const bool valid : {false, true}) {
    HeadPose pose;
    pose.time = {-77};
    pose.valid = valid;
    pose.T_world_camera = {Quaternion(1, 2, 3, 4), Vector3(5, 6, 7)};
    const HeadPose back = read_head_pose(written(pose)).value();
    EXPECT_EQ(back.time, pose.time);
    EXPECT_EQ(back.valid, valid);
    EXPECT_EQ(back.T_world_camera.translation, pose.T_world_camera.translation);
    EXPECT_EQ(back.T_world_camera.rotation.coeffs(), pose.T_world_camera.rotation.coeffs());
  }
}

TEST(MessageFields, OfAChoiceComeBackWithAnyNumberOfVersions) {
  for (std::uint8_t count = 0; count <= k_recorded_versions; ++count) {
    ChoiceRecord choice = sample_choice(9);
    choice.versions = {};
    for (std::size_t i = 0; i < count; ++i) choice.versions[i] = (i + 1) << 33;
    choice.version_count = count;
    const auto back = read_choice(written(choice));
    ASSERT_TRUE(back) << int{count};
    EXPECT_EQ(*back, choice) << int{count};
  }
}

// Fields of glint_msgs/Output in the order of the type; a replay reads only some of them.
TEST(MessageFields, OfAnOutputStandInTheOrderOfTheirType) {
  PoseSample sample = sample_output(5);
  sample.tool = 3;
  sample.state = TrackState::predicted;
  sample.reason = Reason::imprecise;
  sample.tick_number = 11;
  sample.frame_sequence = 12;
  CdrWriter to;
  write_output_message(to, sample, Bytes{9, 8, 7}, k_offset);
  CdrReader from(to.bytes());
  skip_header(from);
  EXPECT_EQ(from.get<std::int64_t>(), sample.tick.nanoseconds);
  EXPECT_EQ(from.get<std::int64_t>(), sample.measurement.nanoseconds);
  EXPECT_EQ(from.get<std::uint32_t>(), 11u);
  EXPECT_EQ(from.get<std::uint32_t>(), 12u);
  EXPECT_EQ(from.get<std::uint8_t>(), 3);
  EXPECT_EQ(from.get<std::uint8_t>(), static_cast<std::uint8_t>(TrackState::predicted));
  EXPECT_EQ(from.get<std::uint8_t>(), static_cast<std::uint8_t>(Reason::imprecise));
  EXPECT_EQ(from.get<std::uint8_t>(), sample.marker_mask);
  EXPECT_DOUBLE_EQ(from.get<double>(), 0.011);
  EXPECT_EQ(from.get<double>(), sample.sigma_position_m);
  EXPECT_EQ(from.get<double>(), sample.sigma_orientation_rad);
  const auto record = from.get_bytes();
  EXPECT_EQ(Bytes(record.begin(), record.end()), (Bytes{9, 8, 7}));
  EXPECT_EQ(from.get<double>(), sample.age_sigma_s);
  EXPECT_FALSE(from.failed());
  EXPECT_TRUE(from.at_end());
  const OutputMessage back = read_output(to.bytes()).value();
  EXPECT_EQ(back.tick, sample.tick);
  EXPECT_EQ(back.tool, 3);
  EXPECT_EQ(back.record, (Bytes{9, 8, 7}));
}

// builtin_interfaces/Time covers 1970 to 2038; times outside are clamped to the range.
TEST(MessageFields, StampAtMostTheTimesThatRosHolds) {
  constexpr std::int64_t k_last = 0x7FFFFFFF * 1'000'000'000LL + 999'999'999;
  for (const auto& [time, expected] :
       std::map<std::int64_t, std::int64_t>{{INT64_MIN, 0},
                                            {-1, 0},
                                            {0, 0},
                                            {1, 1},
                                            {1'999'999'999, 1'999'999'999},
                                            {k_last - 1, k_last - 1},
                                            {k_last, k_last},
                                            {k_last + 1, k_last},
                                            {INT64_MAX, k_last}}) {
    CdrWriter to;
    put_header(to, Time{time}, "a frame");
    CdrReader from(to.bytes());
    EXPECT_EQ(stamp_of(from).nanoseconds, expected) << time;
    EXPECT_EQ(from.get_text(), "a frame");
    EXPECT_TRUE(from.at_end());
  }
}

TEST(MessageFields, NameTheFrameOfThePose) {
  EXPECT_EQ(frame_name(ReferenceFrame::camera), k_camera_frame);
  EXPECT_EQ(frame_name(ReferenceFrame::world), k_world_frame);
  EXPECT_EQ(frame_name(ReferenceFrame::robot), k_robot_frame);
  EXPECT_EQ(frame_name(static_cast<ReferenceFrame>(3)), k_camera_frame);
}

}  // namespace
}  // namespace glint::message_fields_test

// A recording as other programs read it: topics, types, times, images and type definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/message_parts.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "platform/sinks/record/schemas.hpp"
#include "platform/sinks/record/topics.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint::recording_topics_test {
namespace {

struct Seen {
  std::string topic, type;
  std::uint64_t time = 0;
  Bytes payload;
};

// In file order. Checks the fields that all messages share.
std::vector<Seen> seen_in(const std::string& path) {
  McapReader reader(path);
  std::vector<Seen> all;
  while (const auto message = reader.next()) {
    EXPECT_EQ(message->channel->encoding, "cdr");
    EXPECT_EQ(message->channel->metadata, (McapTexts{{"offered_qos_profiles", ""}}));
    EXPECT_EQ(message->schema->encoding, "ros2msg");
    EXPECT_EQ(message->schema->text, schema_text(message->schema->name));
    EXPECT_EQ(message->heading.sequence, all.size()) << "numbered across all topics";
    EXPECT_EQ(message->heading.publish_time, message->heading.log_time);
    all.push_back({message->channel->topic,
                   message->schema->name,
                   message->heading.log_time,
                   {message->payload.begin(), message->payload.end()}});
  }
  return all;
}

void write_frame(RecordingWriter& writer, const FrameBuffer& buffer, const FrameLayout& layout) {
  std::vector<std::uint8_t> pixels(pixel_bytes(layout));
  copy_pixels(buffer.view({}, {}, 0), layout, pixels);
  writer.write_frame({layout, pixels});
}

FrameLayout full_layout(const FrameBuffer& buffer) {
  return whole_frame_layout(buffer.view({100}, {200}, 9));
}

// One message of each kind, each with a different time.
void write_one_of_each(const std::string& path, RecordingLevel level) {
  RecordingWriter writer(path, sample_info(level));
  const FrameBuffer buffer = sample_frame(8, 6, 16);
  write_frame(writer, buffer, full_layout(buffer));
  writer.write_markers(sample_markers(1));
  writer.write_head_pose(sample_head_pose(1));
  writer.write_choice(sample_choice(2));
  writer.write_dropped({{1}, {300}, 3, Reason::frame_late});
  writer.write_robot_frame({1, {400}, RegistrationState::given, {}, 0, false});
  writer.write_pen_buttons({1, {500}, 1});
  writer.write_button({{600}, Button::draw, true});
  PoseSample sample = sample_output(7);
  sample.tool = 1;
  writer.write_output(sample, {});
  EXPECT_TRUE(writer.close().complete());
}

TEST(RecordingTopics, HoldEachKindByItsTypeAtItsOwnTime) {
  const std::uint64_t tick = 7 * 4'000'000;
  const std::vector<Seen> all{
      {"/glint/reflectivity", "sensor_msgs/msg/Image", 200, {}},
      {"/glint/depth", "sensor_msgs/msg/Image", 200, {}},
      {"/glint/frame", "glint_msgs/msg/FramePatch", 200, {}},
      {"/glint/blobs", "glint_msgs/msg/Markers", 9'000'000, {}},
      {"/glint/head_pose", "glint_msgs/msg/HeadPose", 1001, {}},
      {"/glint/choice", "glint_msgs/msg/Choice", 8'000'000, {}},
      {"/glint/dropped", "glint_msgs/msg/Dropped", 300, {}},
      {"/glint/robot_frame", "glint_msgs/msg/RobotFrame", 400, {}},
      {"/glint/pen_buttons", "glint_msgs/msg/PenButtons", 500, {}},
      {"/glint/button", "glint_msgs/msg/Button", 600, {}},
      {"/glint/output", "glint_msgs/msg/Output", tick, {}},
      {"/glint/second_pen/pose", "geometry_msgs/msg/PoseStamped", tick, {}},
      {"/glint/second_pen/pose_cov", "geometry_msgs/msg/PoseWithCovarianceStamped", tick, {}},
      {"/tf", "tf2_msgs/msg/TFMessage", tick, {}}};
  const std::map<RecordingLevel, std::set<std::string>> left_out{
      {RecordingLevel::full, {"/glint/blobs"}},
      {RecordingLevel::roi, {"/glint/blobs", "/glint/reflectivity", "/glint/depth"}},
      {RecordingLevel::blobs, {"/glint/frame", "/glint/reflectivity", "/glint/depth"}},
      {RecordingLevel::outputs,
       {"/glint/blobs", "/glint/frame", "/glint/reflectivity", "/glint/depth", "/glint/head_pose",
        "/glint/choice", "/glint/dropped", "/glint/robot_frame", "/glint/pen_buttons"}}};
  for (const auto& [level, without] : left_out) {
    SCOPED_TRACE(name_of(level));
    const TemporaryFolder folder;
    write_one_of_each(folder.file("run.mcap"), level);
    const std::vector<Seen> seen = seen_in(folder.file("run.mcap"));
    std::size_t at = 0;
    for (const Seen& expected : all) {
      if (without.contains(expected.topic)) continue;
      ASSERT_LT(at, seen.size()) << expected.topic;
      EXPECT_EQ(seen[at].topic, expected.topic);
      EXPECT_EQ(seen[at].type, expected.type);
      EXPECT_EQ(seen[at].time, expected.time + 1'700'000'000'000'000'123) << expected.topic;
      ++at;
    }
    EXPECT_EQ(at, seen.size());
  }
}

TEST(RecordingTopics, AreThoseOfTheToolsByName) {
  const TemporaryFolder folder;
  {
    RecordingWriter writer(folder.file("run.mcap"), sample_info(RecordingLevel::outputs));
    for (const std::uint8_t tool : {4, 0, 1}) {  // one index beyond the names
      PoseSample sample = sample_output(1);
      sample.tool = tool;
      writer.write_output(sample, {});
    }
  }
  const std::vector<Seen> seen = seen_in(folder.file("run.mcap"));
  ASSERT_EQ(seen.size(), 12u);
  const std::string poses[] = {"/glint/tool4/pose", "/glint/pen_pose", "/glint/second_pen/pose"};
  const std::string tips[] = {"glint_tool4_tip", "glint_pen_tip", "glint_second_pen_tip"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(seen[4 * i + 1].topic, poses[i]);
    EXPECT_EQ(seen[4 * i + 2].topic, poses[i] + "_cov");
    CdrReader transform(seen[4 * i + 3].payload);
    EXPECT_EQ(transform.get<std::uint32_t>(), 1u);
    skip_header(transform);
    EXPECT_EQ(transform.get_text(), tips[i]);
  }
}

TEST(RecordingTopics, KeepLettersDigitsAndUnderscoresOfAToolsName) {
  for (int c = 1; c < 256; ++c) {
    const std::string one(1, static_cast<char>(c));
    const bool kept = c < 128 && (std::isalnum(c) != 0 || c == '_');
    EXPECT_EQ(topic_name({"a" + one}, 0), "a" + (kept ? one : "_")) << c;
  }
  EXPECT_EQ(topic_name({"pen", ""}, 1), "tool1");
  EXPECT_EQ(topic_name({"pen", ""}, 2), "tool2");
  EXPECT_EQ(topic_name({}, 0), "tool0");
}

// A time before 1970 is clamped to 1970.
TEST(RecordingTopics, HaveNoTimeBefore1970) {
  for (const std::int64_t offset : {-1000, -200, -199, 0, 50}) {
    const TemporaryFolder folder;
    const std::string path = folder.file("run.mcap");
    RecordingInfo info = sample_info(RecordingLevel::outputs);
    info.unix_offset = {offset};
    {
      RecordingWriter writer(path, info);
      writer.write_button({{200}, Button::draw, true});
    }
    McapReader reader(path);
    EXPECT_EQ(static_cast<std::int64_t>(reader.next().value().heading.log_time),
              std::max<std::int64_t>(0, 200 + offset));
    ASSERT_EQ(reader.attachments().size(), 2u);
    for (const McapAttachmentIndex& attachment : reader.attachments()) {
      EXPECT_EQ(static_cast<std::int64_t>(attachment.log_time), std::max<std::int64_t>(0, offset));
      EXPECT_EQ(attachment.create_time, attachment.log_time);
    }
    EXPECT_EQ(reader.metadata().at("glint"),
              (McapTexts{{"build", "abc"},
                         {"compiler", "g++ 12"},
                         {"format", "1"},
                         {"level", "outputs"},
                         {"nominal_tick_ns", "4000000"},
                         {"tools", "pen,second pen"},
                         {"unix_offset_ns", std::to_string(offset)}}));
  }
}

TEST(RecordingTopics, ShowAWholeFrameAsImagesOfThePlanesThatItHas) {
  for (const int bits : {8, 16}) {
    for (const bool has_depth : {false, true}) {
      FrameBuffer buffer = sample_frame(8, 6, bits);
      if (!has_depth) buffer.depth.clear();
      const TemporaryFolder folder;
      {
        RecordingWriter writer(folder.file("run.mcap"), sample_info(RecordingLevel::full));
        write_frame(writer, buffer, full_layout(buffer));
      }
      const std::vector<Seen> seen = seen_in(folder.file("run.mcap"));
      ASSERT_EQ(seen.size(), has_depth ? 3u : 2u);
      for (std::size_t i = 0; i + 1 < seen.size(); ++i) {
        CdrReader image(seen[i].payload);
        EXPECT_EQ(stamp_of(image).nanoseconds, 1'700'000'000'000'000'223);
        EXPECT_EQ(image.get_text(), k_camera_frame);
        EXPECT_EQ(image.get<std::uint32_t>(), 6u);
        EXPECT_EQ(image.get<std::uint32_t>(), 8u);
        const std::string bright = bits == 8 ? "mono8" : "mono16";
        EXPECT_EQ(image.get_text(), i == 0 ? bright : "16UC1");
        EXPECT_EQ(image.get<std::uint8_t>(), 0) << "little endian";
        EXPECT_EQ(image.get<std::uint32_t>(), i == 0 && bits == 8 ? 8u : 16u);
        EXPECT_EQ(image.get_bytes().size(), i == 0 && bits == 8 ? 48u : 96u);
        EXPECT_TRUE(image.at_end() && !image.failed());
      }
    }
  }
}

// Images show full frames only; a partial frame has its pixels in the message.
TEST(RecordingTopics, ShowNoPartOfAFrameAsAnImage) {
  const FrameBuffer buffer = sample_frame(8, 6, 16);
  const Roi parts[] = {{1, 0, 8, 6}, {0, 1, 8, 6}, {0, 0, 7, 6}, {0, 0, 8, 5}};
  const auto messages_of = [&](const FrameLayout& layout) {
    const TemporaryFolder folder;
    {
      RecordingWriter writer(folder.file("run.mcap"), sample_info(RecordingLevel::full));
      write_frame(writer, buffer, layout);
    }
    return seen_in(folder.file("run.mcap")).size();
  };
  FrameLayout layout = full_layout(buffer);
  EXPECT_EQ(messages_of(layout), 3u);
  for (const Roi& part : parts) {
    layout.rectangles[0] = part;
    EXPECT_EQ(messages_of(layout), 1u) << part.x0 << ' ' << part.y0;
  }
  layout = full_layout(buffer);
  layout.rectangles[1] = {0, 0, 1, 1};
  layout.rectangle_count = 2;
  EXPECT_EQ(messages_of(layout), 1u) << "the first of two is whole";
}

// ros2msg convention: the type's fields, then one section for each type in it, each once.
TEST(Schemas, DefineEveryTypeThatTheyNameOnce) {
  for (const char* name :
       {"sensor_msgs/msg/Image", "geometry_msgs/msg/PoseStamped", "tf2_msgs/msg/TFMessage",
        "geometry_msgs/msg/PoseWithCovarianceStamped", "glint_msgs/msg/FramePatch",
        "glint_msgs/msg/HeadPose", "glint_msgs/msg/Markers", "glint_msgs/msg/Choice",
        "glint_msgs/msg/Output", "glint_msgs/msg/Dropped", "glint_msgs/msg/RobotFrame",
        "glint_msgs/msg/PenButtons", "glint_msgs/msg/Button"}) {
    SCOPED_TRACE(name);
    std::istringstream lines(schema_text(name));
    std::multiset<std::string> defined;
    std::set<std::string> named;
    int fields = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line == std::string(80, '=')) {
        EXPECT_GT(fields, 0) << "a type without a field";
        fields = 0;
        std::getline(lines, line);
        ASSERT_TRUE(line.starts_with("MSG: ")) << line;
        defined.insert(line.substr(5));
        continue;
      }
      ++fields;
      const std::string type = line.substr(0, line.find_first_of(" ["));
      if (type.find('/') != std::string::npos) named.insert(type);
    }
    EXPECT_GT(fields, 0);
    EXPECT_EQ(std::vector<std::string>(named.begin(), named.end()),
              std::vector<std::string>(defined.begin(), defined.end()));
    EXPECT_TRUE(named.contains("builtin_interfaces/Time")) << "of the header's stamp";
  }
  EXPECT_EQ(schema_text("geometry_msgs/msg/Point"), "float64 x\nfloat64 y\nfloat64 z\n");
  EXPECT_EQ(schema_text("geometry_msgs/Point"), schema_text("geometry_msgs/msg/Point"));
  EXPECT_THROW((void)schema_text("geometry_msgs/msg/Pint"), std::logic_error);
}

TEST(TextAttachment, HoldsTheBytesOfItsText) {
  const Attachment attachment = text_attachment("cell.toml", "a\nb");
  EXPECT_EQ(attachment.name, "cell.toml");
  EXPECT_EQ(attachment.media_type, "text/plain");
  EXPECT_EQ(attachment.data, (Bytes{'a', '\n', 'b'}));
}

}  // namespace
}  // namespace glint::recording_topics_test

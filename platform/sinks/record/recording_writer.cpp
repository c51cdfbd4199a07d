#include "platform/sinks/record/recording_writer.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "platform/sinks/record/schemas.hpp"
#include "platform/sinks/record/sha256.hpp"
#include "platform/sinks/record/topics.hpp"

namespace glint {
namespace {

// Numbers of channels that only the observer has; those of the file are smaller.
constexpr std::uint16_t k_first_observed_channel = 0x8000;

McapSettings mcap_settings(const RecordingSettings& settings) {
  McapSettings mcap;
  mcap.chunk_bytes = settings.chunk_bytes;
  mcap.chunk_span_ns = static_cast<std::uint64_t>(settings.chunk_span.nanoseconds);
  mcap.sync_period = settings.sync_period;
  return mcap;
}

McapTexts opening_facts(const RecordingInfo& info) {
  McapTexts facts = info.facts;
  facts[k_fact_format] = std::to_string(k_recording_format);
  facts[k_fact_level] = name_of(info.level);
  facts[k_fact_nominal_tick] = std::to_string(info.nominal_tick.nanoseconds);
  facts[k_fact_unix_offset] = std::to_string(info.unix_offset.nanoseconds);
  std::string tools;
  for (const std::string& name : info.tool_names)
    tools.append(tools.empty() ? "" : ",").append(name);
  facts["tools"] = tools;
  return facts;
}

}  // namespace

struct RecordingWriter::Body : DerivedOutput {
  struct ToolChannels {
    std::uint16_t pose = 0, pose_covariance = 0;
    std::string tip_frame;
  };

  Body(const std::string& path, const RecordingInfo& info, const RecordingSettings& settings);

  std::uint16_t channel(std::string_view topic, std::string_view type) {
    const std::string schema = schema_text(type);
    // rosbag2 requires the key; an empty value means the default quality of service.
    const std::uint16_t number = mcap.add_channel(std::string(topic), std::string(type), schema,
                                                  {{"offered_qos_profiles", ""}});
    if (observer != nullptr) observer->add_channel(number, topic, type, schema);
    numbers.emplace(topic, number);
    return number;
  }
  std::uint16_t add_channel(std::string_view topic, std::string_view type,
                            Destination to) override {
    const auto recorded = numbers.find(std::string(topic));
    if (to == Destination::file_and_observer) {
      return recorded != numbers.end() ? recorded->second : channel(topic, type);
    }
    const auto number =
        static_cast<std::uint16_t>(k_first_observed_channel + observed_channels.size());
    observed_channels.push_back(recorded != numbers.end() ? recorded->second : number);
    if (observer != nullptr && recorded == numbers.end()) {
      observer->add_channel(number, topic, type, schema_text(type));
    }
    return number;
  }
  void write(std::uint16_t to, Time time, std::span<const std::uint8_t> message) override {
    const auto log_time =
        static_cast<std::uint64_t>(std::max<std::int64_t>(0, (time + unix_offset).nanoseconds));
    if (to < k_first_observed_channel) {
      mcap.write({to, static_cast<std::uint32_t>(sequence++), log_time, log_time}, message);
      ++offered;
      note_failure();
    } else {
      to = observed_channels[to - std::size_t{k_first_observed_channel}];
    }
    if (observer != nullptr) observer->add_message(to, log_time, message);
  }
  // Writes the message in `cdr`, at that monotonic time.
  void write(std::uint16_t to, Time time) { write(to, time, cdr.bytes()); }
  // Makes the messages that are derived from this one.
  template <class Message>
  void derive(const Message& message) {
    if (derived != nullptr) derived->add(message);
  }
  void note_failure() {
    if (!mcap.failed() || outcome.ended_early) return;
    outcome.ended_early = true;
    outcome.reason = mcap.error();
  }
  void write_images(const FramePatch& patch);
  void write_pose(const PoseSample& sample);
  const ToolChannels& tool(std::size_t number);
  RecordingOutcome close();

  std::string path;
  RecordingLevel level;
  Duration unix_offset;
  std::vector<std::string> tool_names;
  McapWriter mcap;
  MessageObserver* observer;
  DerivedMessages* derived;
  std::map<std::string, std::uint16_t> numbers;  // of the file's channels, by topic
  std::vector<std::uint16_t> observed_channels;  // the observer's number of each of its own
  CdrWriter cdr;
  std::uint64_t sequence = 0;
  std::uint64_t offered = 0;  // messages, written or not
  std::uint16_t frame = 0, reflectivity = 0, depth = 0, head_pose = 0, markers = 0, choice = 0,
                dropped = 0, button = 0, robot_frame = 0, pen_buttons = 0, output = 0,
                transform = 0;
  std::vector<ToolChannels> tools;
  Sha256 output_hash;
  McapTexts closing;
  RecordingOutcome outcome;
  bool closed = false;
};

RecordingWriter::Body::Body(const std::string& file, const RecordingInfo& info,
                            const RecordingSettings& settings)
    : path(file),
      level(info.level),
      unix_offset(info.unix_offset),
      tool_names(info.tool_names),
      mcap(file, "ros2", "glint", mcap_settings(settings)),
      observer(settings.observer),
      derived(settings.derived) {
  if (records_frames(level)) frame = channel(k_frame_topic, "glint_msgs/msg/FramePatch");
  if (level == RecordingLevel::full) {
    reflectivity = channel(k_reflectivity_topic, "sensor_msgs/msg/Image");
    depth = channel(k_depth_topic, "sensor_msgs/msg/Image");
  }
  if (level == RecordingLevel::blobs) markers = channel(k_markers_topic, "glint_msgs/msg/Markers");
  if (records_inputs(level)) {
    head_pose = channel(k_head_pose_topic, "glint_msgs/msg/HeadPose");
    choice = channel(k_choice_topic, "glint_msgs/msg/Choice");
    dropped = channel(k_dropped_topic, "glint_msgs/msg/Dropped");
  }
  output = channel(k_output_topic, "glint_msgs/msg/Output");
  robot_frame = channel(k_robot_frame_topic, "glint_msgs/msg/RobotFrame");
  pen_buttons = channel(k_pen_buttons_topic, "glint_msgs/msg/PenButtons");
  button = channel(k_button_topic, "glint_msgs/msg/Button");
  transform = channel(k_transform_topic, "tf2_msgs/msg/TFMessage");
  for (std::size_t i = 0; i < tool_names.size(); ++i) (void)tool(i);
  if (derived != nullptr) derived->open(*this, unix_offset);

  mcap.add_metadata(k_opening_metadata, opening_facts(info));
  const auto start = static_cast<std::uint64_t>(std::max<std::int64_t>(0, unix_offset.nanoseconds));
  for (const Attachment& attachment : info.attachments)
    mcap.attach(attachment.name, attachment.media_type, start, attachment.data);
  note_failure();
}

const RecordingWriter::Body::ToolChannels& RecordingWriter::Body::tool(std::size_t number) {
  while (tools.size() <= number) {
    const RecordedTopics topics = tool_topics(tool_names, tools.size());
    tools.push_back({channel(topics.pose, "geometry_msgs/msg/PoseStamped"),
                     channel(topics.pose_covariance, "geometry_msgs/msg/PoseWithCovarianceStamped"),
                     topics.tip_frame});
  }
  return tools[number];
}

void RecordingWriter::Body::write_images(const FramePatch& patch) {
  const FrameLayout& layout = patch.layout;
  const Time stamp = layout.mid_exposure + unix_offset;
  const std::size_t bright = reflectivity_bytes(layout, layout.rectangles[0]);
  if (bright > 0) {
    const bool wide = layout.reflectivity_bits == 16;
    const ImageShape shape{layout.width, layout.height, wide ? 2U : 1U, wide ? "mono16" : "mono8"};
    write_image(cdr, stamp, shape, patch.pixels.first(bright));
    write(reflectivity, layout.arrival);
  }
  if (layout.has_depth) {
    write_image(cdr, stamp, {layout.width, layout.height, 2, "16UC1"},
                patch.pixels.subspan(bright));
    write(depth, layout.arrival);
  }
}

void RecordingWriter::Body::write_pose(const PoseSample& sample) {
  const Time stamp = sample.tick + unix_offset;
  const ToolChannels& channels = tool(sample.tool);
  write_pose_stamped(cdr, stamp, sample);
  write(channels.pose, sample.tick);
  write_pose_with_covariance(cdr, stamp, sample);
  write(channels.pose_covariance, sample.tick);
  write_transform(cdr, stamp, frame_name(sample.frame), channels.tip_frame, sample.pose);
  write(transform, sample.tick);
}

RecordingOutcome RecordingWriter::Body::close() {
  if (closed) return outcome;
  closed = true;
  mcap.flush_chunk();
  note_failure();
  if (!outcome.ended_early) outcome.output_sha256 = output_hash.hex();
  outcome.messages = mcap.messages();
  outcome.lost = offered - outcome.messages;
  closing[k_fact_complete] = outcome.complete() ? "true" : "false";
  closing[k_fact_dropped] = std::to_string(outcome.dropped);
  closing[k_fact_ended_early] = outcome.reason;
  closing[k_fact_output_sha256] = outcome.output_sha256;
  if (!mcap.close(k_closing_metadata, closing)) {
    outcome.ended_early = true;
    outcome.output_sha256.clear();
    outcome.reason = mcap.error() + "; the written part stays in " + mcap.part_path();
  }
  outcome.bytes = mcap.bytes();
  return outcome;
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingInfo& info,
                                 RecordingSettings settings)
    : body_(std::make_unique<Body>(path, info, settings)) {}

RecordingWriter::~RecordingWriter() { body_->close(); }

void RecordingWriter::write_frame(const FramePatch& patch) {
  if (!records_frames(body_->level)) return;
  const FrameLayout& layout = patch.layout;
  const Roi& first = layout.rectangles[0];
  const bool whole = layout.rectangle_count == 1 && first.x0 == 0 && first.y0 == 0 &&
                     first.x1 == layout.width && first.y1 == layout.height;
  const bool as_images = whole && body_->level == RecordingLevel::full;
  if (as_images) body_->write_images(patch);
  write_message(body_->cdr, patch, as_images ? PixelStorage::in_images : PixelStorage::in_message,
                body_->unix_offset);
  body_->write(body_->frame, layout.arrival);
  body_->derive(patch);
}

void RecordingWriter::write_head_pose(const HeadPose& pose) {
  if (!records_inputs(body_->level)) return;
  write_message(body_->cdr, pose, body_->unix_offset);
  body_->write(body_->head_pose, pose.time);
  body_->derive(pose);
}

void RecordingWriter::write_markers(const MarkerFrame& frame) {
  if (body_->level != RecordingLevel::blobs) return;
  write_message(body_->cdr, frame, body_->unix_offset);
  body_->write(body_->markers, frame.arrival);
}

void RecordingWriter::write_choice(const ChoiceRecord& choice) {
  if (!records_inputs(body_->level)) return;
  write_message(body_->cdr, choice, body_->unix_offset);
  body_->write(body_->choice, choice.nominal);
}

void RecordingWriter::write_dropped(const DroppedInput& input) {
  if (!records_inputs(body_->level)) return;
  write_message(body_->cdr, input, body_->unix_offset);
  body_->write(body_->dropped, input.arrival);
  body_->derive(input);
}

void RecordingWriter::write_robot_frame(const RobotFrameRecord& frame) {
  if (!records_inputs(body_->level)) return;
  write_message(body_->cdr, frame, body_->unix_offset);
  body_->write(body_->robot_frame, frame.time);
  body_->derive(frame);
}

void RecordingWriter::write_pen_buttons(const PenButtonsRecord& buttons) {
  if (!records_inputs(body_->level)) return;
  write_message(body_->cdr, buttons, body_->unix_offset);
  body_->write(body_->pen_buttons, buttons.time);
}

void RecordingWriter::write_button(const ButtonEvent& event) {
  write_message(body_->cdr, event, body_->unix_offset);
  body_->write(body_->button, event.time);
  body_->derive(event);
}

void RecordingWriter::write_output(const PoseSample& sample, std::span<const std::uint8_t> record) {
  Body& body = *body_;
  body.output_hash.add(record);
  write_output_message(body.cdr, sample, record, body.unix_offset);
  body.write(body.output, sample.tick);
  if (sample.has_pose()) body.write_pose(sample);
  body.derive(sample);
}

void RecordingWriter::count_dropped_offers(std::uint64_t count) { body_->outcome.dropped += count; }

void RecordingWriter::add_closing_fact(const std::string& name, const std::string& value) {
  body_->closing[name] = value;
}

RecordingOutcome RecordingWriter::close() { return body_->close(); }

const RecordingOutcome& RecordingWriter::outcome() const { return body_->outcome; }

std::uint64_t RecordingWriter::messages_lost() const {
  return body_->mcap.failed() ? body_->offered - body_->mcap.messages() : 0;
}

}  // namespace glint

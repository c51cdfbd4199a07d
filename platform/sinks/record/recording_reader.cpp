#include "platform/sinks/record/recording_reader.hpp"

#include <algorithm>
#include <charconv>
#include <variant>

#include "kernels/wire/bits.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sinks/record/topics.hpp"

namespace glint {

struct RecordingReader::Body {
  Body(const std::string& path, const ReadTolerance& tolerance)
      : mcap(path, tolerance.truncated ? McapEnding::optional : McapEnding::required) {
    const auto opening = mcap.metadata().find(k_opening_metadata);
    if (mcap.profile() != "ros2" || opening == mcap.metadata().end())
      refuse("an MCAP file of another program", "a recording of Glint");
    facts = opening->second;
    if (facts[k_fact_format] != std::to_string(k_recording_format))
      refuse("format '" + facts[k_fact_format] + "'",
             "format " + std::to_string(k_recording_format));
    level = recording_level(facts[k_fact_level], path);
    nominal_tick = {number(k_fact_nominal_tick)};
    unix_offset = {number(k_fact_unix_offset)};
    if (const auto end = mcap.metadata().find(k_closing_metadata); end != mcap.metadata().end())
      for (const auto& [name, value] : end->second) facts[name] = value;
    if (facts[k_fact_complete] != "true" && !mcap.is_truncated() && !tolerance.incomplete)
      refuse_incomplete();
  }

  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    mcap.file().refuse(0, found, expected);
  }
  [[noreturn]] void refuse_incomplete() {
    const std::string& why = facts[k_fact_ended_early];
    refuse(why.empty() ? "a recording that lost " + facts[k_fact_dropped] + " messages"
                       : "a recording that ended early (" + why + ")",
           "a complete recording, required for equal output; --allow-incomplete reads the rest");
  }
  std::int64_t number(const char* fact) {
    const std::string& text = facts[fact];
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end)
      refuse("'" + text + "' as " + fact, "a whole number of nanoseconds");
    return value;
  }

  // Extends the recorded low 32 bits of a frame's number.
  void extend_sequence(RecordedMessage& message) {
    const auto extend = [this](auto& item) {
      if constexpr (requires { item.sequence; }) {
        const auto low = static_cast<std::uint32_t>(item.sequence);
        item.sequence = sequence = extended_count(low, sequence);
      }
    };
    std::visit(extend, message);
  }
  // Returns nothing for messages that are not Glint's own.
  std::optional<RecordedMessage> decode(const McapMessage& message);
  std::optional<RecordedMessage> decode_frame(const McapMessage& message);
  template <class T>
  RecordedMessage checked(std::optional<T> read, const McapMessage& message) const {
    if (!read)
      mcap.file().refuse(message.file_offset,
                         "a message on " + message.channel->topic + " that is incomplete",
                         "the fields of its type");
    return RecordedMessage(std::move(*read));
  }

  McapReader mcap;
  std::map<std::string, std::string> facts;
  RecordingLevel level{};
  Duration nominal_tick, unix_offset;
  std::uint64_t sequence = 0;     // of the newest frame
  ImageRows reflectivity, depth;  // the newest; a frame message may refer to them
  std::uint64_t gaps = 0;         // damaged chunks before those images
  std::int64_t frames_without_pixels = 0;
};

// The images of the frame may have been in a damaged chunk.
std::optional<RecordedMessage> RecordingReader::Body::decode_frame(const McapMessage& message) {
  auto frame = read_frame(message.payload, reflectivity, depth);
  if (!frame && gaps > 0) {
    ++frames_without_pixels;
    return std::nullopt;
  }
  return checked(std::move(frame), message);
}

std::optional<RecordedMessage> RecordingReader::Body::decode(const McapMessage& message) {
  const std::string& topic = message.channel->topic;
  const MessageBytes bytes = message.payload;
  if (gaps != mcap.losses().chunks) {
    gaps = mcap.losses().chunks;
    reflectivity = depth = {};
  }
  if (topic == k_reflectivity_topic || topic == k_depth_topic) {
    auto image = read_image(bytes);
    if (!image) return checked(std::optional<HeadPose>(), message);
    (topic == k_depth_topic ? depth : reflectivity) = std::move(*image);
    return std::nullopt;
  }
  if (topic == k_frame_topic) return decode_frame(message);
  if (topic == k_head_pose_topic) return checked(read_head_pose(bytes), message);
  if (topic == k_markers_topic) return checked(read_markers(bytes), message);
  if (topic == k_choice_topic) return checked(read_choice(bytes), message);
  if (topic == k_output_topic) return checked(read_output(bytes), message);
  if (topic == k_dropped_topic) return checked(read_dropped(bytes), message);
  if (topic == k_robot_frame_topic) return checked(read_robot_frame(bytes), message);
  if (topic == k_pen_buttons_topic) return checked(read_pen_buttons(bytes), message);
  if (topic == k_button_topic) return checked(read_button(bytes), message);
  return std::nullopt;
}

RecordingReader::RecordingReader(const std::string& path, ReadTolerance tolerance)
    : body_(std::make_unique<Body>(path, tolerance)) {}
RecordingReader::~RecordingReader() = default;
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;

RecordingLevel RecordingReader::level() const { return body_->level; }
Duration RecordingReader::nominal_tick() const { return body_->nominal_tick; }
Duration RecordingReader::unix_offset() const { return body_->unix_offset; }
const std::map<std::string, std::string>& RecordingReader::facts() const { return body_->facts; }

std::optional<RecordedMessage> RecordingReader::next() {
  while (const auto message = body_->mcap.next()) {
    auto decoded = body_->decode(*message);
    if (!decoded) continue;
    body_->extend_sequence(*decoded);
    return decoded;
  }
  return std::nullopt;
}

std::uint64_t RecordingReader::gaps() const { return body_->mcap.losses().chunks; }

RecordingLosses RecordingReader::losses() const {
  const McapLosses& left_out = body_->mcap.losses();
  RecordingLosses losses;
  const std::string_view of_frames =
      records_frames(body_->level) ? k_frame_topic : k_markers_topic;  // at level outputs neither
  for (const auto& [topic, count] : left_out.messages) {
    losses.messages += static_cast<std::int64_t>(count);
    if (topic == of_frames) losses.frames = static_cast<std::int64_t>(count);
  }
  losses.frames += body_->frames_without_pixels;
  losses.chunks = static_cast<std::int64_t>(left_out.chunks);
  losses.bytes = left_out.bytes;
  losses.at_least = left_out.at_least;
  return losses;
}

std::vector<ButtonEvent> recorded_buttons(const std::string& path, ReadTolerance tolerance) {
  constexpr std::size_t k_events_max = 1 << 20;
  RecordingReader reader(path, tolerance);
  std::vector<ButtonEvent> events;
  while (const auto message = reader.next()) {
    const auto* event = std::get_if<ButtonEvent>(&*message);
    if (event == nullptr) continue;
    if (events.size() == k_events_max) {
      throw InputError(path + ": more than " + std::to_string(k_events_max) +
                       " button events; expected fewer");
    }
    events.push_back(*event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const ButtonEvent& a, const ButtonEvent& b) { return a.time < b.time; });
  return events;
}

std::string text_of(const RecordingLosses& losses) {
  std::string text = losses.at_least ? "at least " : "";
  text += std::to_string(losses.frames) + " frames (" + std::to_string(losses.messages) +
          " messages), " + std::to_string(losses.bytes) + " bytes";
  if (losses.chunks > 0)
    text += ", " + std::to_string(losses.chunks) + " damaged " +
            (losses.chunks == 1 ? "chunk" : "chunks");
  return text;
}

Attachment RecordingReader::attachment(const std::string& name) {
  std::string names;
  for (const McapAttachmentIndex& index : body_->mcap.attachments()) {
    if (index.name == name) return {name, index.media_type, body_->mcap.attachment(index)};
    names.append(names.empty() ? "" : ", ").append(index.name);
  }
  body_->refuse("no attachment '" + name + "'", names.empty() ? "one; it has none" : names);
}

std::vector<std::string> RecordingReader::attachment_names() const {
  std::vector<std::string> names;
  for (const McapAttachmentIndex& index : body_->mcap.attachments()) names.push_back(index.name);
  return names;
}

}  // namespace glint

// Data types of a recording, independent of its file format.
//
//   RecordingWriter (recording_writer.hpp)  writes a recording, from one thread
//   Recorder        (recorder.hpp)          the same through a separate thread; offers never block
//   RecordingReader (recording_reader.hpp)  returns all messages in the order of the offers
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/reason.hpp"
#include "kernels/units.hpp"
#include "platform/formats/frame_buffer.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/sinks/record/choice_record.hpp"
#include "platform/sinks/record/pen_buttons_record.hpp"
#include "platform/sinks/record/robot_frame_record.hpp"

namespace glint {

// Recorded part of each frame. The first three levels replay to the same output records.
enum class RecordingLevel : std::uint8_t { full, roi, blobs, outputs };

[[nodiscard]] std::string_view name_of(RecordingLevel level);
// Throws InputError, which lists the four names; `prefix` is its prefix, e.g. "cell.toml:12".
[[nodiscard]] RecordingLevel recording_level(std::string_view name, const std::string& prefix);

// A file stored in the recording, so that the recording replays without other files.
struct Attachment {
  std::string name;        // "cell.toml", "tools.toml", "rays.npy"
  std::string media_type;  // "application/toml", "application/octet-stream"
  std::vector<std::uint8_t> data;
};

[[nodiscard]] Attachment text_attachment(std::string name, std::string_view text);

struct RecordingInfo {
  RecordingLevel level = RecordingLevel::roi;
  Duration nominal_tick;                     // gap between two ticks
  Duration unix_offset;                      // Time + this = time since 1970 (UTC)
  std::vector<std::string> tool_names;       // by slot; they name topics and frames
  std::map<std::string, std::string> facts;  // build, compiler, host, config_hash, ...
  std::vector<Attachment> attachments;
};

// A rejected input.
struct DroppedInput {
  Time mid_exposure;
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_late, frame_duplicate, frame_invalid
};

// A frame without pixels: its metadata and marker candidates (level blobs).
struct MarkerFrame {
  Time mid_exposure;
  Duration stamp_sigma;
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_invalid: its pixels were unusable
  Markers markers;
};

// A frame as read. Pixels outside the recorded rectangles are 0.
struct FrameMessage {
  Time mid_exposure;
  Duration stamp_sigma;
  Time arrival;
  std::uint64_t sequence = 0;
  FrameBuffer pixels;
  [[nodiscard]] Frame view() const {
    Frame frame = pixels.view(mid_exposure, arrival, sequence);
    frame.stamp_sigma = stamp_sigma;
    return frame;
  }
};

// Output of one tool at one tick: the bytes hashed by output_sha256.
struct OutputMessage {
  Time tick;
  std::uint8_t tool = 0;
  std::vector<std::uint8_t> record;
};

using RecordedMessage =
    std::variant<FrameMessage, HeadPose, MarkerFrame, ChoiceRecord, OutputMessage, DroppedInput,
                 ButtonEvent, RobotFrameRecord, PenButtonsRecord>;

// Result of a closed recording.
struct RecordingOutcome {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;  // offers rejected by a full ring
  std::uint64_t lost = 0;     // messages lost by a failed write
  bool ended_early = false;   // a write failed; the file's content is complete up to there
  std::string reason;         // with path and the system's message
  std::string output_sha256;  // over the records written, lower-case hex
  [[nodiscard]] bool complete() const { return dropped == 0 && !ended_early; }
};

}  // namespace glint

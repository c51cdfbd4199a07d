// The words of a recording: what is in one, beside the bytes of its file.
//
//   RecordingWriter (recording_writer.hpp)  writes one, called by one thread
//   Recorder        (recorder.hpp)          the same behind a thread; offers never block
//   RecordingReader (recording_reader.hpp)  gives everything back in the order of the offers
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
#include "platform/record/button_event.hpp"
#include "platform/record/choice_record.hpp"
#include "platform/record/pen_buttons_record.hpp"
#include "platform/record/robot_frame_record.hpp"
#include "platform/sensors/frame_buffer.hpp"

namespace glint {

// What a recording keeps of each frame. The first three replay to the same output records.
enum class RecordingLevel : std::uint8_t { full, roi, blobs, outputs };

[[nodiscard]] std::string_view name_of(RecordingLevel level);
// Throws InputError, which lists the four names; `place` stands in front, e.g. "cell.toml:12".
[[nodiscard]] RecordingLevel recording_level(std::string_view name, const std::string& place);

// A file kept inside the recording, so that it replays alone.
struct Attachment {
  std::string name;        // "cell.toml", "tools.toml", "rays.npy"
  std::string media_type;  // "application/toml", "application/octet-stream"
  std::vector<std::uint8_t> data;
};

[[nodiscard]] Attachment text_attachment(std::string name, std::string_view text);

struct RecordingInfo {
  RecordingLevel level = RecordingLevel::roi;
  Duration nominal_tick;                     // gap between two ticks
  Duration unix_offset;                      // added to a Time it gives time since 1970 (UTC)
  std::vector<std::string> tool_names;       // by slot; they name topics and frames
  std::map<std::string, std::string> facts;  // build, compiler, host, config_hash, ...
  std::vector<Attachment> attachments;
};

// An input that was refused.
struct DroppedInput {
  Time mid_exposure;
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_late, frame_doubled, frame_invalid
};

// A frame without pixels: its stamp and the candidate markers found in it (level blobs).
struct MarkerFrame {
  Time mid_exposure;
  Duration stamp_sigma;
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_invalid: its pixels were unusable
  Markers markers;
};

// What the reader gives back. Pixels outside the recorded rectangles are 0.
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

// One tool at one tick: the bytes that output_sha256 is taken over.
struct OutputMessage {
  Time tick;
  std::uint8_t tool = 0;
  std::vector<std::uint8_t> record;
};

using RecordedMessage =
    std::variant<FrameMessage, HeadPose, MarkerFrame, ChoiceRecord, OutputMessage, DroppedInput,
                 ButtonEvent, RobotFrameRecord, PenButtonsRecord>;

// How a recording ended.
struct RecordingOutcome {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;  // offers that found no room
  std::uint64_t lost = 0;     // messages that a failed write cost
  bool ended_early = false;   // a write failed; what stands in the file is whole
  std::string reason;         // why, with path and the system's words
  std::string output_sha256;  // over the records written, lower-case hex
  [[nodiscard]] bool complete() const { return dropped == 0 && !ended_early; }
};

}  // namespace glint

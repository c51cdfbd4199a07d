// Serialisation of Glint's own messages (package platform/sinks/dds/glint_msgs).
//
// write_message() starts a message in the writer. A read function returns nothing if the bytes do
// not match the type: too short, a count beyond the maximum, a rectangle outside its frame.
#pragma once

#include <optional>

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint {

enum class PixelStorage : std::uint8_t {
  in_message,  // as rectangles
  in_images,   // in the two preceding sensor_msgs/Image: whole frames, for any viewer
};

// A choice's overrun in one byte: kind + k_overrun_kinds * policy. Version 1 always wrote 0 there,
// and no node at the message's end.
inline constexpr unsigned k_overrun_kinds = 4;

void write_message(CdrWriter& to, const FramePatch& patch, PixelStorage place,
                   Duration unix_offset);
void write_message(CdrWriter& to, const HeadPose& pose, Duration unix_offset);
void write_message(CdrWriter& to, const MarkerFrame& frame, Duration unix_offset);
void write_message(CdrWriter& to, const ChoiceRecord& choice, Duration unix_offset);
void write_message(CdrWriter& to, const DroppedInput& input, Duration unix_offset);
void write_message(CdrWriter& to, const ButtonEvent& event, Duration unix_offset);
void write_message(CdrWriter& to, const RobotFrameRecord& frame, Duration unix_offset);
void write_message(CdrWriter& to, const PenButtonsRecord& buttons, Duration unix_offset);
void write_output_message(CdrWriter& to, const PoseSample& sample,
                          std::span<const std::uint8_t> record, Duration unix_offset);

using MessageBytes = std::span<const std::uint8_t>;

// The pixels of a sensor_msgs/Image: rows without padding.
struct ImageRows {
  std::uint32_t width = 0, height = 0, step = 0;
  Bytes rows;
};

// reflectivity and depth: the newest images, for messages with pixels in_images.
[[nodiscard]] std::optional<FrameMessage> read_frame(MessageBytes bytes,
                                                     const ImageRows& reflectivity,
                                                     const ImageRows& depth);
[[nodiscard]] std::optional<ImageRows> read_image(MessageBytes bytes);
[[nodiscard]] std::optional<HeadPose> read_head_pose(MessageBytes bytes);
[[nodiscard]] std::optional<MarkerFrame> read_markers(MessageBytes bytes);
[[nodiscard]] std::optional<ChoiceRecord> read_choice(MessageBytes bytes);
[[nodiscard]] std::optional<OutputMessage> read_output(MessageBytes bytes);
[[nodiscard]] std::optional<DroppedInput> read_dropped(MessageBytes bytes);
// Returns nothing for an unknown state, too.
[[nodiscard]] std::optional<RobotFrameRecord> read_robot_frame(MessageBytes bytes);
// Returns nothing for bits of unknown buttons, too.
[[nodiscard]] std::optional<PenButtonsRecord> read_pen_buttons(MessageBytes bytes);
// Returns nothing for an unknown button, too.
[[nodiscard]] std::optional<ButtonEvent> read_button(MessageBytes bytes);

}  // namespace glint

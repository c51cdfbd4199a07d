#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {

std::optional<HeadPose> read_head_pose(MessageBytes bytes) {
  CdrReader from(bytes);
  HeadPose pose;
  skip_header(from);
  pose.time.nanoseconds = from.get<std::int64_t>();
  pose.valid = from.get<bool>();
  pose.T_world_camera = get_pose(from);
  if (from.failed()) return std::nullopt;
  return pose;
}

std::optional<MarkerFrame> read_markers(MessageBytes bytes) {
  CdrReader from(bytes);
  MarkerFrame frame;
  skip_header(from);
  get_stamps(from, frame);
  frame.reason = static_cast<Reason>(from.get<std::uint8_t>());
  const auto count = from.get<std::uint32_t>();
  if (from.failed() || count > k_blobs_max) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    marker.ray = get_vector(from);
    marker.surface_range_m = from.get<double>();
    marker.centroid_px.x() = from.get<double>();
    marker.centroid_px.y() = from.get<double>();
    marker.area_px = from.get<std::uint32_t>();
    marker.blob = from.get<std::uint16_t>();
    marker.flags = from.get<std::uint8_t>();
  }
  if (from.failed()) return std::nullopt;
  frame.markers.count = static_cast<int>(count);
  if (from.at_end()) return frame;  // older recordings end here
  if (from.get<std::uint32_t>() != count) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    for (float& sigma : marker.sigma_px) sigma = from.get<float>();
    marker.range_sigma_m = from.get<float>();
  }
  if (from.failed()) return std::nullopt;
  if (from.at_end()) return frame;  // before the rays' derivatives (along_x, along_y) were recorded
  if (from.get<std::uint32_t>() != count) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    marker.along_x = get_vector(from);
    marker.along_y = get_vector(from);
  }
  if (from.failed()) return std::nullopt;
  if (from.at_end()) return frame;  // before the values for a tool's own depth bias
  if (from.get<std::uint32_t>() != count) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    marker.bias_subtracted_m = from.get<float>();
    marker.peak = from.get<std::uint16_t>();
  }
  if (from.failed()) return std::nullopt;
  if (from.at_end()) return frame;  // before the reason of incomplete markers
  frame.markers.incomplete = static_cast<Reason>(from.get<std::uint8_t>());
  if (from.failed() || frame.markers.incomplete > k_last_reason) return std::nullopt;
  if (from.at_end()) return frame;  // before the standard deviation of the time stamp
  frame.stamp_sigma.nanoseconds = from.get<std::int64_t>();
  if (from.failed()) return std::nullopt;
  return frame;
}

std::optional<ChoiceRecord> read_choice(MessageBytes bytes) {
  CdrReader from(bytes);
  ChoiceRecord choice;
  skip_header(from);
  choice.nominal.nanoseconds = from.get<std::int64_t>();
  choice.activation = from.get<std::uint64_t>();
  choice.group = from.get<std::uint8_t>();
  const auto overrun = from.get<std::uint8_t>();
  choice.unix_offset_ns = from.get<std::int64_t>();
  const auto count = from.get<std::uint32_t>();
  if (from.failed() || count > k_recorded_versions) return std::nullopt;
  choice.version_count = static_cast<std::uint8_t>(count);
  for (std::uint32_t i = 0; i < count; ++i) choice.versions[i] = from.get<std::uint64_t>();
  if (from.failed()) return std::nullopt;
  if (overrun == 0) return choice;  // older recordings end here
  const unsigned kind = overrun % k_overrun_kinds;
  const unsigned policy = overrun / k_overrun_kinds;
  choice.overrun = {static_cast<graph::OverrunKind>(kind),
                    static_cast<graph::OverrunPolicy>(policy), from.get<std::uint8_t>()};
  if (from.failed() || kind < 1 ||
      policy > static_cast<unsigned>(graph::OverrunPolicy::stop_safe)) {
    return std::nullopt;
  }
  return choice;
}

std::optional<OutputMessage> read_output(MessageBytes bytes) {
  CdrReader from(bytes);
  OutputMessage output;
  skip_header(from);
  output.tick.nanoseconds = from.get<std::int64_t>();
  (void)from.get<std::int64_t>();   // measurement
  (void)from.get<std::uint32_t>();  // tick number
  (void)from.get<std::uint32_t>();  // frame sequence
  output.tool = from.get<std::uint8_t>();
  for (int i = 0; i < 3; ++i) (void)from.get<std::uint8_t>();  // state, reason, marker mask
  for (int i = 0; i < 3; ++i) (void)from.get<double>();        // age, sigmas
  const auto record = from.get_bytes();
  if (from.failed()) return std::nullopt;
  output.record.assign(record.begin(), record.end());
  return output;
}

std::optional<DroppedInput> read_dropped(MessageBytes bytes) {
  CdrReader from(bytes);
  DroppedInput input;
  skip_header(from);
  get_stamps(from, input);
  input.reason = static_cast<Reason>(from.get<std::uint8_t>());
  if (from.failed()) return std::nullopt;
  return input;
}

std::optional<RobotFrameRecord> read_robot_frame(MessageBytes bytes) {
  CdrReader from(bytes);
  skip_header(from);
  RobotFrameRecord frame;
  frame.version = from.get<std::uint64_t>();
  frame.time.nanoseconds = from.get<std::int64_t>();
  const auto state = from.get<std::uint8_t>();
  frame.in_reference = from.get<bool>();
  frame.rms_m = from.get<double>();
  frame.T_world_robot = get_pose(from);
  if (from.failed() || state > static_cast<std::uint8_t>(RegistrationState::refused)) {
    return std::nullopt;
  }
  frame.state = static_cast<RegistrationState>(state);
  return frame;
}

std::optional<PenButtonsRecord> read_pen_buttons(MessageBytes bytes) {
  CdrReader from(bytes);
  skip_header(from);
  PenButtonsRecord buttons;
  buttons.version = from.get<std::uint64_t>();
  buttons.time.nanoseconds = from.get<std::int64_t>();
  buttons.held = from.get<std::uint8_t>();
  if (from.failed() || buttons.held > k_buttons_mask) return std::nullopt;
  return buttons;
}

std::optional<ButtonEvent> read_button(MessageBytes bytes) {
  CdrReader from(bytes);
  skip_header(from);
  ButtonEvent event;
  event.time.nanoseconds = from.get<std::int64_t>();
  const auto button = from.get<std::uint8_t>();
  event.pressed = from.get<bool>();
  if (from.failed() || button >= k_button_count) return std::nullopt;
  event.button = static_cast<Button>(button);
  return event;
}

}  // namespace glint

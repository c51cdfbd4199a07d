#include <cstring>

#include "platform/record/glint_messages.hpp"

namespace glint {
namespace {

void skip_header(CdrReader& from) {
  (void)from.get<std::int32_t>();
  (void)from.get<std::uint32_t>();
  (void)from.get_text();
}

template <class Stamped>
void get_stamps(CdrReader& from, Stamped& frame) {
  frame.mid_exposure.nanoseconds = from.get<std::int64_t>();
  frame.arrival.nanoseconds = from.get<std::int64_t>();
  frame.sequence = from.get<std::uint32_t>();
}

Vector3 get_vector(CdrReader& from) {
  Vector3 vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = from.get<double>();
  return vector;
}

Pose get_pose(CdrReader& from) {
  Pose pose;
  pose.translation = get_vector(from);
  for (int i = 0; i < 4; ++i) pose.rotation.coeffs()[i] = from.get<double>();  // x, y, z, w
  return pose;
}

// One rectangle's rows into the frame; false where their number of bytes is not the rectangle's.
template <class Pixel>
bool put_rows(std::span<const std::uint8_t> rows, const Roi& roi, int frame_width,
              std::vector<Pixel>& frame) {
  const auto row_bytes = static_cast<std::size_t>(roi.x1 - roi.x0) * sizeof(Pixel);
  if (rows.size() != row_bytes * static_cast<std::size_t>(roi.y1 - roi.y0)) return false;
  if (row_bytes == 0) return true;
  const std::uint8_t* from = rows.data();
  for (int y = roi.y0; y < roi.y1; ++y, from += row_bytes)
    std::memcpy(frame.data() + static_cast<std::ptrdiff_t>(y) * frame_width + roi.x0, from,
                row_bytes);
  return true;
}

constexpr std::size_t k_pixels_max = std::size_t{1} << 24;  // 4096 x 4096

struct FrameShape {
  int width = 0, height = 0, reflectivity_bits = 0;
  bool has_depth = false;
};

bool put_rectangle(std::span<const std::uint8_t> reflectivity, std::span<const std::uint8_t> depth,
                   const Roi& roi, const FrameShape& shape, FrameBuffer& frame) {
  if (roi.x1 > shape.width || roi.y1 > shape.height) return false;
  const bool bright = shape.reflectivity_bits == 8
                          ? put_rows(reflectivity, roi, shape.width, frame.reflectivity_8)
                      : shape.reflectivity_bits == 16
                          ? put_rows(reflectivity, roi, shape.width, frame.reflectivity_16)
                          : reflectivity.empty();
  return bright &&
         (shape.has_depth ? put_rows(depth, roi, shape.width, frame.depth) : depth.empty());
}

}  // namespace

std::optional<FrameMessage> read_frame(MessageBytes bytes, const ImageRows& reflectivity,
                                       const ImageRows& depth) {
  CdrReader from(bytes);
  FrameMessage frame;
  skip_header(from);
  get_stamps(from, frame);
  FrameShape shape;
  shape.width = from.get<std::uint16_t>();
  shape.height = from.get<std::uint16_t>();
  shape.reflectivity_bits = from.get<std::uint8_t>();
  shape.has_depth = from.get<bool>();
  const bool in_images = from.get<bool>();
  const auto count = from.get<std::uint32_t>();
  if (from.failed() || count > k_patch_rectangles_max) return std::nullopt;
  const auto pixels =
      static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height);
  if (pixels > k_pixels_max) return std::nullopt;
  frame.pixels.width = shape.width;
  frame.pixels.height = shape.height;
  if (shape.reflectivity_bits == 8) frame.pixels.reflectivity_8.resize(pixels);
  if (shape.reflectivity_bits == 16) frame.pixels.reflectivity_16.resize(pixels);
  if (shape.has_depth) frame.pixels.depth.resize(pixels);
  for (std::uint32_t i = 0; i < count; ++i) {
    Roi roi;
    roi.x0 = from.get<std::uint16_t>();
    roi.y0 = from.get<std::uint16_t>();
    roi.x1 = roi.x0 + from.get<std::uint16_t>();
    roi.y1 = roi.y0 + from.get<std::uint16_t>();
    const auto bright = from.get_bytes();
    const auto far = from.get_bytes();
    if (from.failed() || !put_rectangle(bright, far, roi, shape, frame.pixels)) return std::nullopt;
  }
  if (in_images) {
    const Roi all{0, 0, shape.width, shape.height};
    const auto far = shape.has_depth ? std::span(depth.rows) : std::span<const std::uint8_t>();
    if (!put_rectangle(reflectivity.rows, far, all, shape, frame.pixels)) return std::nullopt;
  }
  return frame;
}

std::optional<ImageRows> read_image(MessageBytes bytes) {
  CdrReader from(bytes);
  ImageRows image;
  skip_header(from);
  image.height = from.get<std::uint32_t>();
  image.width = from.get<std::uint32_t>();
  (void)from.get_text();
  (void)from.get<std::uint8_t>();
  image.step = from.get<std::uint32_t>();
  const auto rows = from.get_bytes();
  if (from.failed() || rows.size() != std::uint64_t{image.step} * image.height) return std::nullopt;
  image.rows.assign(rows.begin(), rows.end());
  return image;
}

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
  if (from.at_end()) return frame;  // so do those from before the rays' turns
  if (from.get<std::uint32_t>() != count) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    marker.along_x = get_vector(from);
    marker.along_y = get_vector(from);
  }
  if (from.failed()) return std::nullopt;
  if (from.at_end()) return frame;  // and from before what a tool's own depth bias needs
  if (from.get<std::uint32_t>() != count) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[i];
    marker.bias_taken_m = from.get<float>();
    marker.peak = from.get<std::uint16_t>();
  }
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
  if (from.failed() || kind < 1 || kind > static_cast<unsigned>(graph::OverrunKind::missed) ||
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

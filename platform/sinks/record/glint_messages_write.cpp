#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/ros_messages.hpp"

namespace glint {
namespace {

template <class Stamped>
void put_stamps(CdrWriter& to, const Stamped& frame) {
  to.put(frame.mid_exposure.nanoseconds);
  to.put(frame.arrival.nanoseconds);
  to.put(static_cast<std::uint32_t>(frame.sequence));  // low 32 bits: see extended_count()
}

}  // namespace

void write_message(CdrWriter& to, const FramePatch& patch, PixelStorage place,
                   Duration unix_offset) {
  const FrameLayout& layout = patch.layout;
  to.begin();
  put_header(to, layout.mid_exposure + unix_offset, k_camera_frame);
  put_stamps(to, layout);
  to.put(layout.width);
  to.put(layout.height);
  to.put(layout.reflectivity_bits);
  to.put(layout.has_depth);
  to.put(place == PixelStorage::in_images);
  const int count = place == PixelStorage::in_images ? 0 : layout.rectangle_count;
  to.put_length(static_cast<std::size_t>(count));
  std::size_t at = 0;
  for (int i = 0; i < count; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    to.put(static_cast<std::uint16_t>(roi.x0));
    to.put(static_cast<std::uint16_t>(roi.y0));
    to.put(static_cast<std::uint16_t>(roi.x1 - roi.x0));
    to.put(static_cast<std::uint16_t>(roi.y1 - roi.y0));
    const std::size_t reflectivity = reflectivity_bytes(layout, roi);
    const std::size_t depth = depth_bytes(layout, roi);
    to.put_bytes(patch.pixels.subspan(at, reflectivity));
    to.put_bytes(patch.pixels.subspan(at + reflectivity, depth));
    at += reflectivity + depth;
  }
  to.put(layout.stamp_sigma.nanoseconds);
}

void write_message(CdrWriter& to, const HeadPose& pose, Duration unix_offset) {
  to.begin();
  put_header(to, pose.time + unix_offset, k_world_frame);
  to.put(pose.time.nanoseconds);
  to.put(pose.valid);
  put_pose(to, pose.T_world_camera);
}

void write_message(CdrWriter& to, const MarkerFrame& frame, Duration unix_offset) {
  to.begin();
  put_header(to, frame.mid_exposure + unix_offset, k_camera_frame);
  put_stamps(to, frame);
  to.put(static_cast<std::uint8_t>(frame.reason));
  to.put_length(static_cast<std::size_t>(frame.markers.count));
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    put_vector(to, marker.ray);
    to.put(marker.surface_range_m);
    to.put(marker.centroid_px.x());
    to.put(marker.centroid_px.y());
    to.put(marker.area_px);
    to.put(marker.blob);
    to.put(marker.flags);
  }
  to.put_length(static_cast<std::size_t>(frame.markers.count));
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    for (const float sigma : marker.sigma_px) to.put(sigma);
    to.put(marker.range_sigma_m);
  }
  to.put_length(static_cast<std::size_t>(frame.markers.count));
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    put_vector(to, marker.along_x);
    put_vector(to, marker.along_y);
  }
  to.put_length(static_cast<std::size_t>(frame.markers.count));
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    to.put(marker.bias_subtracted_m);
    to.put(marker.peak);
  }
  to.put(static_cast<std::uint8_t>(frame.markers.incomplete));
  to.put(frame.stamp_sigma.nanoseconds);
}

void write_message(CdrWriter& to, const ChoiceRecord& choice, Duration unix_offset) {
  to.begin();
  put_header(to, choice.nominal + unix_offset, "");
  to.put(choice.nominal.nanoseconds);
  to.put(choice.activation);
  to.put(choice.group);
  const graph::OverrunDecision& overrun = choice.overrun;
  to.put(static_cast<std::uint8_t>(static_cast<unsigned>(overrun.kind) +
                                   k_overrun_kinds * static_cast<unsigned>(overrun.policy)));
  to.put(choice.unix_offset_ns);
  to.put_length(choice.version_count);
  for (std::size_t i = 0; i < choice.version_count; ++i) to.put(choice.versions[i]);
  to.put(overrun.after_node);
}

void write_message(CdrWriter& to, const DroppedInput& input, Duration unix_offset) {
  to.begin();
  put_header(to, input.arrival + unix_offset, k_camera_frame);
  put_stamps(to, input);
  to.put(static_cast<std::uint8_t>(input.reason));
}

void write_message(CdrWriter& to, const RobotFrameRecord& frame, Duration unix_offset) {
  to.begin();
  put_header(to, frame.time + unix_offset, k_world_frame);
  to.put(frame.version);
  to.put(frame.time.nanoseconds);
  to.put(static_cast<std::uint8_t>(frame.state));
  to.put(frame.in_reference);
  to.put(frame.rms_m);
  put_pose(to, frame.T_world_robot);
}

void write_message(CdrWriter& to, const PenButtonsRecord& buttons, Duration unix_offset) {
  to.begin();
  put_header(to, buttons.time + unix_offset, "");
  to.put(buttons.version);
  to.put(buttons.time.nanoseconds);
  to.put(buttons.held);
}

void write_message(CdrWriter& to, const ButtonEvent& event, Duration unix_offset) {
  to.begin();
  put_header(to, event.time + unix_offset, "");
  to.put(event.time.nanoseconds);
  to.put(static_cast<std::uint8_t>(event.button));
  to.put(event.pressed);
}

void write_output_message(CdrWriter& to, const PoseSample& sample,
                          std::span<const std::uint8_t> record, Duration unix_offset) {
  to.begin();
  put_header(to, sample.tick + unix_offset, frame_name(sample.frame));
  to.put(sample.tick.nanoseconds);
  to.put(sample.measurement.nanoseconds);
  to.put(static_cast<std::uint32_t>(sample.tick_number));
  to.put(static_cast<std::uint32_t>(sample.frame_sequence));
  to.put(sample.tool);
  to.put(static_cast<std::uint8_t>(sample.state));
  to.put(static_cast<std::uint8_t>(sample.reason));
  to.put(sample.marker_mask);
  to.put(sample.age().seconds());
  to.put(sample.sigma_position_m);
  to.put(sample.sigma_orientation_rad);
  to.put_bytes(record);
  to.put(sample.age_sigma_s);
}

}  // namespace glint

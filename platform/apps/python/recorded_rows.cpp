#include "platform/apps/python/recorded_rows.hpp"

#include "kernels/wire/output_record.hpp"
#include "platform/input_error.hpp"

namespace glint::python {

TickPoseRow row_of(const OutputMessage& message, const std::string& path) {
  const Result<PoseSample> decoded = decode(message.record);
  if (!decoded) {
    throw InputError(path + ": output record of tick " + std::to_string(message.tick.nanoseconds) +
                     " ns: " + std::string(name_of(decoded.reason)) +
                     "; expected an output record of layout 1 or 2");
  }
  const PoseSample& sample = decoded.value;
  TickPoseRow row{};
  row.time_ns = sample.tick.nanoseconds;
  row.measurement_ns = sample.measurement.nanoseconds;
  row.tick = static_cast<std::uint32_t>(sample.tick_number);
  row.sequence = static_cast<std::uint32_t>(sample.frame_sequence);
  row.tool = sample.tool;
  row.state = static_cast<std::uint8_t>(sample.state);
  row.reason = static_cast<std::uint8_t>(sample.reason);
  row.registration = static_cast<std::uint8_t>(sample.registration);
  row.frame = static_cast<std::uint8_t>(sample.frame);
  row.marker_mask = sample.marker_mask;
  row.buttons = sample.buttons;
  row.registration_rms_m = sample.registration_rms_m;
  if (sample.has_pose()) {
    put(row.position_m, sample.pose.translation);
    put(row.orientation_xyzw, sample.pose.rotation);
    put(row.velocity_m_s, sample.velocity_m_s);
    put(row.angular_velocity_rad_s, sample.angular_velocity_rad_s);
    put(row.covariance, sample.covariance);
    put(row.systematic, sample.systematic);
    row.sigma_position_m = sample.sigma_position_m;
    row.sigma_orientation_rad = sample.sigma_orientation_rad;
    return row;
  }
  put_nothing(row.position_m);
  put_nothing(row.orientation_xyzw);
  put_nothing(row.velocity_m_s);
  put_nothing(row.angular_velocity_rad_s);
  put_nothing(row.covariance);
  put_nothing(row.systematic);
  row.sigma_position_m = row.sigma_orientation_rad = k_nan;
  return row;
}

std::vector<BlobRow> rows_of(const MarkerFrame& frame) {
  std::vector<BlobRow> rows;
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    BlobRow row{};
    row.time_ns = frame.mid_exposure.nanoseconds;
    row.sequence = frame.sequence;
    put(row.ray, marker.ray);
    row.surface_range_m = marker.surface_range_m;
    put(row.centroid_px, marker.centroid_px);
    row.sigma_px[0] = static_cast<double>(marker.sigma_px[0]);
    row.sigma_px[1] = static_cast<double>(marker.sigma_px[1]);
    row.range_sigma_m = static_cast<double>(marker.range_sigma_m);
    row.bias_subtracted_m = static_cast<double>(marker.bias_subtracted_m);
    row.area_px = marker.area_px;
    row.peak = marker.peak;
    row.flags = marker.flags;
    rows.push_back(row);
  }
  return rows;
}

HeadPoseRow row_of(const HeadPose& pose) {
  HeadPoseRow row{};
  row.time_ns = pose.time.nanoseconds;
  row.valid = pose.valid;
  put_nothing(row.position_m);
  put_nothing(row.orientation_xyzw);
  if (!pose.valid) return row;
  put(row.position_m, pose.T_world_camera.translation);
  put(row.orientation_xyzw, pose.T_world_camera.rotation);
  return row;
}

ButtonRow row_of(const ButtonEvent& event) {
  return {event.time.nanoseconds, static_cast<std::uint8_t>(event.button), event.pressed};
}

HeldButtonsRow row_of(const PenButtonsRecord& buttons) {
  return {buttons.time.nanoseconds, buttons.version, buttons.held};
}

RobotFrameRow row_of(const RobotFrameRecord& frame) {
  RobotFrameRow row{};
  row.time_ns = frame.time.nanoseconds;
  row.version = frame.version;
  row.state = static_cast<std::uint8_t>(frame.state);
  row.in_reference = frame.in_reference;
  row.rms_m = frame.rms_m;
  put(row.position_m, frame.T_world_robot.translation);
  put(row.orientation_xyzw, frame.T_world_robot.rotation);
  return row;
}

ChoiceRow row_of(const ChoiceRecord& choice) {
  static_assert(k_recorded_versions == 4);
  ChoiceRow row{};
  row.time_ns = choice.nominal.nanoseconds;
  row.unix_offset_ns = choice.unix_offset_ns;
  row.activation = choice.activation;
  std::copy_n(choice.versions.begin(), choice.version_count, row.versions);
  row.group = choice.group;
  row.version_count = choice.version_count;
  row.overrun = static_cast<std::uint8_t>(choice.overrun.kind);
  row.policy = static_cast<std::uint8_t>(choice.overrun.policy);
  row.after_node = choice.overrun.after_node;
  return row;
}

DroppedRow row_of(const DroppedInput& input) {
  return {input.mid_exposure.nanoseconds, input.arrival.nanoseconds, input.sequence,
          static_cast<std::uint8_t>(input.reason)};
}

}  // namespace glint::python

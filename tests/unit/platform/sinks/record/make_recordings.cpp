// Writes FOLDER/LEVEL.mcap for every level, and FOLDER/LEVEL.json with its values, which
// verify_mcap.mjs compares. 64-bit integers are strings in the JSON.
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

using nlohmann::json;

struct Sample {
  RecordingWriter writer;
  json messages = json::array();
  Duration unix_offset;

  void expect(const std::string& topic, Time log_time, json value) {
    messages.push_back({{"topic", topic},
                        {"log_time", std::to_string((log_time + unix_offset).nanoseconds)},
                        {"value", std::move(value)}});
  }
  [[nodiscard]] json header(Time time, const std::string& frame) const {
    const std::int64_t since_1970 = (time + unix_offset).nanoseconds;
    return {
        {"stamp", {{"sec", since_1970 / 1'000'000'000}, {"nanosec", since_1970 % 1'000'000'000}}},
        {"frame_id", frame}};
  }
};

json number(std::int64_t value) { return std::to_string(value); }

json xyz(const Vector3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

json xyzw(const Quaternion& q) { return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}; }

template <class Pixel>
json rows(const std::vector<Pixel>& plane, const FrameBuffer& frame, const Roi& roi) {
  json bytes = json::array();
  for (int y = roi.y0; y < roi.y1; ++y)
    for (int x = roi.x0; x < roi.x1; ++x)
      for (std::size_t i = 0; i < sizeof(Pixel); ++i)
        bytes.push_back(plane[static_cast<std::size_t>(y * frame.width + x)] >> (8 * i) & 0xFF);
  return bytes;
}

void add_frame(Sample& sample, const FrameBuffer& buffer, const FrameLayout& layout,
               RecordingLevel level) {
  const Frame frame = buffer.view(layout.mid_exposure, layout.arrival, layout.sequence);
  std::vector<std::uint8_t> pixels(pixel_bytes(layout));
  copy_pixels(frame, layout, pixels);
  sample.writer.write_frame({layout, pixels});
  if (level != RecordingLevel::full && level != RecordingLevel::roi) return;
  const json header = sample.header(layout.mid_exposure, "hmd_tof_optical");
  const Roi all{0, 0, buffer.width, buffer.height};
  if (level == RecordingLevel::full) {
    json image = {{"header", header},
                  {"height", buffer.height},
                  {"width", buffer.width},
                  {"encoding", "mono16"},
                  {"is_bigendian", 0},
                  {"step", buffer.width * 2},
                  {"data", rows(buffer.reflectivity_16, buffer, all)}};
    sample.expect("/glint/reflectivity", layout.arrival, image);
    image["encoding"] = "16UC1";
    image["data"] = rows(buffer.depth, buffer, all);
    sample.expect("/glint/depth", layout.arrival, image);
  }
  json rectangles = json::array();
  for (int i = 0; i < layout.rectangle_count && level == RecordingLevel::roi; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    rectangles.push_back({{"x", roi.x0},
                          {"y", roi.y0},
                          {"width", roi.x1 - roi.x0},
                          {"height", roi.y1 - roi.y0},
                          {"reflectivity", rows(buffer.reflectivity_16, buffer, roi)},
                          {"depth", rows(buffer.depth, buffer, roi)}});
  }
  sample.expect("/glint/frame", layout.arrival,
                {{"header", header},
                 {"mid_exposure_ns", number(layout.mid_exposure.nanoseconds)},
                 {"arrival_ns", number(layout.arrival.nanoseconds)},
                 {"sequence", layout.sequence},
                 {"width", buffer.width},
                 {"height", buffer.height},
                 {"reflectivity_bits", 16},
                 {"has_depth", true},
                 {"pixels_in_images", level == RecordingLevel::full},
                 {"rectangles", rectangles},
                 {"stamp_sigma_ns", number(layout.stamp_sigma.nanoseconds)}});
}

void add_markers(Sample& sample, const MarkerFrame& frame) {
  sample.writer.write_markers(frame);
  json markers = json::array(), sigmas = json::array(), turns = json::array(),
       depths = json::array();
  for (int i = 0; i < frame.markers.count; ++i) {
    const Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    markers.push_back({{"ray", xyz(marker.ray)},
                       {"surface_range_m", marker.surface_range_m},
                       {"centroid_x_px", marker.centroid_px.x()},
                       {"centroid_y_px", marker.centroid_px.y()},
                       {"area_px", marker.area_px},
                       {"blob", marker.blob},
                       {"flags", marker.flags}});
    sigmas.push_back({{"x_px", marker.sigma_px[0]},
                      {"y_px", marker.sigma_px[1]},
                      {"range_m", marker.range_sigma_m}});
    turns.push_back({{"along_x", xyz(marker.along_x)}, {"along_y", xyz(marker.along_y)}});
    depths.push_back({{"bias_taken_m", marker.bias_subtracted_m}, {"peak", marker.peak}});
  }
  sample.expect("/glint/blobs", frame.arrival,
                {{"header", sample.header(frame.mid_exposure, "hmd_tof_optical")},
                 {"mid_exposure_ns", number(frame.mid_exposure.nanoseconds)},
                 {"arrival_ns", number(frame.arrival.nanoseconds)},
                 {"sequence", frame.sequence},
                 {"reason", static_cast<int>(frame.reason)},
                 {"markers", markers},
                 {"sigmas", sigmas},
                 {"turns", turns},
                 {"depths", depths},
                 {"incomplete", static_cast<int>(frame.markers.incomplete)},
                 {"stamp_sigma_ns", number(frame.stamp_sigma.nanoseconds)}});
}

void add_inputs(Sample& sample) {
  const ChoiceRecord choice = sample_choice(7);
  sample.writer.write_choice(choice);
  sample.expect("/glint/choice", choice.nominal,
                {{"header", sample.header(choice.nominal, "")},
                 {"nominal_ns", number(choice.nominal.nanoseconds)},
                 {"activation", std::to_string(choice.activation)},
                 {"group", choice.group},
                 {"overrun", 2 + 4 * 2},
                 {"overrun_after_node", 5},
                 {"unix_offset_ns", number(choice.unix_offset_ns)},
                 {"versions", json::array({"3", "3"})}});
  const HeadPose head = sample_head_pose(4);
  sample.writer.write_head_pose(head);
  sample.expect("/glint/head_pose", head.time,
                {{"header", sample.header(head.time, "hmd_world")},
                 {"time_ns", number(head.time.nanoseconds)},
                 {"valid", true},
                 {"pose",
                  {{"position", xyz(head.T_world_camera.translation)},
                   {"orientation", xyzw(head.T_world_camera.rotation)}}}});
  const DroppedInput dropped{{10}, {20}, 30, Reason::frame_duplicate};
  sample.writer.write_dropped(dropped);
  sample.expect("/glint/dropped", dropped.arrival,
                {{"header", sample.header(dropped.arrival, "hmd_tof_optical")},
                 {"mid_exposure_ns", "10"},
                 {"arrival_ns", "20"},
                 {"sequence", 30},
                 {"reason", static_cast<int>(Reason::frame_duplicate)}});
}

void add_button(Sample& sample, const ButtonEvent& event) {
  sample.writer.write_button(event);
  sample.expect("/glint/button", event.time,
                {{"header", sample.header(event.time, "")},
                 {"time_ns", number(event.time.nanoseconds)},
                 {"button", static_cast<int>(event.button)},
                 {"pressed", event.pressed}});
}

void add_pen_buttons(Sample& sample, const PenButtonsRecord& buttons) {
  sample.writer.write_pen_buttons(buttons);
  sample.expect("/glint/pen_buttons", buttons.time,
                {{"header", sample.header(buttons.time, "")},
                 {"version", std::to_string(buttons.version)},
                 {"time_ns", number(buttons.time.nanoseconds)},
                 {"held", buttons.held}});
}

void add_robot_frame(Sample& sample, const RobotFrameRecord& frame) {
  sample.writer.write_robot_frame(frame);
  sample.expect("/glint/robot_frame", frame.time,
                {{"header", sample.header(frame.time, "hmd_world")},
                 {"version", std::to_string(frame.version)},
                 {"time_ns", number(frame.time.nanoseconds)},
                 {"state", static_cast<int>(frame.state)},
                 {"in_reference", frame.in_reference},
                 {"rms_m", frame.rms_m},
                 {"pose",
                  {{"position", xyz(frame.T_world_robot.translation)},
                   {"orientation", xyzw(frame.T_world_robot.rotation)}}}});
}

void add_output(Sample& sample, const PoseSample& output) {
  const auto record = record_of(output);
  sample.writer.write_output(output, record);
  const std::string frame = output.frame == ReferenceFrame::robot ? "robot_base" : "hmd_world";
  const json header = sample.header(output.tick, frame);
  sample.expect("/glint/output", output.tick,
                {{"header", header},
                 {"tick_ns", number(output.tick.nanoseconds)},
                 {"measurement_ns", number(output.measurement.nanoseconds)},
                 {"tick_number", output.tick_number},
                 {"frame_sequence", output.frame_sequence},
                 {"tool", output.tool},
                 {"state", static_cast<int>(output.state)},
                 {"reason", static_cast<int>(output.reason)},
                 {"marker_mask", output.marker_mask},
                 {"age_s", output.age().seconds()},
                 {"sigma_position_m", output.sigma_position_m},
                 {"sigma_orientation_rad", output.sigma_orientation_rad},
                 {"record", record},
                 {"age_sigma_s", output.age_sigma_s}});
  if (!output.has_pose()) return;
  const json pose = {{"position", xyz(output.pose.translation)},
                     {"orientation", xyzw(output.pose.rotation)}};
  json covariance = json::array();
  for (int i = 0; i < 36; ++i) covariance.push_back(output.covariance(i / 6, i % 6));
  const std::string topic = output.tool == 0 ? "/glint/pen_pose" : "/glint/second_pen/pose";
  const std::string tip = output.tool == 0 ? "glint_pen_tip" : "glint_second_pen_tip";
  sample.expect(topic, output.tick, {{"header", header}, {"pose", pose}});
  sample.expect(topic + "_cov", output.tick,
                {{"header", header}, {"pose", {{"pose", pose}, {"covariance", covariance}}}});
  const json transform = {{"translation", pose["position"]}, {"rotation", pose["orientation"]}};
  sample.expect(
      "/tf", output.tick,
      {{"transforms",
        json::array({{{"header", header}, {"child_frame_id", tip}, {"transform", transform}}})}});
}

void make(const std::string& folder, RecordingLevel level) {
  const std::string stem = folder + "/" + std::string(name_of(level));
  const RecordingInfo info = sample_info(level);
  RecordingSettings settings;
  settings.chunk_bytes = 20'000;  // several chunks
  Sample sample{{stem + ".mcap", info, settings}, json::array(), info.unix_offset};
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  const Frame frame = buffer.view({100}, {200}, 9);
  const Rois rois{{Roi{4, 5, 12, 9}, Roi{30, 20, 38, 29}}, 2};
  for (std::uint32_t i = 0; i < 20; ++i) {
    if (level != RecordingLevel::outputs) add_inputs(sample);
    const FrameLayout layout =
        level == RecordingLevel::roi ? roi_layout(frame, rois, 1) : whole_frame_layout(frame);
    add_frame(sample, buffer, layout, level);
    if (level == RecordingLevel::blobs) add_markers(sample, sample_markers(3));
    PoseSample output = sample_output(i, i % 4 == 3 ? TrackState::lost : TrackState::measured);
    output.tool = i % 5 == 4 ? 1 : 0;
    if (i % 2 == 0) output.frame = ReferenceFrame::world;
    add_output(sample, output);
    add_button(sample, {output.tick, Button::undo, i % 2 == 0});
    if (level == RecordingLevel::outputs) continue;
    add_pen_buttons(sample, {i + 1, output.tick, static_cast<std::uint8_t>(i % 2 == 0 ? 4 : 0)});
    add_robot_frame(sample, {i + 2, output.tick, RegistrationState::accepted,
                             sample_head_pose(4).T_world_camera, 0.004, i % 2 == 0});
  }
  const RecordingOutcome outcome = sample.writer.close();
  json attachments = json::array();
  for (const Attachment& attachment : info.attachments)
    attachments.push_back({{"name", attachment.name},
                           {"media_type", attachment.media_type},
                           {"data", attachment.data}});
  std::ofstream(stem + ".json") << json{{"output_sha256", outcome.output_sha256},
                                        {"level", name_of(level)},
                                        {"attachments", attachments},
                                        {"messages", sample.messages}};
}

}  // namespace
}  // namespace glint

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: glint_make_recordings FOLDER\n";
    return 2;
  }
  using glint::RecordingLevel;
  for (const auto level :
       {RecordingLevel::full, RecordingLevel::roi, RecordingLevel::blobs, RecordingLevel::outputs})
    glint::make(arguments[1], level);
}

// Sample values for tests of recordings. Every field differs, so that swapped fields are detected.
#pragma once

#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "kernels/wire/output_record.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint {

// Temporary folder that is removed at the end of its test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "glint_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline RecordingInfo sample_info(RecordingLevel level) {
  RecordingInfo info;
  info.level = level;
  info.nominal_tick = milliseconds(4);
  info.unix_offset = {1'700'000'000'000'000'123};
  info.tool_names = {"pen", "second pen"};
  info.facts = {{"build", "abc"}, {"compiler", "g++ 12"}};
  info.attachments = {text_attachment("cell.toml", "name = \"cell\"\n"),
                      {"rays.npy", "application/octet-stream", {1, 2, 3, 0, 255}}};
  return info;
}

inline FrameBuffer sample_frame(int width, int height, int bits) {
  FrameBuffer frame;
  frame.width = width;
  frame.height = height;
  for (int i = 0; i < width * height; ++i) {
    if (bits == 8) frame.reflectivity_8.push_back(static_cast<std::uint8_t>(i * 7 + 1));
    if (bits == 16) frame.reflectivity_16.push_back(static_cast<std::uint16_t>(i * 613 + 1));
    frame.depth.push_back(static_cast<std::uint16_t>(i * 91 + 5));
  }
  return frame;
}

inline HeadPose sample_head_pose(int i) {
  HeadPose pose;
  pose.time = {1000 + i};
  pose.valid = i % 3 != 2;
  pose.T_world_camera = {Quaternion(0.5, -0.5, 0.5, 0.5), Vector3(0.1 * i, -2, 3.25)};
  return pose;
}

inline MarkerFrame sample_markers(int count) {
  MarkerFrame frame;
  frame.mid_exposure = {5'000};
  frame.stamp_sigma = {123'456};
  frame.arrival = {9'000'000};
  frame.sequence = 77;
  frame.reason = Reason::frame_invalid;
  frame.markers.count = count;
  frame.markers.incomplete = Reason::blobs_full;
  for (int i = 0; i < count; ++i) {
    Marker& marker = frame.markers.items[static_cast<std::size_t>(i)];
    marker.ray = Vector3(0.6, 0.0, 0.8);
    marker.surface_range_m = 0.5 + 0.001 * i;
    marker.centroid_px = Vector2(10.25 + i, 20.5);
    marker.area_px = static_cast<std::uint32_t>(30 + i);
    marker.blob = static_cast<std::uint16_t>(i);
    marker.flags = k_marker_annulus_depth;
    marker.sigma_px = {0.25F, 0.5F + static_cast<float>(i)};
    marker.range_sigma_m = 0.125F;
    marker.along_x = Vector3(0.004, 0.0, -0.003);
    marker.along_y = Vector3(0.0, 0.005 + 0.001 * i, 0.0);
    marker.bias_subtracted_m = 0.0625F;
    marker.peak = static_cast<std::uint16_t>(900 + i);
  }
  return frame;
}

inline ChoiceRecord sample_choice(std::uint64_t activation) {
  return {1,
          activation,
          {static_cast<std::int64_t>(activation) * 4'000'000},
          {activation / 2, 3, 0, 0},
          2,
          {graph::OverrunKind::missed, graph::OverrunPolicy::predict, 5},
          1'700'000'000'000'000'456};
}

inline PoseSample sample_output(std::uint32_t tick, TrackState state = TrackState::measured) {
  PoseSample sample;
  sample.tick = {std::int64_t{tick} * 4'000'000};
  sample.measurement = {std::int64_t{tick} * 4'000'000 - 11'000'000};
  sample.tick_number = tick;
  sample.frame_sequence = tick / 5;
  sample.marker_mask = 0x2F;
  sample.state = state;
  sample.reason = Reason::none;
  sample.frame = ReferenceFrame::robot;
  if (!sample.has_pose()) return sample;
  sample.pose = {Quaternion(0.5, 0.5, -0.5, 0.5), Vector3(0.001 * tick, -0.25, 1.5)};
  for (int i = 0; i < 36; ++i) sample.covariance(i / 6, i % 6) = 1e-6 * (i + 1);
  sample.sigma_position_m = 0.0015;
  sample.sigma_orientation_rad = 0.004;
  sample.age_sigma_s = 0.002;
  return sample;
}

inline std::array<std::uint8_t, k_output_record_bytes> record_of(const PoseSample& sample) {
  std::array<std::uint8_t, k_output_record_bytes> record;
  encode(sample, record);
  return record;
}

}  // namespace glint

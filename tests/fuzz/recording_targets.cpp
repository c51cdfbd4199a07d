// Fuzz targets of recordings: the MCAP container, each Glint message, and recordings of other
// programs.
#include <filesystem>

#include "kernels/wire/output_record.hpp"
#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sources/folder_frames.hpp"
#include "platform/sources/hl2ss_frames.hpp"
#include "platform/sources/ros_images.hpp"
#include "platform/sources/rosbag_frames.hpp"
#include "platform/sources/tar_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace glint::fuzz {
namespace {

void read_all(const std::string& path, ReadTolerance tolerance) {
  RecordingReader reader(path, tolerance);
  for (const std::string& name : reader.attachment_names()) (void)reader.attachment(name);
  while (reader.next()) {
  }
}

void read_complete(Bytes bytes) { read_all(file_of(bytes), {}); }

void read_tolerant(Bytes bytes) { read_all(file_of(bytes), {true, true}); }

// The first byte selects the message type.
void read_message(Bytes bytes) {
  if (bytes.empty()) return;
  const Bytes message = bytes.subspan(1);
  switch (bytes[0] % 10) {
    case 0: {
      const ImageRows rows = read_image(message).value_or(ImageRows{});
      (void)read_frame(message, rows, rows);
      return;
    }
    case 1:
      (void)read_image(message);
      return;
    case 2:
      (void)read_head_pose(message);
      return;
    case 3:
      (void)read_markers(message);
      return;
    case 4:
      (void)read_choice(message);
      return;
    case 5: {
      const auto output = read_output(message);
      if (!output) return;
      (void)decode(output->record);
      return;
    }
    case 6:
      (void)read_dropped(message);
      return;
    case 7:
      (void)read_robot_frame(message);
      return;
    case 8:
      (void)read_pen_buttons(message);
      return;
    default:
      (void)read_button(message);
  }
}

Camera tiny_camera() {
  Camera camera = hololens2_ahat();
  camera.model.width = camera.model.height = 2;
  return camera;
}

void read_frames(FrameReader& reader) {
  ReadFrame frame;
  while (reader.next(frame)) {
  }
  (void)reader.text();
  (void)reader.unix_offset();
}

void read_rosbag(Bytes bytes) {
  SourceSettings source;
  source.path = file_of(bytes);
  RosbagFrames frames(source, tiny_camera(), {true, true});
  (void)frames.lens();
  read_frames(frames);
}

void read_lens_of_bag(Bytes bytes) { (void)lens_text_of_camera_info(bytes, "/info"); }

void read_hl2ss(Bytes bytes) {
  SourceSettings source;
  source.path = file_of(bytes);
  Hl2ssFrames frames(source, tiny_camera());
  read_frames(frames);
}

void read_tar(Bytes bytes) {
  const InputFile archive(file_of(bytes));
  std::uint64_t cut = 0;
  for (const TarEntry& entry : tar_entries(archive, cut)) {
    expect(entry.offset + entry.bytes <= archive.size(), "an entry inside the archive");
  }
  expect(cut <= archive.size(), "no more is cut than there is");
}

void read_frames_csv(Bytes bytes) {
  const std::filesystem::path file = file_of(bytes, ".csv");
  const std::filesystem::path link = file.parent_path() / "frames.csv";
  if (!std::filesystem::exists(link)) std::filesystem::create_symlink(file, link);
  FolderFrames frames(file.parent_path().string(), tiny_camera());
  read_frames(frames);
}

constexpr Target k_recording_targets[] = {
    {"mcap", read_complete}, {"mcap_tolerant", read_tolerant},  {"messages", read_message},
    {"rosbag", read_rosbag}, {"camera_info", read_lens_of_bag}, {"hl2ss", read_hl2ss},
    {"tar", read_tar},       {"frames_csv", read_frames_csv}};

}  // namespace

std::span<const Target> recording_targets() { return k_recording_targets; }

}  // namespace glint::fuzz

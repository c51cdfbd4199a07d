#include "platform/sources/stream_recorder_frames.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"
#include "platform/sources/file_time.hpp"
#include "platform/sources/matrix_pose.hpp"
#include "platform/sources/planes.hpp"
#include "platform/sources/tar_file.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct Sensor {
  const char* name;
  int width, height;
};
constexpr Sensor k_sensors[] = {{"Depth AHaT", 512, 512}, {"Depth Long Throw", 320, 288}};
constexpr std::uint64_t k_picture_bytes_max = 64 << 20;

bool is_there(const std::string& prefix) {
  return fs::exists(prefix + ".tar") || fs::is_directory(prefix);
}

// Parses "<digits>.pgm" or "<digits>_ab.pgm", in any folder.
std::optional<std::uint64_t> stamp_of(std::string_view name, bool& is_reflectivity) {
  name = name.substr(name.rfind('/') + 1);
  std::uint64_t stamp = 0;
  const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), stamp);
  const std::string_view end(rest, static_cast<std::size_t>(name.data() + name.size() - rest));
  is_reflectivity = end == "_ab.pgm";
  if (error != std::errc{} || !(is_reflectivity || end == ".pgm")) return std::nullopt;
  return stamp;
}

// Parses comma- or blank-separated numbers. Returns their count, less than the size of `numbers` if
// the text ends early or has other content.
std::size_t read_numbers(std::string_view text, std::span<double> numbers) {
  std::size_t count = 0;
  while (count < numbers.size()) {
    const std::size_t from = text.find_first_not_of(", \t\r\n");
    if (from == std::string_view::npos) break;
    text = text.substr(from);
    const auto [rest, error] =
        std::from_chars(text.data(), text.data() + text.size(), numbers[count]);
    if (error != std::errc{}) break;
    text = text.substr(static_cast<std::size_t>(rest - text.data()));
    ++count;
  }
  return count;
}

std::string sensor_prefix(const std::string& folder, const Camera& camera) {
  std::string names;
  for (const Sensor& sensor : k_sensors) {
    const std::string prefix = (fs::path(folder) / sensor.name).string();
    names += (names.empty() ? "\"" : " or \"") + std::string(sensor.name) + ".tar\"";
    if (sensor.width == camera.model.width && sensor.height == camera.model.height &&
        is_there(prefix)) {
      return prefix;
    }
  }
  throw InputError(folder + ": no " + names + " with frames of " +
                   std::to_string(camera.model.width) + " x " +
                   std::to_string(camera.model.height) + " pixels (" + camera.name +
                   "); expected a capture of StreamRecorder");
}

}  // namespace

StreamRecorderFrames::StreamRecorderFrames(const std::string& folder, const Camera& camera)
    : prefix_(sensor_prefix(folder, camera)), camera_(camera) {
  if (fs::exists(prefix_ + ".tar")) {
    list_archive();
  } else {
    list_folder();
  }
  next_ = pairs_.begin();
  read_poses();
}

void StreamRecorderFrames::add(const std::string& name, std::uint64_t offset, std::uint64_t bytes) {
  bool is_reflectivity = false;
  const auto stamp = stamp_of(name, is_reflectivity);
  if (!stamp) return;
  Pair& pair = pairs_[*stamp];
  (is_reflectivity ? pair.reflectivity : pair.depth) = {name, offset, bytes};
}

void StreamRecorderFrames::list_archive() {
  archive_ = std::make_unique<InputFile>(prefix_ + ".tar");
  std::uint64_t cut = 0;
  for (const TarEntry& entry : tar_entries(*archive_, cut)) {
    add(entry.name, entry.offset, entry.bytes);
  }
  if (cut > 0) {
    missing_ = archive_->path() + ": truncated; " + std::to_string(cut) +
               " bytes after its last complete file not read";
  }
}

void StreamRecorderFrames::list_folder() {
  for (const auto& entry : fs::directory_iterator(prefix_)) {
    add(entry.path().filename().string(), 0, 0);
  }
}

// The files have the rig's pose; the camera's pose also requires the extrinsics.
void StreamRecorderFrames::read_poses() {
  const std::string extrinsics = prefix_ + "_extrinsics.txt", poses = prefix_ + "_rig2world.txt";
  for (const std::string& file : {extrinsics, poses}) {
    if (!fs::exists(file) && no_pose_.empty())
      no_pose_ = "no " + fs::path(file).filename().string();
  }
  if (!no_pose_.empty()) return;
  MatrixNumbers numbers{};
  const std::size_t count =
      read_numbers(read_file(extrinsics, k_text_bytes_max, "16 numbers"), numbers);
  const std::optional<Pose> T_camera_rig = pose_of_matrix(numbers);
  if (count != numbers.size() || !T_camera_rig) {
    throw InputError(extrinsics + ": not a rigid transform; expected 16 numbers, rig to camera");
  }
  const Pose T_rig_camera = T_camera_rig->inverse();
  const std::string text = read_file(poses, k_data_bytes_max, "a stamp and 16 numbers a line");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    std::uint64_t stamp = 0;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), stamp);
    const std::size_t place = static_cast<std::size_t>(rest - line.data());
    const std::optional<Pose> T_world_rig =
        error == std::errc{} && read_numbers(line.substr(place), numbers) == numbers.size()
            ? pose_of_matrix(numbers)
            : std::nullopt;
    if (T_world_rig) {
      T_world_camera_[stamp] = *T_world_rig * T_rig_camera;
    } else {
      ++poses_refused_;
    }
  }
}

std::optional<SourceLens> StreamRecorderFrames::lens() const {
  const std::string path = prefix_ + "_lut.bin";
  if (!fs::exists(path)) return std::nullopt;
  const std::string bytes = read_file(path, k_data_bytes_max, "a table of unit rays");
  std::vector<float> rays(bytes.size() / sizeof(float));
  std::memcpy(rays.data(), bytes.data(), rays.size() * sizeof(float));
  return SourceLens{path, std::move(rays), {}};
}

bool StreamRecorderFrames::next(ReadFrame& frame) {
  while (next_ != pairs_.end()) {
    const auto& [stamp, pair] = *next_++;
    try {
      read_frame(stamp, pair, frame);
      return true;
    } catch (const InputError& error) {
      if (unreadable_++ == 0) first_unreadable_ = error.what();
    }
  }
  return false;
}

std::string StreamRecorderFrames::contents_of(const File& file) const {
  if (archive_ == nullptr) {
    return read_file((fs::path(prefix_) / file.name).string(), k_picture_bytes_max, "a PGM image");
  }
  if (file.bytes > k_picture_bytes_max) {
    archive_->refuse(file.offset, std::to_string(file.bytes) + " bytes", "a PGM image");
  }
  Bytes bytes;
  archive_->read(file.offset, file.bytes, bytes);
  return {bytes.begin(), bytes.end()};
}

void StreamRecorderFrames::read_frame(std::uint64_t stamp, const Pair& pair, ReadFrame& frame) {
  const auto plane_of = [&](const File& file, const char* kind, const File& other) {
    if (file.name.empty()) {
      throw InputError(prefix_ + ": " + printable(other.name) + " has no " + kind +
                       " file; expected both files of a frame");
    }
    const std::string name = prefix_ + ":" + printable(file.name);
    Image picture = pgm_of(contents_of(file), name, {k_image_side_max, k_image_side_max, 16});
    return PixelPlane{picture.width, picture.height, std::move(picture.values), name};
  };
  frame = ReadFrame{};
  fill_pixels(plane_of(pair.reflectivity, "_ab.pgm", pair.depth),
              plane_of(pair.depth, "depth", pair.reflectivity), camera_, frame.pixels);
  frame.mid_exposure = time_of_file_time(stamp);
  if (const auto pose = T_world_camera_.find(stamp); pose != T_world_camera_.end()) {
    frame.head.valid = true;
    frame.head.T_world_camera = pose->second;
  }
}

ReaderCounts StreamRecorderFrames::counts() const { return {{"poses_unreadable", poses_refused_}}; }

std::string StreamRecorderFrames::text() const {
  return "stream_recorder " + prefix_ + (no_pose_.empty() ? "" : ": " + no_pose_);
}

std::optional<Duration> StreamRecorderFrames::unix_offset() const {
  if (pairs_.empty() || !is_file_time(pairs_.begin()->first)) return std::nullopt;
  return Duration{};
}

}  // namespace glint

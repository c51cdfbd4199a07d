#include "platform/sources/folder_frames.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <utility>

#include "platform/formats/image_file.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"
#include "platform/sources/planes.hpp"

namespace glint {
namespace {

enum Column {
  k_time,
  k_reflectivity,
  k_depth,
  k_arrival,
  k_sequence,
  k_pose,
  k_columns = k_pose + 7
};
constexpr std::array<std::string_view, k_columns> k_names = {
    "time_ns", "reflectivity", "depth", "arrival_ns", "sequence", "x_m",
    "y_m",     "z_m",          "qx",    "qy",         "qz",       "qw"};
constexpr int k_required_columns = 3;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line = line.substr(comma + 1);
  }
}

template <class Number>
Number number_of(std::string_view field, int column) {
  Number value{};
  const auto [rest, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc{} && rest == field.data() + field.size()) return value;
  throw InputError(std::string(k_names[static_cast<std::size_t>(column)]) + " is \"" +
                   printable(std::string(field.substr(0, 40))) + "\"; expected " +
                   (std::is_integral_v<Number> ? "an integer" : "a number"));
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// metres: depth of one raw count, for an array of floats.
PixelPlane read_array(const std::string& path, double metres) {
  const NpyNumbers array = read_npy_numbers(path);
  if (array.shape.size() != 2 || array.shape[0] > k_image_side_max ||
      array.shape[1] > k_image_side_max) {
    throw InputError(path + ":shape: not an image; expected rows x columns");
  }
  PixelPlane plane{static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]), {}, path};
  plane.values.reserve(array.values.size());
  for (const double value : array.values) {
    plane.values.push_back(array.integer ? static_cast<std::uint16_t>(value)
                                         : raw_depth(value, metres));
  }
  return plane;
}

PixelPlane read_plane(const std::string& path, double metres) {
  if (ends_with(path, ".npy")) return read_array(path, metres);
  Image picture = read_image_file(path);
  if (picture.channels != 1) {
    throw InputError(path + ": a colour image; expected grey, 8 or 16 bits");
  }
  return {picture.width, picture.height, std::move(picture.values), path};
}

}  // namespace

FolderFrames::FolderFrames(const std::string& folder, const Camera& camera)
    : folder_(folder),
      file_((std::filesystem::path(folder) / "frames.csv").string()),
      text_(read_file(file_, k_text_bytes_max, "a folder with frames.csv")),
      camera_(camera) {
  at_ = std::min(text_.find('\n'), text_.size());
  line_ = 1;
  read_heading(std::string_view(text_).substr(0, at_));
}

void FolderFrames::read_heading(std::string_view line) {
  std::array<bool, k_columns> found{};
  const std::string place = file_ + ":1: ";
  for (const std::string_view field : fields_of(line)) {
    const auto known = std::find(k_names.begin(), k_names.end(), field);
    const auto column = static_cast<std::size_t>(known - k_names.begin());
    if (known == k_names.end() || found[column]) {
      throw InputError(place + "column \"" + printable(std::string(field.substr(0, 40))) + "\"" +
                       (known == k_names.end() ? "" : " twice") +
                       "; expected time_ns,reflectivity,depth and optionally arrival_ns, sequence, "
                       "x_m,y_m,z_m,qx,qy,qz,qw");
    }
    found[column] = true;
    column_.push_back(static_cast<int>(column));
  }
  for (std::size_t i = 0; i < k_columns; ++i) {
    const bool pose = i >= k_pose;
    if (found[i] == (pose ? found[k_pose] : i < k_required_columns || found[i])) continue;
    throw InputError(place + "no column " + std::string(k_names[i]) + "; expected " +
                     (pose ? "all seven columns of a pose, or none" : "this column too"));
  }
}

bool FolderFrames::next(ReadFrame& frame) {
  while (at_ < text_.size()) {
    const std::size_t begin = at_ + 1;
    at_ = std::min(text_.find('\n', begin), text_.size());
    ++line_;
    const std::string_view line = trimmed(std::string_view(text_).substr(begin, at_ - begin));
    if (line.empty()) continue;
    try {
      read_row(line, frame);
      return true;
    } catch (const InputError& error) {
      if (unreadable_++ == 0) {
        first_unreadable_ = file_ + ":" + std::to_string(line_) + ": " + error.what();
      }
    }
  }
  return false;
}

void FolderFrames::read_row(std::string_view line, ReadFrame& frame) const {
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.size() != column_.size()) {
    throw InputError(std::to_string(fields.size()) + " columns; expected " +
                     std::to_string(column_.size()));
  }
  frame = ReadFrame{};
  std::string reflectivity, depth;
  std::array<double, 7> pose{};
  int pose_fields = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view field = fields[i];
    const int column = column_[i];
    if (column == k_time) frame.mid_exposure.nanoseconds = number_of<std::int64_t>(field, column);
    if (column == k_reflectivity) reflectivity = field;
    if (column == k_depth) depth = field;
    if (column == k_arrival && !field.empty()) {
      frame.arrival = Time{number_of<std::int64_t>(field, column)};
    }
    if (column == k_sequence) frame.sequence = number_of<std::uint64_t>(field, column);
    if (column >= k_pose && !field.empty()) {
      pose[static_cast<std::size_t>(column - k_pose)] = number_of<double>(field, column);
      ++pose_fields;
    }
  }
  if (pose_fields != 0 && pose_fields != 7) {
    throw InputError(std::to_string(pose_fields) + " numbers of a pose; expected 7 or none");
  }
  read_planes(reflectivity, depth, frame.pixels);
  frame.head.valid = pose_fields == 7;
  if (frame.head.valid) {
    frame.head.T_world_camera.translation = Vector3(pose[0], pose[1], pose[2]);
    frame.head.T_world_camera.rotation = Quaternion(pose[6], pose[3], pose[4], pose[5]);
  }
}

void FolderFrames::read_planes(const std::string& reflectivity, const std::string& depth,
                               FrameBuffer& pixels) const {
  const auto path = [&](const std::string& name, int column) {
    if (!name.empty()) return (std::filesystem::path(folder_) / name).string();
    throw InputError(std::string(k_names[static_cast<std::size_t>(column)]) +
                     " is empty; expected a file's name");
  };
  PixelPlane bright = read_plane(path(reflectivity, k_reflectivity), 1);
  PixelPlane range = read_plane(path(depth, k_depth), camera_.depth.unit_m);
  fill_pixels(std::move(bright), std::move(range), camera_, pixels);
}

}  // namespace glint

#include "platform/formats/points_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr std::string_view k_heading = "time_s,x_m,y_m,z_m";
constexpr double k_time_max_s = 9e9;        // int64 nanoseconds end at 9.2e9 s
constexpr double k_coordinate_max_m = 1e4;  // larger values have another unit

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

double number_of(std::string_view field, double limit, const char* column,
                 const std::string& place) {
  double value = 0;
  const auto [rest, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc{} && rest == field.data() + field.size() && std::abs(value) <= limit) {
    return value;
  }
  std::ostringstream expected;
  expected << "; expected a number from " << -limit << " to " << limit;
  throw InputError(place + ": " + column + " is \"" + std::string(field.substr(0, 40)) + "\"" +
                   expected.str());
}

struct Row {
  Time time;
  Vector3 point_m;
};

Row row_of(std::string_view line, const std::string& place) {
  constexpr std::array columns = {"time_s", "x_m", "y_m", "z_m"};
  std::array<double, 4> value{};
  std::string_view rest = line;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t comma = rest.find(',');
    const bool last = i + 1 == columns.size();
    if (last != (comma == std::string_view::npos)) {
      throw InputError(place + ": \"" + std::string(line.substr(0, 60)) +
                       "\"; expected four columns " + std::string(k_heading));
    }
    value[i] = number_of(trimmed(rest.substr(0, comma)), i == 0 ? k_time_max_s : k_coordinate_max_m,
                         columns[i], place);
    if (!last) rest = rest.substr(comma + 1);
  }
  return {Time{static_cast<std::int64_t>(std::llround(value[0] * 1e9))},
          Vector3(value[1], value[2], value[3])};
}

void append(std::vector<PointFrame>& frames, const Row& row, const std::string& place) {
  if (!frames.empty() && row.time < frames.back().time) {
    throw InputError(place + ": time_s decreases; expected rows in order of time");
  }
  if (frames.empty() || frames.back().time != row.time) frames.push_back({row.time, {}});
  std::vector<Vector3>& points = frames.back().points_m;
  if (points.size() == static_cast<std::size_t>(k_blobs_max)) {
    throw InputError(place + ": more than " + std::to_string(k_blobs_max) +
                     " points at one time; expected at most so many");
  }
  points.push_back(row.point_m);
}

}  // namespace

std::vector<PointFrame> points_from_text(std::string_view text, const std::string& path) {
  std::vector<PointFrame> frames;
  int line = 0;
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view row = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++line;
    if (row.empty()) continue;
    const bool heading = first && row == k_heading;
    first = false;
    if (heading) continue;
    const std::string place = path + ":" + std::to_string(line);
    append(frames, row_of(row, place), place);
  }
  if (frames.empty()) {
    throw InputError(path + ":1: holds no point; expected rows " + std::string(k_heading));
  }
  return frames;
}

std::vector<PointFrame> load_points(const std::string& path) {
  const std::string expected = "a file of rows " + std::string(k_heading);
  return points_from_text(read_file(path, k_data_bytes_max, expected), path);
}

Markers markers_from_points(const std::vector<Vector3>& points_m) {
  Markers markers;
  for (const Vector3& point : points_m) {
    if (markers.count == k_blobs_max) break;
    Marker& marker = markers.items[static_cast<std::size_t>(markers.count)];
    marker.blob = static_cast<std::uint16_t>(markers.count++);
    marker.surface_range_m = point.norm();
    if (marker.surface_range_m > 0) {
      marker.ray = point / marker.surface_range_m;
    } else {
      marker.flags = k_marker_no_depth;
    }
  }
  return markers;
}

Tool as_points(Tool tool) {
  tool.shape = MarkerShape::disc;
  tool.marker_radius_m = 0;
  return tool;
}

CorrespondSettings settings_for_points() {
  CorrespondSettings settings;
  settings.focal_px = 0;
  settings.range_sigma_m = 0.0005;  // a motion-capture marker in a room, per axis
  settings.delta_min_m = 0.002;     // accuracy of a user's own tool file
  settings.max_rms_m = 0.002;
  return settings;
}

}  // namespace glint

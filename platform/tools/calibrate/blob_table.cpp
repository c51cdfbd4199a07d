#include <array>
#include <charconv>
#include <cmath>

#include "platform/input_error.hpp"
#include "platform/tools/calibrate/sightings.hpp"

namespace glint {
namespace {

constexpr const char* k_heading = "time_s,x_px,y_px,range_m,peak";
constexpr std::size_t k_columns = 5;
constexpr std::array<const char*, k_columns> k_names = {"time_s", "x_px", "y_px", "range_m",
                                                        "peak"};
constexpr std::array<double, k_columns> k_least = {-9e9, -1e5, -1e5, 0.01, 1};
constexpr std::array<double, k_columns> k_value_max = {9e9, 1e5, 1e5, 100, 65535};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::array<double, k_columns> row_of(std::string_view line, const std::string& location) {
  std::array<double, k_columns> row{};
  std::string_view rest = line;
  for (std::size_t i = 0; i < k_columns; ++i) {
    const std::size_t comma = rest.find(',');
    if ((i + 1 == k_columns) != (comma == std::string_view::npos)) {
      throw InputError(location + ": \"" + std::string(line.substr(0, 60)) +
                       "\"; expected five columns " + k_heading);
    }
    const std::string_view field = trimmed(rest.substr(0, comma));
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), row[i]);
    if (error != std::errc{} || end != field.data() + field.size() || !(row[i] >= k_least[i]) ||
        !(row[i] <= k_value_max[i])) {
      throw InputError(location + ": " + k_names[i] + " is \"" + std::string(field.substr(0, 40)) +
                       "\"; expected a number in the unit of its name, a peak from 1 to 65535");
    }
    if (comma != std::string_view::npos) rest = rest.substr(comma + 1);
  }
  return row;
}

}  // namespace

BlobSeries blobs_from_text(std::string_view text, const std::string& path, const Camera& camera) {
  BlobSeries series;
  series.what = path;
  series.camera = camera;
  series.brightness = true;
  int number = 0;
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++number;
    if (line.empty()) continue;
    const bool heading = first && line == k_heading;
    first = false;
    if (heading) continue;
    const std::string location = path + ":" + std::to_string(number);
    const std::array<double, k_columns> row = row_of(line, location);
    const Time time{static_cast<std::int64_t>(std::llround(1e9 * row[0]))};
    if (!series.frames.empty() && time < series.frames.back().time) {
      throw InputError(location + ": time_s decreases; expected rows in order of time");
    }
    if (series.frames.empty() || series.frames.back().time != time)
      series.frames.push_back({time, {}});
    int steps = 0;
    const Result<LocalRays> rays =
        local_rays(camera.model, {row[1], row[2]}, k_ray_steps_max, steps);
    if (!rays) {
      throw InputError(location + ": the lens of " + camera.name +
                       " has no ray at this pixel; expected blobs inside its image");
    }
    ObservedBlob blob;
    blob.rays = rays.value;
    blob.surface_range_m = row[3];
    blob.peak = row[4];
    series.frames.back().blobs.push_back(blob);
  }
  if (series.frames.empty()) {
    throw InputError(path + ":1: holds no blob; expected rows " + k_heading);
  }
  return series;
}

}  // namespace glint

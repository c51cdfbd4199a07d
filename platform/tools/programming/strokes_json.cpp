#include "platform/tools/programming/strokes_json.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/stroke_edits.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_format_name = "glint_strokes";
constexpr int k_format_version = 1;
constexpr std::uintmax_t k_strokes_bytes_max = 256u << 20;
constexpr std::size_t k_strokes_max = 4096;
constexpr double k_norm_tolerance = 1e-6, k_symmetry_tolerance = 1e-9;
constexpr std::int64_t k_time_max_ns = INT64_MAX / 4;  // sums of two times are in range

// A value and where it is.
struct Place {
  const Json& value;
  std::string name;

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(name + ": " + found + "; expected " + expected);
  }
  void require(bool right, const std::string& expected) const {
    if (right) return;
    std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    constexpr std::size_t k_shown_max = 60;
    if (text.size() > k_shown_max) text = text.substr(0, k_shown_max) + "..";
    fail("found " + printable(text), expected);
  }
  // An object with exactly these keys.
  void require_keys(std::initializer_list<const char*> keys) const {
    require(value.is_object(), "an object");
    std::string list;
    for (const char* key : keys) list += (list.empty() ? "" : ", ") + std::string(key);
    for (const auto& [key, unused] : value.items()) {
      bool known = false;
      for (const char* one : keys) known = known || key == one;
      if (!known) fail("unknown key \"" + printable(key) + "\"", "one of " + list);
    }
    for (const char* key : keys)
      if (!value.contains(key)) fail("no key \"" + std::string(key) + "\"", list);
  }
  [[nodiscard]] Place at(const char* key) const { return {value.at(key), name + '.' + key}; }
  [[nodiscard]] std::vector<Place> items(std::size_t least, std::size_t most,
                                         const std::string& what) const {
    require(value.is_array() && value.size() >= least && value.size() <= most,
            least == most ? std::to_string(least) + ' ' + what
                          : std::to_string(least) + " to " + std::to_string(most) + ' ' + what);
    std::vector<Place> list;
    for (std::size_t i = 0; i < value.size(); ++i)
      list.push_back({value[i], name + '[' + std::to_string(i) + ']'});
    return list;
  }
  [[nodiscard]] std::string text() const {
    require(value.is_string(), "a text");
    return value.get<std::string>();
  }
  [[nodiscard]] std::int64_t nanoseconds() const {
    require(value.is_number_integer() &&
                std::abs(value.get<double>()) < static_cast<double>(k_time_max_ns),
            "whole nanoseconds");
    return value.get<std::int64_t>();
  }
  template <class Matrix>
  void read(Matrix& out) const {
    const auto size = static_cast<std::size_t>(out.size());
    const std::vector<Place> numbers = items(size, size, "numbers");
    for (std::size_t i = 0; i < size; ++i) {
      numbers[i].require(numbers[i].value.is_number(), "a number");
      out(static_cast<int>(i)) = numbers[i].value.template get<double>();
      numbers[i].require(std::isfinite(out(static_cast<int>(i))), "a finite number");
    }
  }
};

UncertainPose point_of(const Place& place) {
  place.require_keys({"time_ns", "position_m", "rotation_xyzw", "covariance"});
  UncertainPose point;
  point.time = Time{place.at("time_ns").nanoseconds()};
  place.at("position_m").read(point.pose.translation);
  Eigen::Vector4d rotation;
  place.at("rotation_xyzw").read(rotation);
  place.at("rotation_xyzw")
      .require(std::abs(rotation.norm() - 1) <= k_norm_tolerance, "a unit quaternion x, y, z, w");
  point.pose.rotation = Quaternion(rotation);
  const Place covariance = place.at("covariance");
  covariance.read(point.covariance);
  const Matrix6& c = point.covariance;
  const bool symmetric =
      (c - c.transpose()).cwiseAbs().maxCoeff() <= k_symmetry_tolerance * c.cwiseAbs().maxCoeff();
  covariance.require(symmetric && c.diagonal().minCoeff() >= 0,
                     "a symmetric matrix of 6 rows with variances of 0 or more");
  return point;
}

PathElement element_of(const Place& place) {
  place.require_keys({"name", "kind", "points"});
  PathElement element;
  element.name = place.at("name").text();
  place.at("name").require(is_stroke_name(element.name),
                           "at most 64 letters, digits, '_', '-' and '.'");
  const Place kind = place.at("kind");
  const std::string kind_text = kind.text();
  kind.require(kind_text == "stroke" || kind_text == "waypoint", "stroke or waypoint");
  const bool stroke = kind_text == "stroke";
  element.kind = stroke ? PathKind::stroke : PathKind::waypoint;
  const std::size_t most = stroke ? std::size_t{1} << 22 : 1;
  for (const Place& point : place.at("points").items(stroke ? 2 : 1, most, "points"))
    element.points.push_back(point_of(point));
  return element;
}

template <class Matrix>
Json array_of(const Matrix& matrix) {
  Json array = Json::array();
  for (int i = 0; i < matrix.size(); ++i) array.push_back(matrix(i));
  return array;
}

// The library keeps the last of two equal keys without a message.
Json parsed(const std::string& text, const std::string& from) {
  std::vector<std::set<std::string>> keys;
  const auto refuse_duplicates = [&](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
      throw InputError(from + ": duplicate key \"" + printable(value.get<std::string>()) +
                       "\"; expected each key once");
    return true;
  };
  try {
    return Json::parse(text, refuse_duplicates);
  } catch (const Json::parse_error& error) {
    throw InputError(from + ": byte " + std::to_string(error.byte) +
                     ": no JSON; expected a strokes file");
  } catch (const Json::out_of_range&) {
    throw InputError(from + ": a number out of range; expected a strokes file");
  }
}

}  // namespace

std::string strokes_json(const StrokesFile& strokes) {
  const Json head{{"format", k_format_name},
                  {"version", k_format_version},
                  {"frame", "robot"},
                  {"tool", strokes.tool},
                  {"unix_offset_ns", strokes.unix_offset.nanoseconds}};
  std::string text = head.dump(1, ' ', true, Json::error_handler_t::replace);
  text.resize(text.size() - 2);  // "\n}"
  text += ",\n \"elements\": [";
  for (const PathElement& element : strokes.path) {
    text += std::string(&element == &strokes.path.front() ? "\n" : ",\n") +
            "  {\"name\": " + Json(element.name).dump() + ", \"kind\": \"" + name_of(element.kind) +
            "\", \"points\": [";
    for (const UncertainPose& point : element.points) {
      const Json line{{"time_ns", point.time.nanoseconds},
                      {"position_m", array_of(point.pose.translation)},
                      {"rotation_xyzw", array_of(point.pose.rotation.coeffs())},
                      {"covariance", array_of(point.covariance)}};
      text += (&point == &element.points.front() ? "\n   " : ",\n   ") + line.dump();
    }
    text += "]}";
  }
  return text + "]\n}\n";
}

StrokesFile strokes_of_json(const std::string& text, const std::string& from) {
  const Json json = parsed(text, from);
  const Place root{json, from};
  root.require_keys({"format", "version", "frame", "tool", "unix_offset_ns", "elements"});
  root.at("format").require(json["format"] == k_format_name, k_format_name);
  root.at("version").require(json["version"] == k_format_version, std::to_string(k_format_version));
  root.at("frame").require(json["frame"] == "robot", "robot");
  StrokesFile strokes;
  strokes.tool = root.at("tool").text();
  strokes.unix_offset = Duration{root.at("unix_offset_ns").nanoseconds()};
  std::set<std::string> names;
  for (const Place& place : root.at("elements").items(0, k_strokes_max, "elements")) {
    strokes.path.push_back(element_of(place));
    place.at("name").require(names.insert(strokes.path.back().name).second,
                             "a name that no earlier element has");
  }
  return strokes;
}

StrokesFile read_strokes(const std::string& file) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  if (failed) throw InputError(file + ": cannot be opened; expected a strokes file");
  if (size > k_strokes_bytes_max) {
    throw InputError(file + ": " + std::to_string(size) + " bytes; expected at most " +
                     std::to_string(k_strokes_bytes_max));
  }
  std::ifstream in(file, std::ios::binary);
  return strokes_of_json({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()},
                         file);
}

}  // namespace glint

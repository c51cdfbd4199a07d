#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "platform/cells/depth_bias_table.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/input_error.hpp"
#include "platform/nearest_name.hpp"

namespace glint {
namespace {

constexpr double k_radius_max_mm = 100.0;
constexpr double k_sigma_max_mm = 10.0;

std::string place_of(const std::string& path, const toml::node& node) {
  return path + ":" + std::to_string(node.source().begin.line);
}

// Returns a number within [low, high], or throws InputError.
double number_at(const toml::node& node, const std::string& what, double low, double high,
                 const std::string& path) {
  std::ostringstream expected;
  expected << "; expected a number from " << low << " to " << high;
  const auto value = node.value<double>();
  if (!node.is_number() || !value) {
    throw InputError(place_of(path, node) + ": " + what + " is not a number" + expected.str());
  }
  if (!(*value >= low && *value <= high)) {
    std::ostringstream found;
    found << *value;
    throw InputError(place_of(path, node) + ": " + what + " is " + found.str() + expected.str());
  }
  return *value;
}

Vector3 point_at(const toml::node& node, const std::string& what, const std::string& path) {
  const toml::array* numbers = node.as_array();
  if (numbers == nullptr || numbers->size() != 3) {
    throw InputError(place_of(path, node) + ": " + what +
                     " is not a point; expected [x, y, z] in millimetres");
  }
  Vector3 point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point(static_cast<int>(axis)) =
        1e-3 * number_at(*numbers->get(axis), what, -k_tool_coordinate_max_mm,
                         k_tool_coordinate_max_mm, path);
  }
  return point;
}

const toml::node& required(const toml::table& table, const char* key, const std::string& expected,
                           const std::string& path) {
  const toml::node* node = table.get(key);
  if (node == nullptr) throw InputError(path + ":1: " + key + " is missing; expected " + expected);
  return *node;
}

std::string text_at(const toml::node& node, const char* key, const std::string& path) {
  const auto text = node.value_exact<std::string>();
  if (!text) {
    throw InputError(place_of(path, node) + ": " + key + " is not text; expected text in quotes");
  }
  return *text;
}

void refuse_unknown_keys(const toml::table& table, const std::string& path) {
  const std::vector<std::string> known = {"name",      "markers_mm", "marker_sigma_mm",
                                          "radius_mm", "tip_mm",     "tip_sigma_mm",
                                          "shape",     "depth_bias"};
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    throw InputError(path + ":" + std::to_string(key.source().begin.line) + ": unknown key " +
                     std::string(key.str()) + nearest_name_text(key.str(), known) +
                     "; expected name, markers_mm, marker_sigma_mm, radius_mm, tip_mm, "
                     "tip_sigma_mm, shape or depth_bias");
  }
}

MarkerShape shape_in(const toml::table& table, const std::string& path) {
  const toml::node* node = table.get("shape");
  if (node == nullptr) return MarkerShape::sphere;
  const std::string shape = text_at(*node, "shape", path);
  if (shape == "sphere") return MarkerShape::sphere;
  if (shape == "disc") return MarkerShape::disc;
  throw InputError(place_of(path, *node) + ": shape is \"" + shape +
                   "\"; expected \"sphere\" or \"disc\"");
}

// Bias of markers other than those of the camera's own bias.
DepthBias bias_in(const toml::table& table, const std::string& path) {
  const toml::node* node = table.get("depth_bias");
  if (node == nullptr) return {};
  if (node->as_table() == nullptr) {
    throw InputError(place_of(path, *node) +
                     ": depth_bias is not a table; expected [depth_bias], as in a file of `glint "
                     "calibrate depth`");
  }
  return depth_bias_of(*node->as_table(), path, "depth_bias.");
}

}  // namespace

Tool tool_from_toml_text(std::string_view text, const std::string& path) {
  const toml::table table = parse_toml(std::string(text), path);
  refuse_unknown_keys(table, path);
  Tool tool;
  const toml::node& name = required(table, "name", "a text in quotes", path);
  set_name(tool, text_at(name, "name", path), place_of(path, name));
  const toml::node& markers =
      required(table, "markers_mm", "3 to 8 points [x, y, z] in millimetres", path);
  const toml::array* points = markers.as_array();
  if (points == nullptr) {
    throw InputError(place_of(path, markers) +
                     ": markers_mm is not a list; expected 3 to 8 points [x, y, z]");
  }
  check_marker_count(static_cast<long long>(points->size()), place_of(path, markers));
  for (std::size_t i = 0; i < points->size(); ++i) {
    tool.markers_m[i] = point_at(*points->get(i), "markers_mm[" + std::to_string(i) + "]", path);
  }
  tool.marker_count = static_cast<int>(points->size());
  tool.marker_radius_m = 1e-3 * number_at(required(table, "radius_mm", "a number", path),
                                          "radius_mm", 0.0, k_radius_max_mm, path);
  tool.tip_m = point_at(required(table, "tip_mm", "a point [x, y, z]", path), "tip_mm", path);
  tool.shape = shape_in(table, path);
  if (const toml::node* sigma = table.get("marker_sigma_mm"))
    tool.marker_sigma_m = 1e-3 * number_at(*sigma, "marker_sigma_mm", 0.0, k_sigma_max_mm, path);
  if (const toml::node* sigma = table.get("tip_sigma_mm"))
    tool.tip_sigma_m = 1e-3 * number_at(*sigma, "tip_sigma_mm", 0.0, k_sigma_max_mm, path);
  tool.depth_bias = bias_in(table, path);
  return prepared(tool, place_of(path, markers));
}

}  // namespace glint

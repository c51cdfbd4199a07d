#include "platform/cells/tool_writer.hpp"

#include <cstdio>
#include <sstream>

#include "platform/cells/depth_bias_table.hpp"

namespace glint {
namespace {

std::string point_mm(const Vector3& point_m) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.4f, %.4f, %.4f]", 1e3 * point_m.x(), 1e3 * point_m.y(),
                1e3 * point_m.z());
  return text;
}

// Text in quotes, as a basic string of TOML.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace

std::string file_name_of(const Tool& tool) {
  std::string name = tool.name.data();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    if (!plain) c = '_';
  }
  return name;
}

std::string tool_toml_text(const Tool& tool, std::string_view comment) {
  std::string text;
  std::istringstream lines{std::string(comment)};
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  text += "name = " + quoted(tool.name.data()) + "\nmarkers_mm = [\n";
  for (int i = 0; i < tool.marker_count; ++i) {
    text += "  " + point_mm(tool.markers_m[static_cast<std::size_t>(i)]) + ",\n";
  }
  char sizes[96];
  std::snprintf(sizes, sizeof sizes, "]\nmarker_sigma_mm = %.4f\nradius_mm = %.4f\n",
                1e3 * tool.marker_sigma_m, 1e3 * tool.marker_radius_m);
  text += sizes;
  text += "tip_mm = " + point_mm(tool.tip_m) + "\n";
  std::snprintf(sizes, sizeof sizes, "tip_sigma_mm = %.4f\n", 1e3 * tool.tip_sigma_m);
  text += sizes;
  text += tool.shape == MarkerShape::sphere ? "shape = \"sphere\"\n" : "shape = \"disc\"\n";
  const std::string bias = depth_bias_text(tool.depth_bias);
  return bias.empty() ? text : text + "\n[depth_bias]\n" + bias;
}

}  // namespace glint

#include "platform/runtime/session/recorded_cell.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

using nlohmann::json;

constexpr const char* k_named_ending = ".toml";

json as_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Vector3 vector_of(const json& item) {
  return Vector3(item.at(0).get<double>(), item.at(1).get<double>(), item.at(2).get<double>());
}

json as_json(const DepthBias& bias) {
  return {{"offset_m", bias.offset_m},
          {"per_metre", bias.per_metre},
          {"dim_m", bias.low_signal_m},
          {"range_m", {bias.range_min_m, bias.range_max_m}}};
}
DepthBias bias_of(const json& item) {
  const json& range = item.at("range_m");
  return {item.at("offset_m"), item.at("per_metre"), item.at("dim_m"), range.at(0), range.at(1)};
}

json as_json(const ToolSet& set) {
  json tools = json::array();
  for (int t = 0; t < set.count; ++t) {
    const Tool& tool = set.items[static_cast<std::size_t>(t)];
    json markers = json::array();
    for (int m = 0; m < tool.marker_count; ++m) {
      markers.push_back(as_json(tool.markers_m[static_cast<std::size_t>(m)]));
    }
    tools.push_back({{"name", std::string(tool.name.data())},
                     {"markers_m", markers},
                     {"marker_radius_m", tool.marker_radius_m},
                     {"shape", tool.shape == MarkerShape::sphere ? "sphere" : "disc"},
                     {"tip_m", as_json(tool.tip_m)},
                     {"marker_sigma_m", tool.marker_sigma_m},
                     {"tip_sigma_m", tool.tip_sigma_m}});
    if (tool.depth_bias.is_measured()) tools.back()["depth_bias"] = as_json(tool.depth_bias);
  }
  return tools;
}

ToolSet tools_of(const json& tools, const std::string& path) {
  ToolSet set;
  for (const json& item : tools) {
    if (set.count == k_tools_max) throw InputError(path + ": tools.json holds too many tools");
    Tool& tool = set.items[static_cast<std::size_t>(set.count++)];
    const std::string name = printable(item.at("name").get<std::string>());
    std::copy_n(name.begin(), std::min(name.size(), tool.name.size() - 1), tool.name.begin());
    for (const json& marker : item.at("markers_m")) {
      if (tool.marker_count == k_markers_per_tool_max) break;
      tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = vector_of(marker);
    }
    tool.marker_radius_m = item.at("marker_radius_m");
    tool.shape = item.at("shape") == "disc" ? MarkerShape::disc : MarkerShape::sphere;
    tool.tip_m = vector_of(item.at("tip_m"));
    tool.marker_sigma_m = item.value("marker_sigma_m", tool.marker_sigma_m);
    tool.tip_sigma_m = item.value("tip_sigma_m", 0.0);  // older recordings state none
    if (item.contains("depth_bias")) tool.depth_bias = bias_of(item.at("depth_bias"));
    if (const Reason reason = prepare_tool(tool); reason != Reason::none) {
      throw InputError(path + ": tools.json: tool " + name + " is " + std::string(name_of(reason)) +
                       "; expected a rigid body of markers");
    }
  }
  return set;
}

}  // namespace

ToolSet tools_from_json(std::string_view text, const std::string& path) {
  try {
    return tools_of(json::parse(text.begin(), text.end()), path);
  } catch (const json::exception& error) {
    throw InputError(path + ": attachment tools.json: " + error.what() +
                     "; expected the tools that `glint run` records");
  }
}

std::vector<Attachment> attachments_of(const Cell& cell) {
  std::vector<Attachment> attachments;
  attachments.push_back(text_attachment("cell.toml", cell.text));
  attachments.push_back(text_attachment("tools.json", as_json(cell.tools).dump(1)));
  if (cell.camera.table != nullptr) {
    Attachment rays{"rays.f32", "application/octet-stream", {}};
    rays.data.resize(cell.camera.table->size() * sizeof(float));
    std::memcpy(rays.data.data(), cell.camera.table->data(), rays.data.size());
    attachments.push_back(std::move(rays));
  }
  for (const NamedFile& named : cell.named_files) {
    attachments.push_back(text_attachment(named.key + k_named_ending, named.text));
  }
  return attachments;
}

Cell recorded_cell(RecordingReader& reader, const std::string& path) {
  const Attachment text = reader.attachment("cell.toml");
  const Attachment tools = reader.attachment("tools.json");
  CellFiles files;
  files.tools = tools_from_json(std::string(tools.data.begin(), tools.data.end()), path);
  const auto names = reader.attachment_names();
  if (std::find(names.begin(), names.end(), "rays.f32") != names.end()) {
    const Attachment rays = reader.attachment("rays.f32");
    std::vector<float> values(rays.data.size() / sizeof(float));
    std::memcpy(values.data(), rays.data.data(), values.size() * sizeof(float));
    files.rays = std::make_shared<const std::vector<float>>(std::move(values));
  }
  for (const char* key : k_named_keys) {
    const std::string name = std::string(key) + k_named_ending;
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    const Attachment named = reader.attachment(name);
    files.named[key] = {named.data.begin(), named.data.end()};
  }
  Cell cell = cell_from_text({text.data.begin(), text.data.end()}, path + ":cell.toml", &files);
  if (!cell.ray_table.empty() && files.rays == nullptr) {
    throw InputError(path +
                     ": no attachment rays.f32; expected the calibration that the cell names");
  }
  return cell;
}

}  // namespace glint

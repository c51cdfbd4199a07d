#include "platform/cells/cell.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "glint_default_cell.hpp"
#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "platform/cells/calibration_files.hpp"
#include "platform/cells/cell_camera.hpp"
#include "platform/cells/cell_can.hpp"
#include "platform/cells/cell_files.hpp"
#include "platform/cells/cell_headset.hpp"
#include "platform/cells/cell_mapping.hpp"
#include "platform/cells/cell_timing.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cells/tool_notices.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

struct CellParser : CellFileReader {
  const NamedFile* named_by(TomlReader& root, const std::string& section);
  void read_robot(const toml::table* table);
  void read_robot_description(const std::string& path);
  void read_source(const toml::table* table);
  void read_simulator(const toml::table* table);
  void read_tools(TomlReader& root);
};

Quaternion from_fixed_axes(const std::vector<double>& degrees) {
  const auto about = [&](int axis) {
    const SineCosine half =
        sine_cosine(0.5 * degrees[static_cast<std::size_t>(axis)] * k_radians_per_degree);
    Vector3 v = Vector3::Zero();
    v[axis] = half.sine;
    return Quaternion(half.cosine, v.x(), v.y(), v.z());
  };
  return about(2) * about(1) * about(0);
}

// Reads [section] file = ".."; returns null if absent.
const NamedFile* CellParser::named_by(TomlReader& root, const std::string& section) {
  const toml::table* table = root.table(section.c_str());
  if (table == nullptr) return nullptr;
  TomlReader reader(*table, cell.file, section + ".");
  const std::string path = reader.text("file", "");
  reader.done();
  return path.empty() ? nullptr : &named_file(path, section + ".file");
}

void CellParser::read_source(const toml::table* table) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "source.");
  cell.source.kind = reader.text("kind", cell.source.kind);
  cell.source.path = resolved(reader.text("path", ""), "source.path");
  cell.source.calibration = resolved(reader.text("calibration", ""), "source.calibration");
  cell.source.reflectivity_topic = reader.text("reflectivity_topic", "");
  cell.source.depth_topic = reader.text("depth_topic", "");
  cell.source.camera_info_topic = reader.text("camera_info_topic", "");
  cell.source.pose_topic = reader.text("pose_topic", "");
  cell.source.world_frame = reader.text("world_frame", "");
  if (table->contains("domain")) {
    cell.source.domain = static_cast<int>(reader.integer("domain", 0, 0, 232));
  }
  cell.source.reliable = reader.boolean("reliable", false);
  cell.source.host = reader.text("host", "");
  cell.source.port = static_cast<int>(reader.integer("port", cell.source.port, 0, 65535));
  cell.source.divisor = static_cast<int>(reader.integer("divisor", cell.source.divisor, 1, 255));
  cell.source.clock_port =
      static_cast<int>(reader.integer("clock_port", cell.source.clock_port, 0, 65535));
  cell.source.position = cell.file + ":" + std::to_string(reader.line_of("kind")) + ": source";
  reader.done();
  const auto of_kinds = [&](std::initializer_list<const char*> kinds,
                            std::initializer_list<const char*> keys) {
    std::string names;
    for (const char* kind : kinds) {
      if (cell.source.kind == kind) return;
      names += (names.empty() ? "" : " or ") + std::string(kind);
    }
    for (const char* key : keys) {
      if (!table->contains(key)) continue;
      throw InputError(cell.file + ":" + std::to_string(reader.line_of(key)) + ": source." + key +
                       ": only for kind " + names + "; expected no such key for " +
                       printable(cell.source.kind));
    }
  };
  of_kinds({"hl2ss_file", "hl2ss"}, {"calibration"});
  of_kinds({"hl2ss"}, {"host", "port", "divisor", "clock_port"});
  of_kinds({"dds", "rosbag"},
           {"reflectivity_topic", "depth_topic", "camera_info_topic", "pose_topic", "world_frame"});
  of_kinds({"dds"}, {"domain", "reliable"});
  const bool over_network = cell.source.kind == "dds" || cell.source.kind == "hl2ss";
  if (over_network && table->contains("path")) {
    throw InputError(cell.file + ":" + std::to_string(reader.line_of("path")) +
                     ": source.path: not used by " + cell.source.kind + "; expected " +
                     (cell.source.kind == "dds" ? "topics" : "host"));
  }
}

void CellParser::read_simulator(const toml::table* table) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "simulator.");
  SimulatorSettings& sim = cell.simulator;
  sim.scenario =
      reader.one_of("scenario", sim.scenario,
                    {"default", "still", "touches", "trajectories", "field", "field_board",
                     "field_turn", "field_pivot", "field_rest", "field_look"});
  sim.duration_s = reader.real("duration_s", sim.duration_s, 0.1, 3600);
  sim.seed = static_cast<std::uint64_t>(reader.integer("seed", 1, 0, INT64_MAX));
  sim.pen_scale = reader.real("pen_scale", sim.pen_scale, 0.001, 10);
  if (table->contains("marker_range_sigma_mm"))
    sim.marker_range_sigma_m = 1e-3 * reader.real("marker_range_sigma_mm", 0, 0, 20);
  if (table->contains("marker_pixel_sigma_px"))
    sim.marker_pixel_sigma_px = reader.real("marker_pixel_sigma_px", 0, 0, 2);
  sim.background_layout =
      reader.one_of("background_layout", sim.background_layout, {"adi", "ahat", "pgm"});
  const auto path = [&](const char* key) {
    return resolved(reader.text(key, ""), std::string("simulator.") + key);
  };
  sim.head_trajectory = path("head_trajectory");
  sim.pen_trajectory = path("pen_trajectory");
  sim.background = path("background");
  sim.ground_truth_cell = path("drawn");
  reader.done();
  constexpr double k_field_s_min = 5;
  if (sim.scenario.starts_with("field") && sim.duration_s < k_field_s_min) {
    throw InputError(cell.file + ":" + std::to_string(reader.line_of("duration_s")) +
                     ": simulator.duration_s: found " + std::to_string(sim.duration_s) +
                     "; expected at least 5 for scenario \"" + sim.scenario + "\"");
  }
  if (sim.scenario == "trajectories" &&
      (sim.head_trajectory.empty() || sim.pen_trajectory.empty())) {
    throw InputError(cell.file + ":" + std::to_string(table->source().begin.line) +
                     ": scenario \"trajectories\"; expected head_trajectory and pen_trajectory");
  }
}

AllowedInputs allowed_inputs(TomlReader& dds, const std::string& file) {
  AllowedInputs allowed;
  for (const std::string& name : dds.texts("allow")) {
    const auto found = std::find(k_dds_input_names.begin(), k_dds_input_names.end(), name);
    if (found == k_dds_input_names.end()) {
      std::string all;
      for (const char* one : k_dds_input_names) all += (all.empty() ? "" : ", ") + std::string(one);
      throw InputError(file + ":" + std::to_string(dds.line_of("allow")) + ": dds.allow: \"" +
                       name + "\"; expected names of inputs: " + all);
    }
    allowed.add(static_cast<DdsInput>(found - k_dds_input_names.begin()));
  }
  // Cells of recordings from before `allow` have this key.
  if (dds.boolean("tool_changes", false)) allowed.add(DdsInput::tools);
  return allowed;
}

RosGraph ros_graph_of(const std::string& name) {
  if (name == "off") return RosGraph::off;
  return name == "humble" ? RosGraph::humble : RosGraph::iron;
}

void read_sinks(TomlReader& root, const CellFileReader& files, Cell& cell) {
  read_can(root.table("can"), cell);
  if (const toml::table* table = root.table("dds")) {
    TomlReader reader(*table, cell.file, "dds.");
    cell.dds.on = reader.boolean("on", cell.dds.on);
    cell.dds.interface = reader.text("interface", cell.dds.interface);
    cell.dds.domain = static_cast<int>(reader.integer("domain", cell.dds.domain, 0, 232));
    cell.dds.allow = allowed_inputs(reader, cell.file);
    cell.dds.name = reader.text("name", cell.dds.name);
    cell.dds.ros_graph = ros_graph_of(reader.one_of("ros_graph", "off", {"off", "humble", "iron"}));
    cell.dds.security = files.resolved(reader.text("security", ""), "dds.security");
    reader.done();
  }
  if (const toml::table* table = root.table("openigtlink")) {
    TomlReader reader(*table, cell.file, "openigtlink.");
    OpenIgtLinkSettings& server = cell.openigtlink.emplace();
    server.address = reader.text("address", server.address);
    server.port = static_cast<int>(reader.integer("port", server.port, 1, 65535));
    server.period = from_ms(reader.real("period_ms", 20, 1, 1000));
    reader.done();
  }
  if (const toml::table* table = root.table("buttons")) {
    TomlReader reader(*table, cell.file, "buttons.");
    cell.button_timeout = from_ms(reader.real("timeout_ms", 10'000, 100, 3'600'000));
    reader.done();
  }
  if (const toml::table* table = root.table("files")) {
    TomlReader reader(*table, cell.file, "files.");
    cell.files.tum = reader.text("tum", cell.files.tum);
    cell.files.csv = reader.text("csv", cell.files.csv);
    reader.done();
  }
  if (const toml::table* table = root.table("record")) {
    TomlReader reader(*table, cell.file, "record.");
    cell.record.file = reader.text("file", cell.record.file);
    cell.record.level =
        reader.one_of("level", cell.record.level, {"full", "roi", "blobs", "outputs"});
    cell.record.pictures = reader.boolean("pictures", cell.record.pictures);
    reader.done();
  }
}

constexpr std::size_t k_urdf_bytes_max = std::size_t{4} << 20;
constexpr double k_robot_sigma_max_mm = 1000, k_robot_sigma_max_deg = 90;

void CellParser::read_robot(const toml::table* table) {
  cell.robot_valid = table != nullptr;
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "robot.");
  if (const auto position = reader.reals("position_mm", 3)) {
    cell.T_world_robot.translation = Vector3((*position)[0], (*position)[1], (*position)[2]) * 1e-3;
  }
  if (const auto rotation = reader.reals("rotation_deg", 3)) {
    cell.T_world_robot.rotation = from_fixed_axes(*rotation);
  }
  cell.robot_sigma_m =
      1e-3 * reader.real("position_sigma_mm", 1e3 * cell.robot_sigma_m, 0, k_robot_sigma_max_mm);
  cell.robot_sigma_rad =
      k_radians_per_degree * reader.real("rotation_sigma_deg",
                                         k_degrees_per_radian * cell.robot_sigma_rad, 0,
                                         k_robot_sigma_max_deg);
  cell.robot_in_reference = reader.one_of("frame", "world", {"world", "reference"}) == "reference";
  if (cell.robot_in_reference && cell.reference < 0) {
    throw InputError(cell.file + ":" + std::to_string(reader.line_of("frame")) +
                     ": robot.frame is \"reference\" without a reference; expected reference = "
                     "\"NAME\" at the top, a listed tool at rest");
  }
  if (const std::string path = reader.text("urdf", ""); !path.empty()) read_robot_description(path);
  reader.done();
}

// Only viewers read it: the tracker has no model of the robot.
void CellParser::read_robot_description(const std::string& path) {
  const NamedFile& file = named_file(path, k_urdf_key);
  if (file.text.size() <= k_urdf_bytes_max && file.text.find("<robot") != std::string::npos) return;
  throw InputError(file.path + ": " + std::to_string(file.text.size()) +
                   " bytes without a robot element, or too many; expected a URDF file of at most " +
                   std::to_string(k_urdf_bytes_max) + " bytes");
}

void CellParser::read_tools(TomlReader& root) {
  cell.tool_files = root.texts("tools");
  if (cell.tool_files.empty()) cell.tool_files = {"pen"};
  if (cell.tool_files.size() > static_cast<std::size_t>(k_tools_max)) {
    throw InputError(cell.file + ":" + std::to_string(root.line_of("tools")) + ": " +
                     std::to_string(cell.tool_files.size()) + " tools; expected at most " +
                     std::to_string(k_tools_max));
  }
  if (recorded_files != nullptr) {
    cell.tools = recorded_files->tools;
    return;
  }
  for (const std::string& name : cell.tool_files) {
    const std::optional<Tool> built_in = built_in_tool(name);
    cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] =
        built_in ? *built_in : load_tool(resolved(name, "tools"));
  }
  // Topics, frames and columns are named after the tool, so names must be unique.
  for (int t = 1; t < cell.tools.count; ++t) {
    for (int other = 0; other < t; ++other) {
      const std::string name = cell.tools.items[static_cast<std::size_t>(t)].name.data();
      if (name != cell.tools.items[static_cast<std::size_t>(other)].name.data()) continue;
      throw InputError(cell.file + ": tools " + std::to_string(other + 1) + " and " +
                       std::to_string(t + 1) + " are both named \"" + name +
                       "\"; expected different names");
    }
  }
  cell.warnings = tool_warnings(cell.tools, cell.tool_files,
                                cell.file + ":" + std::to_string(root.line_of("tools")));
}

}  // namespace

Cell cell_from_text(const std::string& text, const std::string& file,
                    const CellFiles* recorded_files) {
  Cell cell;
  CellParser parser{{cell, recorded_files}};
  cell.file = file;
  cell.text = text;
  const toml::table table = parse_toml(text, file);
  TomlReader root(table, file, "");
  (void)root.text("name", "");
  read_camera(root.table("camera"), cell, parser);
  parser.read_tools(root);
  read_tool_changes(root, cell);
  read_reference(root, cell);
  read_headset(root.table("headset"), cell);
  parser.read_source(root.table("source"));
  parser.read_simulator(root.table("simulator"));
  read_rates(root.table("rates"), cell);
  read_deadlines(root.table("deadlines"), cell);
  read_overrun(root.table("overrun"), cell);
  read_budget(root.table("budget"), cell);
  read_background(
      root.table("background"), root.table("mapping"),
      [&](const std::string& path, const std::string& key) { return parser.resolved(path, key); },
      cell);
  read_sinks(root, parser, cell);
  parser.read_robot(root.table("robot"));
  check_tracked_robot(root.table("mapping"), cell);
  if (const NamedFile* named = parser.named_by(root, "motion")) cell.motion = motion_of(*named);
  if (const NamedFile* named = parser.named_by(root, "correction")) {
    cell.correction = correction_of(*named);
  }
  root.done();
  return cell;
}

Vector3 fixed_axes_deg(const Quaternion& rotation) {
  const Matrix3 r = rotation.toRotationMatrix();
  const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  return k_degrees_per_radian *
         Vector3(std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0)));
}

Limits limits_of(const Cell& cell) {
  const CameraModel& camera = cell.camera.model;
  Limits limits;
  limits.width = camera.width;
  limits.height = camera.height;
  limits.reflectivity_bytes = (cell.camera.reflectivity_bits + 7) / 8;
  limits.lens_steps = ray_search_of(camera.lens) == RaySearch::table ? k_lens_steps_max : 0;
  limits.ray_steps = cell.ray_steps;
  limits.tools = std::max(cell.budget.tools, cell.tools.count);  // some are added after reading
  limits.markers_per_tool = 3;
  for (int t = 0; t < cell.tools.count; ++t) {
    limits.markers_per_tool = std::max(limits.markers_per_tool,
                                       cell.tools.items[static_cast<std::size_t>(t)].marker_count);
  }
  limits.blobs = cell.budget.blobs;
  limits.runs_per_band = cell.budget.runs_per_band;
  limits.search_steps = cell.budget.search_steps;
  if (cell.can.format == CanFormat::fd_covariance) limits.covariance_frames = limits.tools;
  if (cell.background) limits.background_steps = cell.background->steps;
  const bool follows = cell.mapping && !cell.mapping->model.empty();
  limits.tracking_steps = follows ? limits.background_steps : 0;
  return limits;
}

Cell default_cell() { return cell_from_text(k_default_cell, "built-in default cell"); }

Cell load_cell(const std::string& file) { return cell_from_text(read_text(file), file); }

}  // namespace glint

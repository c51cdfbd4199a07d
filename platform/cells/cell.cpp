#include "platform/cells/cell.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "glint_default_cell.hpp"
#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "kernels/pose/local_rays.hpp"
#include "platform/cells/calibration_files.hpp"
#include "platform/cells/cell_can.hpp"
#include "platform/cells/cell_headset.hpp"
#include "platform/cells/cell_mapping.hpp"
#include "platform/cells/cell_timing.hpp"
#include "platform/cells/depth_bias_table.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cells/tool_notices.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

// ${NAME} becomes the environment's NAME; a relative path starts at the cell file's folder.
std::string opened_path(const std::string& path, const std::string& key, const std::string& cell) {
  if (path.empty()) return path;
  std::string text = path;
  for (std::size_t from = text.find("${"); from != std::string::npos; from = text.find("${")) {
    const std::size_t to = text.find('}', from);
    const std::string name = to == std::string::npos ? "" : text.substr(from + 2, to - from - 2);
    const char* value = name.empty() ? nullptr : std::getenv(name.c_str());
    if (value == nullptr) {
      throw InputError(cell + ": " + key + " is \"" + path + "\": the environment has no " +
                       (name.empty() ? "closing }" : name) + "; expected it to be set");
    }
    text.replace(from, to - from + 1, value);
  }
  const std::filesystem::path file(text);
  if (file.is_absolute()) return text;
  return (std::filesystem::path(cell).parent_path() / file).lexically_normal().string();
}

// Reads a cell; paths stay as written where a recording carries what they name.
struct CellParser {
  Cell& cell;
  const CellFiles* carried;

  std::string resolved(const std::string& path, const std::string& key) const {
    return carried != nullptr ? path : opened_path(path, key, cell.file);
  }
  void read_camera(const toml::table* table);
  const NamedFile& named_file(const std::string& path, const std::string& key);
  void read_depth_bias(TomlReader& camera);
  void read_lens(const std::string& path, std::uint32_t line);
  const NamedFile* named_by(TomlReader& root, const std::string& section);
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

// A file of `glint calibrate`, or what a recording carries of it.
const NamedFile& CellParser::named_file(const std::string& path, const std::string& key) {
  NamedFile named{key, resolved(path, key), ""};
  if (carried == nullptr) {
    named.text = read_text(named.path);
  } else if (const auto text = carried->named.find(key); text != carried->named.end()) {
    named.text = text->second;
  } else {
    throw InputError(cell.file + ": no attachment " + key + ".toml; expected the file \"" + path +
                     "\" that the cell names");
  }
  return cell.named_files.emplace_back(std::move(named));
}

// A table of its own, or the file that has it.
void CellParser::read_depth_bias(TomlReader& camera) {
  if (camera.is_text("depth_bias")) {
    const std::string path = camera.text("depth_bias", "");
    cell.camera.depth.bias = depth_bias_of(named_file(path, "camera.depth_bias"));
  } else if (const toml::table* table = camera.table("depth_bias")) {
    cell.camera.depth.bias = depth_bias_of(*table, cell.file, "camera.depth_bias.");
  }
}

void CellParser::read_lens(const std::string& path, std::uint32_t line) {
  if (path.empty()) return;
  if (!cell.ray_table.empty()) {
    throw InputError(cell.file + ":" + std::to_string(line) +
                     ": camera.file beside camera.ray_table; expected one lens, not two");
  }
  cell.camera.model = lens_of(named_file(path, "camera.file"), cell.camera.model);
}

// [section] file = ".."; null where there is none.
const NamedFile* CellParser::named_by(TomlReader& root, const std::string& section) {
  const toml::table* table = root.table(section.c_str());
  if (table == nullptr) return nullptr;
  TomlReader reader(*table, cell.file, section + ".");
  const std::string path = reader.text("file", "");
  reader.done();
  return path.empty() ? nullptr : &named_file(path, section + ".file");
}

void CellParser::read_camera(const toml::table* table) {
  static const toml::table k_empty;
  TomlReader reader(table ? *table : k_empty, cell.file, "camera.");
  const std::string model =
      reader.one_of("model", "hololens2_ahat", {"hololens2_ahat", "hololens1_short_throw"});
  cell.camera = model == "hololens2_ahat" ? hololens2_ahat() : hololens1_short_throw();
  cell.ray_table = resolved(reader.text("ray_table", ""), "camera.ray_table");
  read_lens(reader.text("file", ""), reader.line_of("file"));
  const int top = cell.camera.reflectivity_bits == 8 ? 255 : 65535;
  cell.camera.threshold =
      static_cast<std::uint16_t>(reader.integer("threshold", cell.camera.threshold, 1, top - 1));
  cell.arrival_jitter = from_ms(reader.real("arrival_jitter_ms", 0.4, 0, 10));
  read_depth_bias(reader);
  reader.done();
  if (cell.camera.model.width > k_width_max || cell.camera.model.height > k_height_max) {
    throw InputError(cell.file + ":" + std::to_string(reader.line_of("model")) + ": " + model +
                     " has " + std::to_string(cell.camera.model.width) + " x " +
                     std::to_string(cell.camera.model.height) + " pixels; expected at most " +
                     std::to_string(k_width_max) + " x " + std::to_string(k_height_max));
  }
  if (cell.ray_table.empty()) return;
  if (carried == nullptr) {
    cell.camera = with_ray_table(cell.camera, cell.ray_table);
  } else if (carried->rays != nullptr) {
    const std::size_t expected = static_cast<std::size_t>(cell.camera.model.width) *
                                 static_cast<std::size_t>(cell.camera.model.height) * 3;
    if (carried->rays->size() != expected) {
      throw InputError(cell.file + ": rays.f32 has " + std::to_string(carried->rays->size()) +
                       " numbers; expected " + std::to_string(expected) + ", 3 for each pixel");
    }
    cell.camera.table = carried->rays;
    cell.camera.model.lens = Lens::lut;
    cell.camera.model.table = {cell.camera.model.width, cell.camera.model.height,
                               carried->rays->data()};
  }
}

void CellParser::read_source(const toml::table* table) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "source.");
  cell.source.kind = reader.text("kind", cell.source.kind);
  cell.source.path = resolved(reader.text("path", ""), "source.path");
  cell.source.place = cell.file + ":" + std::to_string(reader.line_of("kind")) + ": source";
  reader.done();
}

void CellParser::read_simulator(const toml::table* table) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "simulator.");
  SimulatorSettings& sim = cell.simulator;
  sim.scenario = reader.one_of("scenario", sim.scenario, {"default", "still", "trajectories"});
  sim.duration_s = reader.real("duration_s", sim.duration_s, 0.1, 3600);
  sim.seed = static_cast<std::uint64_t>(reader.integer("seed", 1, 0, INT64_MAX));
  sim.pen_scale = reader.real("pen_scale", sim.pen_scale, 0.001, 10);
  sim.background_layout =
      reader.one_of("background_layout", sim.background_layout, {"adi", "ahat", "pgm"});
  const auto path = [&](const char* key) {
    return resolved(reader.text(key, ""), std::string("simulator.") + key);
  };
  sim.head_trajectory = path("head_trajectory");
  sim.pen_trajectory = path("pen_trajectory");
  sim.background = path("background");
  reader.done();
  if (sim.scenario == "trajectories" &&
      (sim.head_trajectory.empty() || sim.pen_trajectory.empty())) {
    throw InputError(cell.file + ":" + std::to_string(table->source().begin.line) +
                     ": scenario \"trajectories\"; expected head_trajectory and pen_trajectory");
  }
}

void read_sinks(TomlReader& root, Cell& cell) {
  read_can(root.table("can"), cell);
  if (const toml::table* table = root.table("dds")) {
    TomlReader reader(*table, cell.file, "dds.");
    cell.dds.on = reader.boolean("on", cell.dds.on);
    cell.dds.interface = reader.text("interface", cell.dds.interface);
    cell.dds.domain = static_cast<int>(reader.integer("domain", cell.dds.domain, 0, 232));
    cell.dds.tool_changes = reader.boolean("tool_changes", cell.dds.tool_changes);
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
    reader.done();
  }
}

void read_robot(const toml::table* table, Cell& cell) {
  cell.robot_given = table != nullptr;
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "robot.");
  if (const auto position = reader.reals("position_mm", 3)) {
    cell.T_world_robot.translation = Vector3((*position)[0], (*position)[1], (*position)[2]) * 1e-3;
  }
  if (const auto rotation = reader.reals("rotation_deg", 3)) {
    cell.T_world_robot.rotation = from_fixed_axes(*rotation);
  }
  cell.robot_in_reference = reader.one_of("frame", "world", {"world", "reference"}) == "reference";
  if (cell.robot_in_reference && cell.reference < 0) {
    throw InputError(cell.file + ":" + std::to_string(reader.line_of("frame")) +
                     ": robot.frame is \"reference\", but no tool is the reference; expected "
                     "reference = \"NAME\" at the top, a listed tool that does not move");
  }
  reader.done();
}

void CellParser::read_tools(TomlReader& root) {
  cell.tool_files = root.texts("tools");
  if (cell.tool_files.empty()) cell.tool_files = {"pen"};
  if (cell.tool_files.size() > static_cast<std::size_t>(k_tools_max)) {
    throw InputError(cell.file + ":" + std::to_string(root.line_of("tools")) + ": " +
                     std::to_string(cell.tool_files.size()) + " tools; expected at most " +
                     std::to_string(k_tools_max));
  }
  if (carried != nullptr) {
    cell.tools = carried->tools;
    return;
  }
  for (const std::string& name : cell.tool_files) {
    const std::optional<Tool> built_in = built_in_tool(name);
    cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] =
        built_in ? *built_in : load_tool(resolved(name, "tools"));
  }
  // Topics, frames and columns are named after the tool.
  for (int t = 1; t < cell.tools.count; ++t) {
    for (int other = 0; other < t; ++other) {
      const std::string name = cell.tools.items[static_cast<std::size_t>(t)].name.data();
      if (name != cell.tools.items[static_cast<std::size_t>(other)].name.data()) continue;
      throw InputError(cell.file + ": tools " + std::to_string(other + 1) + " and " +
                       std::to_string(t + 1) + " are both named \"" + name +
                       "\"; expected a name of its own for each");
    }
  }
  cell.notices = tool_notices(cell.tools, cell.tool_files,
                              cell.file + ":" + std::to_string(root.line_of("tools")));
}

}  // namespace

Cell cell_from_text(const std::string& text, const std::string& file, const CellFiles* carried) {
  Cell cell;
  CellParser parser{cell, carried};
  cell.file = file;
  cell.text = text;
  const toml::table table = parse_toml(text, file);
  TomlReader root(table, file, "");
  (void)root.text("name", "");
  parser.read_camera(root.table("camera"));
  cell.ray_steps = ray_steps_needed(cell.camera.model);
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
  read_sinks(root, cell);
  read_robot(root.table("robot"), cell);
  check_followed_robot(root.table("mapping"), cell);
  if (const NamedFile* named = parser.named_by(root, "motion")) cell.motion = motion_of(*named);
  if (const NamedFile* named = parser.named_by(root, "correction")) {
    cell.correction = correction_of(*named);
  }
  root.done();
  return cell;
}

void set_camera(Cell& cell, const Camera& camera) {
  cell.camera = camera;
  cell.ray_steps = ray_steps_needed(camera.model);
}

Limits limits_of(const Cell& cell) {
  const CameraModel& camera = cell.camera.model;
  Limits limits;
  limits.width = camera.width;
  limits.height = camera.height;
  limits.reflectivity_bytes = (cell.camera.reflectivity_bits + 7) / 8;
  limits.lens_steps = camera.lens == Lens::lut ? k_lens_steps_max : 0;
  limits.ray_steps = cell.ray_steps;
  limits.tools = std::max(cell.budget.tools, cell.tools.count);  // some join after reading
  limits.markers_per_tool = 3;
  for (int t = 0; t < cell.tools.count; ++t) {
    limits.markers_per_tool = std::max(limits.markers_per_tool,
                                       cell.tools.items[static_cast<std::size_t>(t)].marker_count);
  }
  limits.blobs = cell.budget.blobs;
  limits.runs_per_band = cell.budget.runs_per_band;
  limits.search_steps = cell.budget.search_steps;
  if (cell.background) limits.background_steps = cell.background->steps;
  const bool follows = cell.mapping && !cell.mapping->model.empty();
  limits.reference_steps = follows ? limits.background_steps : 0;
  return limits;
}

Cell default_cell() { return cell_from_text(k_default_cell, "built-in default cell"); }

Cell load_cell(const std::string& file) { return cell_from_text(read_text(file), file); }

}  // namespace glint

#include "platform/cells/cell_headset.hpp"

#include <string>

#include "kernels/angles.hpp"
#include "platform/input_error.hpp"

namespace glint {

void read_reference(TomlReader& root, Cell& cell) {
  const std::string name = root.text("reference", "");
  if (name.empty()) return;
  std::string names;
  for (int t = 0; t < cell.tools.count; ++t) {
    const std::string tool = cell.tools.items[static_cast<std::size_t>(t)].name.data();
    if (tool == name) cell.reference = t;
    names += (t == 0 ? "" : ", ") + tool;
  }
  if (cell.reference >= 0) return;
  throw InputError(cell.file + ":" + std::to_string(root.line_of("reference")) +
                   ": reference is \"" + name + "\"; expected the name of a listed tool: " + names);
}

void read_headset(const toml::table* table, Cell& cell) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "headset.");
  HeadNoise& noise = cell.head_noise;
  noise.rest_position_m = 1e-3 * reader.real("rest_mm", noise.rest_position_m * 1e3, 0, 1000);
  noise.rest_angle_rad =
      k_radians_per_degree *
      reader.real("rest_deg", noise.rest_angle_rad / k_radians_per_degree, 0, 90);
  noise.rest_correlation_s =
      reader.real("rest_correlation_s", noise.rest_correlation_s, 0.01, 10'000);
  noise.position_per_speed_s =
      1e-3 * reader.real("mm_per_m_s", noise.position_per_speed_s * 1e3, 0, 10'000);
  noise.position_per_turn_m =
      1e-3 * reader.real("mm_per_rad_s", noise.position_per_turn_m * 1e3, 0, 10'000);
  noise.angle_per_speed_s_m =
      1e-3 * reader.real("mrad_per_m_s", noise.angle_per_speed_s_m * 1e3, 0, 10'000);
  noise.angle_per_turn_s =
      1e-3 * reader.real("mrad_per_rad_s", noise.angle_per_turn_s * 1e3, 0, 10'000);
  noise.motion_correlation_s =
      reader.real("motion_correlation_s", noise.motion_correlation_s, 0.001, 1000);
  noise.pivot_m = reader.real("pivot_m", noise.pivot_m, 0, 10);
  noise.time_stamp_s = 1e-3 * reader.real("stamp_ms", noise.time_stamp_s * 1e3, 0, 1000);
  reader.done();
}

}  // namespace glint

#include "platform/cells/cell_mapping.hpp"

#include "platform/cells/cell_timing.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

void read_slices(const toml::table& table, Cell& cell) {
  TomlReader reader(table, cell.file, "background.");
  BackgroundSettings& background = cell.background.emplace();
  background.period = from_ms(reader.real("period_ms", background.period.seconds() * 1e3, 1, 1000));
  background.steps =
      static_cast<int>(reader.integer("steps", background.steps, 1, k_background_steps_max));
  reader.done();
}

void read_mapping(const toml::table& table, const ResolvedPath& path, Cell& cell) {
  TomlReader reader(table, cell.file, "mapping.");
  MappingSettings& mapping = cell.mapping.emplace();
  mapping.source = path(reader.text("source", ""), "mapping.source");
  if (mapping.source.empty()) {
    throw InputError(
        cell.file + ":" + std::to_string(table.source().begin.line) +
        ": [mapping] has no source; expected source = \"FOLDER\" of depth images with poses");
  }
  const auto number = [&](const char* key, int otherwise, int low, int high) {
    return static_cast<int>(reader.integer(key, otherwise, low, high));
  };
  mapping.period = from_ms(reader.real("period_ms", mapping.period.seconds() * 1e3, 1, 60'000));
  mapping.images_per_map = number("pictures_a_map", mapping.images_per_map, 1, 1'000'000);
  mapping.stride = number("stride", mapping.stride, 1, 64);
  mapping.voxel_m = 1e-3 * reader.real("voxel_mm", mapping.voxel_m * 1e3, 1, 1000);
  mapping.voxels_max = number("voxels_max", mapping.voxels_max, 1, 1 << 22);
  mapping.model = path(reader.text("model", ""), "mapping.model");
  mapping.joints = reader.numbers("joints");
  mapping.joints_lost_after = from_ms(
      reader.real("joints_lost_after_ms", mapping.joints_lost_after.seconds() * 1e3, 1, 60'000));
  reader.done();
}

}  // namespace

void read_background(const toml::table* background, const toml::table* mapping,
                     const ResolvedPath& path, Cell& cell) {
  if (background != nullptr) read_slices(*background, cell);
  if (mapping == nullptr) return;
  if (!cell.background) cell.background.emplace();
  read_mapping(*mapping, path, cell);
}

void check_tracked_robot(const toml::table* mapping, const Cell& cell) {
  if (!cell.mapping || cell.mapping->model.empty()) return;
  if (cell.robot_valid && !cell.robot_in_reference) return;
  throw InputError(
      cell.file + ":" + std::to_string(mapping->source().begin.line) +
      ": mapping.model starts from the pose in [robot]; expected a [robot] with frame = \"world\"");
}

}  // namespace glint

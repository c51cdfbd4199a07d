#include "platform/cells/cell_camera.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/noise_estimate.hpp"
#include "platform/cells/calibration_files.hpp"
#include "platform/cells/cell_timing.hpp"
#include "platform/cells/depth_bias_table.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr const char* k_lens_key = "camera.file";

[[noreturn]] void throw_input_error(const Cell& cell, std::uint32_t line, const std::string& what) {
  throw InputError(cell.file + ":" + std::to_string(line) + ": camera" + what);
}

// Reads a table in the cell, or the named file that contains it.
void read_depth_bias(TomlReader& reader, Cell& cell, const CellFileReader& files) {
  if (reader.is_text("depth_bias")) {
    const std::string path = reader.text("depth_bias", "");
    const NamedFile file = files.named_file(path, "camera.depth_bias");
    cell.camera.depth.bias = depth_bias_of(file);
    read_range_uncertainty(file, cell.camera.uncertainty);
  } else if (const toml::table* table = reader.table("depth_bias")) {
    cell.camera.depth.bias = depth_bias_of(*table, cell.file, "camera.depth_bias.");
  }
}

void read_size(TomlReader& reader, Camera& camera) {
  const auto side = [&](const char* key, int preset, int most) {
    return static_cast<int>(reader.integer(key, preset, 2, most));
  };
  camera.model.width = side("width", camera.model.width, k_width_max);
  camera.model.height = side("height", camera.model.height, k_height_max);
}

// If the key is absent, the result is bit-identical to the preset.
double metres_of(TomlReader& reader, const char* key, double preset, double low, double high) {
  const double preset_mm = preset * 1e3, mm = reader.real(key, preset_mm, low, high);
  return mm == preset_mm ? preset : mm * 1e-3;
}

Duration duration_of(TomlReader& reader, const char* key, Duration preset, double low,
                     double high) {
  const double preset_ms = static_cast<double>(preset.nanoseconds) * 1e-6;
  const double ms = reader.real(key, preset_ms, low, high);
  return ms == preset_ms ? preset : from_ms(ms);
}

// Uncertainty of a device's own lens, smaller than that of another unit: pixels, and a ratio.
constexpr double k_own_principal_point_px = 0.5, k_own_focal_scale = 0.001;

void use_own_lens(Cell& cell) {
  if (cell.lens_uncertainty_stated) return;
  cell.camera.uncertainty.principal_point_px = k_own_principal_point_px;
  cell.camera.uncertainty.focal_scale = k_own_focal_scale;
}

// Reads a table in the cell, or the named file that contains it.
void read_uncertainty(TomlReader& camera, Cell& cell, const CellFileReader& files) {
  std::optional<NamedFile> file;
  toml::table root;
  const toml::table* table = nullptr;
  if (camera.is_text("uncertainty")) {
    file = files.named_file(camera.text("uncertainty", ""), "camera.uncertainty");
    root = parse_toml(file->text, file->path);
    table = root["uncertainty"].as_table();
    if (table == nullptr) {
      throw InputError(file->path +
                       ":1: no table [uncertainty]; expected a file of `glint calibrate noise "
                       "--recording`");
    }
  } else {
    table = camera.table("uncertainty");
  }
  if (table == nullptr) return;
  TomlReader reader(*table, file ? file->path : cell.file,
                    file ? "uncertainty." : "camera.uncertainty.");
  CameraUncertainty& sigma = cell.camera.uncertainty;
  sigma.range_offset_m = metres_of(reader, "range_offset_mm", sigma.range_offset_m, 0, 100);
  sigma.range_scale = reader.real("range_scale", sigma.range_scale, 0, 0.2);
  cell.lens_uncertainty_stated =
      table->contains("principal_point_px") || table->contains("focal_scale");
  sigma.principal_point_px = reader.real("principal_point_px", sigma.principal_point_px, 0, 50);
  sigma.focal_scale = reader.real("focal_scale", sigma.focal_scale, 0, 0.2);
  sigma.correlated_range_m = metres_of(reader, "slow_range_mm", sigma.correlated_range_m, 0, 20);
  sigma.correlated_centroid_px =
      reader.real("slow_centroid_px", sigma.correlated_centroid_px, 0, 2);
  sigma.fast_share = reader.real("fast_share", sigma.fast_share, 0, 1);
  CorrelationTimes& times = cell.camera.correlation;
  times.fast_s = reader.real("fast_s", times.fast_s, 0.001, 10'000);
  times.slow_s = reader.real("slow_s", times.slow_s, 0.001, 10'000);
  sigma.time_stamp_s = 1e-3 * reader.real("stamp_ms", 1e3 * sigma.time_stamp_s, 0, 100);
  reader.done();
}

void read_sensor(TomlReader& reader, Cell& cell) {
  Camera& camera = cell.camera;
  const bool radial = camera.depth.kind == DepthKind::radial;
  const std::string kind = reader.one_of("depth", radial ? "radial" : "z", {"radial", "z"});
  camera.depth.kind = kind == "radial" ? DepthKind::radial : DepthKind::z;
  camera.depth.unit_m = metres_of(reader, "depth_unit_mm", camera.depth.unit_m, 0.01, 10);
  camera.depth.invalid_from = static_cast<std::uint16_t>(
      reader.integer("depth_invalid_from", camera.depth.invalid_from, 1, 65535));
  camera.depth.wrap_range_m =
      metres_of(reader, "depth_wraps_mm", camera.depth.wrap_range_m, 0, 100'000);
  camera.reflectivity_bits =
      static_cast<int>(reader.integer("reflectivity_bits", camera.reflectivity_bits, 8, 16));
  if (camera.reflectivity_bits != 8 && camera.reflectivity_bits != 16) {
    throw_input_error(cell, reader.line_of("reflectivity_bits"),
                      ".reflectivity_bits: expected 8 or 16");
  }
  camera.period = duration_of(reader, "period_ms", camera.period, 1, 1000);
  camera.exposure = duration_of(reader, "exposure_ms", camera.exposure, 0, 100);
  camera.transport = duration_of(reader, "transport_ms", camera.transport, 0, 1000);
  if (const auto range_mm = reader.reals("range_mm", 2)) {
    if (!((*range_mm)[0] > 0) || !((*range_mm)[1] > (*range_mm)[0]) || (*range_mm)[1] > 20'000) {
      throw_input_error(cell, reader.line_of("range_mm"),
                        ".range_mm: not a range; expected [from, to] within 0 and 20000");
    }
    camera.range_min_m = 1e-3 * (*range_mm)[0];
    camera.range_max_m = 1e-3 * (*range_mm)[1];
  }
  camera.range_sigma_m = metres_of(reader, "range_sigma_mm", camera.range_sigma_m,
                                   1e3 * k_range_sigma_min_m, 1e3 * k_range_sigma_max_m);
  camera.pixel_sigma_px = reader.real("pixel_sigma_px", camera.pixel_sigma_px, k_pixel_sigma_min_px,
                                      k_pixel_sigma_max_px);
  camera.estimate_noise = reader.boolean("estimate_noise", camera.estimate_noise);
  const int top = camera.reflectivity_bits == 8 ? 255 : 65535;
  camera.threshold =
      static_cast<std::uint16_t>(reader.integer("threshold", camera.threshold, 0, top - 1));
  if (camera.threshold >= top) {  // of a preset with more bits
    throw_input_error(cell, reader.line_of("reflectivity_bits"),
                      ".threshold: " + std::to_string(camera.threshold) + "; expected less than " +
                          std::to_string(top) + " for 8 bits");
  }
  if (camera.threshold == 0) {
    throw_input_error(cell, reader.line_of("model"),
                      ".threshold: missing; expected the least brightness of a marker's pixels");
  }
}

void set_rays(Cell& cell, std::vector<float> rays, const std::string& path) {
  const std::size_t expected = static_cast<std::size_t>(cell.camera.model.width) *
                               static_cast<std::size_t>(cell.camera.model.height) * 3;
  if (rays.size() != expected) {
    throw InputError(path + " has " + std::to_string(rays.size()) + " numbers; expected " +
                     std::to_string(expected) + ", 3 for each pixel of " + cell.camera.name);
  }
  cell.camera = with_rays(cell.camera, std::move(rays), path);
}

}  // namespace

void read_camera(const toml::table* table, Cell& cell, const CellFileReader& files) {
  static const toml::table k_empty;
  TomlReader reader(table ? *table : k_empty, cell.file, "camera.");
  const std::string model = reader.text("model", "hololens2_ahat");
  const std::optional<Camera> preset = camera_named(model);
  if (!preset) {
    throw_input_error(cell, reader.line_of("model"),
                      ".model: \"" + model + "\"; expected one of " + camera_names());
  }
  cell.camera = *preset;
  read_size(reader, cell.camera);
  if (cell.camera.model.width == 0 || cell.camera.model.height == 0) {
    throw_input_error(cell, reader.line_of("model"),
                      ": width and height are missing; expected both for " + model);
  }
  read_sensor(reader, cell);
  cell.arrival_jitter = from_ms(reader.real("arrival_jitter_ms", 0.4, 0, 10));
  cell.ray_table = files.resolved(reader.text("ray_table", ""), "camera.ray_table");
  const std::string lens = reader.text("file", "");
  if (!lens.empty() && !cell.ray_table.empty()) {
    throw_input_error(cell, reader.line_of("file"),
                      ".file and camera.ray_table are both set; expected one lens");
  }
  if (!lens.empty() || files.is_recorded(k_lens_key)) {
    const std::string name = lens.empty() ? std::string(k_lens_key) + ".toml" : lens;
    const NamedFile file = files.named_file(name, k_lens_key);
    cell.camera.model = lens_of(file, cell.camera.model);
    use_own_lens(cell);
    read_lens_uncertainty(file, cell.camera.uncertainty);
  }
  const bool rays_recorded =
      files.recorded_files != nullptr && files.recorded_files->rays != nullptr;
  if (!cell.ray_table.empty() || rays_recorded) use_own_lens(cell);
  read_depth_bias(reader, cell, files);
  read_uncertainty(reader, cell, files);
  reader.done();
  if (files.recorded_files != nullptr) {
    if (files.recorded_files->rays != nullptr) {
      set_rays(cell, *files.recorded_files->rays, cell.file + ": rays.f32");
    }
  } else if (!cell.ray_table.empty()) {
    cell.camera = with_ray_table(cell.camera, cell.ray_table);
  }
  set_camera(cell, cell.camera);
}

void set_camera(Cell& cell, const Camera& camera) {
  cell.camera = camera;
  cell.ray_steps = ray_steps_needed(camera.model);
}

bool names_lens(const Cell& cell) {
  return cell.camera.table != nullptr ||
         std::any_of(cell.named_files.begin(), cell.named_files.end(),
                     [](const NamedFile& named) { return named.key == k_lens_key; });
}

void set_lens(Cell& cell, SourceLens lens) {
  if (!lens.file.empty()) {
    NamedFile named{k_lens_key, lens.path, std::move(lens.file)};
    cell.camera.model = lens_of(named, cell.camera.model);
    cell.named_files.push_back(std::move(named));
  } else {
    set_rays(cell, std::move(lens.rays), lens.path);
  }
  use_own_lens(cell);
  set_camera(cell, cell.camera);
}

void require_lens(const Cell& cell) {
  if (has_lens(cell.camera)) return;
  throw InputError(cell.file + ": camera: " + cell.camera.name +
                   " has no lens; expected camera.file, camera.ray_table, or a source with a lens");
}

}  // namespace glint

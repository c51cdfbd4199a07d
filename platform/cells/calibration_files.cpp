#include "platform/cells/calibration_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "platform/cells/cell_headset.hpp"
#include "platform/cells/depth_bias_table.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

[[noreturn]] void throw_input_error(const std::string& file, std::uint32_t line,
                                    const std::string& what) {
  throw InputError(file + ":" + std::to_string(line) + ": " + what);
}

// One required table of a file; ignores other tables and keys.
struct Section {
  const NamedFile& file;
  std::string name;
  toml::table root;
  const toml::table* table = nullptr;

  Section(const NamedFile& named, const char* section, const std::string& command)
      : file(named), name(section), root(parse_toml(named.text, named.path)) {
    table = root[section].as_table();
    if (table != nullptr) return;
    throw_input_error(
        file.path, 1,
        "no table [" + name + "]; expected a file of `glint calibrate " + command + "`");
  }
  [[nodiscard]] TomlReader reader() const { return {*table, file.path, name + "."}; }

  // Reads a required number, without a default.
  [[nodiscard]] double required(TomlReader& reader, const char* key, double low,
                                double high) const {
    require(key, "a number");
    return reader.real(key, 0, low, high);
  }
  [[nodiscard]] std::vector<double> required(TomlReader& reader, const char* key,
                                             std::size_t count) const {
    std::string expected = std::to_string(count);
    expected += " numbers in [ ]";
    require(key, expected);
    return *reader.reals(key, count);
  }
  void require(const char* key, const std::string& expected) const {
    if (table->contains(key)) return;
    throw_input_error(file.path, table->source().begin.line,
                      name + "." + key + " is missing; expected " + expected);
  }
};

// Reads [from, to] within 0 and `most`.
ValidRange range_of(const Section& section, TomlReader& reader, const char* key, double most) {
  const std::vector<double> ends = section.required(reader, key, 2);
  if (ends[0] >= 0 && ends[1] > ends[0] && ends[1] <= most) return {ends[0], ends[1]};
  throw_input_error(section.file.path, reader.line_of(key),
                    section.name + "." + key +
                        " is not a range; expected [from, to] within 0 and " +
                        std::to_string(static_cast<int>(most)));
}

// Cosine decreases with the angle, so the ends swap.
ValidRange cosines_of(const ValidRange& degrees) {
  const auto cosine = [](double angle) { return sine_cosine(angle * k_radians_per_degree).cosine; };
  return {cosine(degrees.to), cosine(degrees.from)};
}

// Reads two standard deviations at the top level; empty if the file states neither.
std::optional<std::array<double, 2>> two_standard_deviations(const NamedFile& file,
                                                             const char* first,
                                                             const char* second) {
  const toml::table root = parse_toml(file.text, file.path);
  if (!root.contains(first) && !root.contains(second)) return {};
  const auto sigma = [&](const char* key) {
    const std::optional<double> found = root[key].value<double>();
    if (!found || !(*found >= 0)) {
      throw_input_error(
          file.path, 1,
          std::string(key) +
              " is missing or not a standard deviation; expected two numbers of 0 or more");
    }
    return *found;
  };
  return {{sigma(first), sigma(second)}};
}

// Residual of a periodic range error of 1 mm after a fit of offset and slope. Source: Foix, Alenya,
// Torras, "Lock-in Time-of-Flight (ToF) Cameras: A Survey", IEEE Sensors Journal 11 (2011), section
// II.
constexpr double k_range_shape_m = 0.0007;

Vector3 vector_of(const std::vector<double>& values) { return {values[0], values[1], values[2]}; }

}  // namespace

DepthBias depth_bias_of(const NamedFile& file) {
  const Section section(file, "depth_bias", "depth");
  return depth_bias_of(*section.table, file.path, "depth_bias.");
}

void read_range_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty) {
  const std::optional<std::array<double, 2>> sigmas =
      two_standard_deviations(file, "offset_sigma_mm", "mm_per_m_sigma");
  if (!sigmas) return;
  state_range_uncertainty(1e-3 * (*sigmas)[0], 1e-3 * (*sigmas)[1], uncertainty);
}

void state_range_uncertainty(double offset_sigma_m, double slope_sigma,
                             CameraUncertainty& uncertainty) {
  const double lens = uncertainty.focal_scale;
  const double lens_m = lens * DepthBias::k_reference_m;
  uncertainty.range_offset_m = std::sqrt(offset_sigma_m * offset_sigma_m + lens_m * lens_m +
                                         k_range_shape_m * k_range_shape_m);
  uncertainty.range_scale = std::hypot(slope_sigma, lens);
}

void read_lens_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty) {
  const std::optional<std::array<double, 2>> sigmas =
      two_standard_deviations(file, "principal_point_sigma_px", "focal_sigma");
  if (!sigmas) return;
  uncertainty.principal_point_px = (*sigmas)[0];
  uncertainty.focal_scale = (*sigmas)[1];
}

CameraModel lens_of(const NamedFile& file, const CameraModel& camera) {
  const Section section(file, "camera", "camera");
  TomlReader reader = section.reader();
  CameraModel lens;
  section.require("lens", "\"brown\" or \"rational\"");
  lens.lens =
      reader.one_of("lens", "", {"brown", "rational"}) == "brown" ? Lens::brown : Lens::rational;
  section.require("width", "a whole number");
  section.require("height", "a whole number");
  lens.width = static_cast<int>(reader.integer("width", 0, 1, 100'000));
  lens.height = static_cast<int>(reader.integer("height", 0, 1, 100'000));
  if (lens.width != camera.width || lens.height != camera.height) {
    throw_input_error(file.path, reader.line_of("width"),
                      "camera has " + std::to_string(lens.width) + " x " +
                          std::to_string(lens.height) + " pixels; expected " +
                          std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                          ", the size of the cell's camera.model");
  }
  lens.fx = section.required(reader, "fx_px", 1, 1e6);
  lens.fy = section.required(reader, "fy_px", 1, 1e6);
  lens.cx = section.required(reader, "cx_px", -1e6, 1e6);
  lens.cy = section.required(reader, "cy_px", -1e6, 1e6);
  const std::vector<double> distortion = section.required(reader, "k1_k2_p1_p2_k3_k4_k5_k6", 8);
  std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  lens.field_tangent_max = section.required(reader, "field_tangent", 0.01, 1000);
  reader.done();
  return lens;
}

MotionSettings motion_of(const NamedFile& file) {
  const Section section(file, "motion", "motion");
  TomlReader reader = section.reader();
  MotionSettings motion;
  motion.linear_noise_m2_s5 = section.required(reader, "linear_noise_m2_s5", 1e-9, 1e9);
  motion.linear_damping_1_s = section.required(reader, "linear_damping_1_s", 1e-3, 1e3);
  motion.angular_noise_rad2_s5 = section.required(reader, "angular_noise_rad2_s5", 1e-9, 1e9);
  motion.angular_damping_1_s = section.required(reader, "angular_damping_1_s", 1e-3, 1e3);
  reader.done();
  return motion;
}

BiasCorrection correction_of(const NamedFile& file) {
  const Section section(file, "correction", "bias");
  TomlReader reader = section.reader();
  BiasCorrection correction;
  section.require("frame", "\"tool\" or \"camera\"");
  correction.frame = reader.one_of("frame", "", {"tool", "camera"}) == "tool"
                         ? CorrectionFrame::tool
                         : CorrectionFrame::camera;
  correction.translation_m = 1e-3 * vector_of(section.required(reader, "shift_mm", 3));
  correction.rotation_rad =
      k_radians_per_degree * vector_of(section.required(reader, "turn_deg", 3));
  const ValidRange range_mm = range_of(section, reader, "range_mm", 100'000);
  correction.range_m = {1e-3 * range_mm.from, 1e-3 * range_mm.to};
  correction.off_axis_cosine = cosines_of(range_of(section, reader, "off_axis_deg", 180));
  correction.tilt_cosine = cosines_of(range_of(section, reader, "tilt_deg", 180));
  reader.done();
  return correction;
}

}  // namespace glint

// glint calibrate camera: lens model from images of a calibration target or a device's ray table.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/npy.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/tools/calibrate/board.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/lens_fit.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {
namespace {

struct CameraArguments {
  std::string recording, config, ray_table, target = "9x6", pattern = "chessboard",
                                            lens = "rational";
  std::vector<std::string> images;
  int width = 0;
  double spacing_mm = 25;
  CalibrationOutput output;
};

Figures lens_figures(const CameraModel& model) {
  return {{"lens", model.lens == Lens::rational ? "rational" : "brown"},
          {"width", model.width},
          {"height", model.height},
          {"fx_px", model.fx},
          {"fy_px", model.fy},
          {"cx_px", model.cx},
          {"cy_px", model.cy},
          {"k1_k2_p1_p2_k3_k4_k5_k6", model.distortion},
          {"field_tangent", model.field_tangent_max}};
}

int run_table(const CameraArguments& arguments) {
  const LensFit fit = fit_lens_to_table(arguments.ray_table, arguments.width);
  const Figures figures{{"source", arguments.ray_table},
                        {"rms_px", fit.rms_px},
                        {"largest_px", fit.error_max_px},
                        {"rays", fit.pixels},
                        {"camera", lens_figures(fit.model)}};
  finish_calibration(
      arguments.output, figures,
      {{"camera.toml", figures_toml(figures, "glint calibrate camera; pixel centres at + 0.5")},
       {"camera.svg", residual_plot({"Lens: error against the angle off the axis (number: degrees)",
                                     "error [px]", fit.error_by_angle_px})}});
  return 0;
}

CameraCalibrationSettings target_settings(const CameraArguments& arguments) {
  CameraCalibrationSettings settings;
  char rest = 0;
  if (std::sscanf(arguments.target.c_str(), "%dx%d%c", &settings.columns, &settings.rows, &rest) !=
          2 ||
      settings.columns < 3 || settings.rows < 3 || settings.columns > 50 || settings.rows > 50) {
    throw InputError("--target " + arguments.target +
                     ": expected COLUMNSxROWS of inner corners or circles, 3 to 50 each, e.g. 9x6");
  }
  settings.pattern =
      arguments.pattern == "circles" ? TargetPattern::circles : TargetPattern::chessboard;
  settings.lens = arguments.lens == "brown" ? Lens::brown : Lens::rational;
  settings.spacing_m = 1e-3 * arguments.spacing_mm;
  return settings;
}

// The lens is not calibrated yet; any lens serves to read the frames.
void set_placeholder_lens(Camera& camera) {
  if (has_lens(camera)) return;
  camera.model.lens = Lens::brown;
  camera.model.fx = camera.model.fy = camera.model.width;
  camera.model.cx = 0.5 * camera.model.width;
  camera.model.cy = 0.5 * camera.model.height;
}

CameraFit fit_of_frames(const CameraArguments& arguments, std::vector<std::string>& failures) {
  Cell cell = recorded_source_cell(arguments.recording, arguments.config, "");
  set_placeholder_lens(cell.camera);
  const std::unique_ptr<FrameSource> source = open_source(cell);
  CameraFit fit = calibrate_camera(*source, arguments.recording, target_settings(arguments));
  failures = source->report().failures;
  return fit;
}

int run_images(const CameraArguments& arguments) {
  std::vector<std::string> failures;
  const CameraFit fit = arguments.recording.empty()
                            ? calibrate_camera(arguments.images, target_settings(arguments))
                            : fit_of_frames(arguments, failures);
  const Figures figures{{"source", arguments.recording.empty() ? "--images" : arguments.recording},
                        {"rms_px", fit.rms_px},
                        {"largest_px", fit.error_max_px},
                        {"images", fit.images},
                        {"images_used", fit.images_used},
                        {"corners", fit.corners},
                        {"board_tilt_deg", fit.tilt_rad * k_degrees_per_radian},
                        {"principal_point_sigma_px", fit.principal_point_sigma_px},
                        {"focal_sigma", fit.focal_sigma},
                        {"camera", lens_figures(fit.model)}};
  const std::vector<std::size_t> shape{static_cast<std::size_t>(fit.model.height),
                                       static_cast<std::size_t>(fit.model.width), 3};
  finish_calibration(
      arguments.output, figures,
      {{"camera.toml", figures_toml(figures, "glint calibrate camera; pixel centres at + 0.5")},
       {"camera_rays.npy", npy_float32_bytes({shape, ray_table_of(fit.model)})},
       {"camera.svg",
        residual_plot({"Lens: rms error of each image", "error [px]", fit.image_rms_px})}});
  return report_losses(failures);
}

}  // namespace

void add_calibrate_camera(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "camera", "Calibrate the lens: from images of a target, or from a device's ray table");
  auto arguments = std::make_shared<CameraArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate camera --images board/*.png --target 9x6 --spacing-mm 25\n"
      "  glint calibrate camera --recording frames --config cell.toml --target 9x6 --spacing-mm "
      "25\n"
      "  glint calibrate camera --ray-table ahat_lut.npy --json lens.json\n"
      "--recording: images of reflectivity; the cell has their size and bits.\n"
      "From images the folder also holds camera_rays.npy, for a cell's camera.ray_table.");
  command->add_option("--images", arguments->images, "images of the calibration target (PNG, PGM)");
  add_recording_options(*command, arguments->recording, arguments->config);
  command
      ->add_option("--target,--board", arguments->target,
                   "inner corners or circles of the target, COLUMNSxROWS")
      ->capture_default_str();
  command
      ->add_option("--spacing-mm", arguments->spacing_mm, "distance of adjacent corners or circles")
      ->check(in_range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--pattern", arguments->pattern, "pattern of the target")
      ->check(CLI::IsMember({"chessboard", "circles"}))
      ->capture_default_str();
  command->add_option("--lens", arguments->lens, "lens model")
      ->check(CLI::IsMember({"rational", "brown"}))
      ->capture_default_str();
  command->add_option("--ray-table", arguments->ray_table, "table of unit rays, float32 (.npy)");
  command->add_option("--width", arguments->width, "image width of a flat table")
      ->check(in_range(0, 100000));
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] {
    const int given = (arguments->images.empty() ? 0 : 1) + (arguments->ray_table.empty() ? 0 : 1) +
                      (arguments->recording.empty() ? 0 : 1);
    if (given != 1) {
      throw InputError(
          "calibrate camera: expected one of --images, --recording SOURCE and --ray-table FILE");
    }
    exit_code = arguments->ray_table.empty() ? run_images(*arguments) : run_table(*arguments);
  });
}

}  // namespace glint

// glint calibrate motion: motion model of a hand from recordings, for the filter and the
// prediction.
#include <cmath>
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/in_range.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/motion.hpp"

namespace glint {
namespace {

struct MotionArguments {
  std::vector<std::string> poses;
  double position_sigma_mm = 0.5, rotation_sigma_deg = 0.3, rate_hz = 45;
  std::string tool;
  bool add_noise = false;
  CalibrationOutput output;
};

Figures held_out_figures(const HeldOut& held) {
  const auto mm = [](const MotionError& error) { return 1e3 * error.position_rms_m; };
  const auto deg = [](const MotionError& error) {
    return error.rotation_rms_rad * k_degrees_per_radian;
  };
  return {
      {"log_likelihood_a_pose", held.log_likelihood}, {"position_rms_25_ms_mm", mm(held.at_25_ms)},
      {"rotation_rms_25_ms_deg", deg(held.at_25_ms)}, {"position_rms_50_ms_mm", mm(held.at_50_ms)},
      {"rotation_rms_50_ms_deg", deg(held.at_50_ms)}, {"predictions", held.at_25_ms.n}};
}

// One sigma as a factor: 1.2 is 20 % more or less.
double factor_of(const Eigen::Matrix2d& covariance, int i) {
  return std::exp(std::sqrt(covariance(i, i)));
}

// The filter adapts its noise to its innovations by a factor; so a higher likelihood does not imply
// a better prediction.
bool predicts_as_well(const MotionCalibration& found) {
  constexpr double k_slack = 1.02;
  const auto holds = [](const MotionError& own, const MotionError& other) {
    return own.position_rms_m <= k_slack * other.position_rms_m &&
           own.rotation_rms_rad <= k_slack * other.rotation_rms_rad;
  };
  return holds(found.found.at_25_ms, found.built_in.at_25_ms) &&
         holds(found.found.at_50_ms, found.built_in.at_50_ms);
}

Figures figures_for(const std::string& what, const MotionArguments& arguments,
                    const MotionCalibration& found) {
  return {{"source", what},
          {"declared_position_sigma_mm", arguments.position_sigma_mm},
          {"declared_rotation_sigma_deg", arguments.rotation_sigma_deg},
          {"linear_noise_sigma_factor", factor_of(found.translation_covariance, 0)},
          {"linear_damping_sigma_factor", factor_of(found.translation_covariance, 1)},
          {"angular_noise_sigma_factor", factor_of(found.rotation_covariance, 0)},
          {"angular_damping_sigma_factor", factor_of(found.rotation_covariance, 1)},
          {"poses", found.samples},
          {"poses_held_out", found.held_out},
          {"foretells_as_well_as_built_in", predicts_as_well(found)},
          {"motion",
           {{"linear_noise_m2_s5", found.motion.linear_noise_m2_s5},
            {"linear_damping_1_s", found.motion.linear_damping_1_s},
            {"angular_noise_rad2_s5", found.motion.angular_noise_rad2_s5},
            {"angular_damping_1_s", found.motion.angular_damping_1_s}}},
          {"held_out", held_out_figures(found.found)},
          {"held_out_built_in", held_out_figures(found.built_in)}};
}

int run_motion(const MotionArguments& arguments) {
  std::vector<Trajectory> recordings;
  std::string what;
  for (const std::string& path : arguments.poses) {
    PoseSource source;
    source.poses = path;
    source.tool = arguments.tool;
    PoseSeries series = load_pose_series(source);
    what += (what.empty() ? "" : ", ") + series.what;
    recordings.push_back({series.what, std::move(series.poses), series.begin});
  }
  MotionCalibrationSettings settings;
  settings.noise = {1e-3 * arguments.position_sigma_mm,
                    arguments.rotation_sigma_deg / k_degrees_per_radian};
  settings.rate_hz = arguments.rate_hz;
  if (arguments.add_noise) settings.added = AddedNoise::declared;
  Progress progress("calibrate motion");
  settings.progress = [&](int evaluations) { progress.show(evaluations, 0, "likelihoods"); };
  const MotionCalibration found = calibrate_motion(recordings, settings, what);
  progress.clear();

  const Figures figures = figures_for(what, arguments, found);
  std::vector<double> misses_mm;
  for (const double miss : found.errors_m) misses_mm.push_back(1e3 * miss);
  finish_calibration(
      arguments.output, figures,
      {{"motion.toml",
        figures_toml(figures, "glint calibrate motion: for [motion] file of a cell")},
       {"motion.svg", residual_plot({"Motion: prediction 25 ms ahead, on the validation part",
                                     "error [mm]", misses_mm})}});
  return predicts_as_well(found) ? 0 : 1;
}

}  // namespace

void add_calibrate_motion(CLI::App& calibrate, int& exit_code) {
  CLI::App* command =
      calibrate.add_subcommand("motion", "Fit the motion filter's noise and damping to recordings");
  auto arguments = std::make_shared<MotionArguments>();
  command->footer(
      "Example: glint calibrate motion --poses work.tum more.tum --position-sigma-mm 0.5 \\\n"
      "           --rotation-sigma-deg 0.3 --json motion.json\n"
      "Record measured poses of typical work, a minute or more, and declare their noise an axis.\n"
      "The last third of each recording validates the fit against the built-in setting. Exit\n"
      "code 1: the fit predicts worse by 2 %. Entry in a cell: [motion] file = \"motion.toml\".");
  command
      ->add_option(
          "--poses", arguments->poses,
          "recordings: TUM text, EuRoC-like CSV, or a run's .mcap (level blobs, roi or full)")
      ->required();
  command->add_option("--tool", arguments->tool, "tool of an .mcap");
  command
      ->add_option("--position-sigma-mm", arguments->position_sigma_mm,
                   "standard deviation of a pose an axis")
      ->check(in_range(0.001, 100.0))
      ->capture_default_str();
  command
      ->add_option("--rotation-sigma-deg", arguments->rotation_sigma_deg,
                   "standard deviation of a pose an axis")
      ->check(in_range(0.001, 30.0))
      ->capture_default_str();
  command
      ->add_option("--rate-hz", arguments->rate_hz,
                   "frame rate of the camera; faster recordings are thinned")
      ->check(in_range(1.0, 1000.0))
      ->capture_default_str();
  command->add_flag("--add-noise", arguments->add_noise,
                    "recordings are ground truth: add the declared noise");
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_motion(*arguments); });
}

}  // namespace glint

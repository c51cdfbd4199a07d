#include "platform/lab/experiments/bound_experiment.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "platform/lab/baseline/baseline_match.hpp"
#include "platform/lab/experiments/cramer_rao.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint {
namespace {

constexpr int k_samples = 10'000;
constexpr int k_samples_quick = 400;
constexpr double k_bound_ratio_max = 1.05;
constexpr double k_nees_deviation_max = 0.1;
constexpr std::array k_ranges_m = {0.3, 0.5, 0.8};
constexpr std::array<ObservationNoise, 4> k_noises = {
    {{0.05, 0.001}, {0.1, 0.001}, {0.1, 0.003}, {0.1, 0.005}}};

struct TiltRange {
  const char* name;
  double from_deg, to_deg;
  bool judged;
};
constexpr std::array k_tilts = {TiltRange{"tilt 20..60", 20, 60, true},
                                TiltRange{"tilt 0..20", 0, 20, false}};

struct BoundCase {
  const PointTool& tool;
  double range_m;
  ObservationNoise noise;
  TiltRange tilt;
};

std::string name_of(const BoundCase& c) {
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%s %.1f m, %.2f px, %.0f mm, %s", c.tool.name.c_str(),
                c.range_m, c.noise.pixel_px, 1e3 * c.noise.range_m, c.tilt.name);
  return text.data();
}

// Errors of one method's poses against ground truth, and the bound.
struct BoundErrors {
  std::string method;
  std::int64_t frames = 0, found = 0, flips = 0;
  double position = 0, tip = 0, rotation = 0;  // sums of squares
  double position_bound = 0, tip_bound = 0, rotation_bound = 0;
  double nees = 0;
  Vector3 tip_mean = Vector3::Zero();

  void add(const PointTool& tool, const DrawnPose& drawn, const Pose& pose,
           const Matrix6& mean_bound, const Matrix6& tip_bound_at) {
    const Pose& truth = drawn.T_camera_tool;
    const Vector3 mean = marker_mean(tool.tool);
    const Vector3 tip_error = pose * tool.tool.tip_m - truth * tool.tool.tip_m;
    const double turned = rotation_between_rad(pose, truth);
    ++found;
    flips += rotation_between_rad(pose, drawn.T_camera_mirrored) < turned ? 1 : 0;
    position += (pose * mean - truth * mean).squaredNorm();
    tip += tip_error.squaredNorm();
    tip_mean += tip_error;
    rotation += turned * turned;
    position_bound += mean_bound.topLeftCorner<3, 3>().trace();
    tip_bound += tip_bound_at.topLeftCorner<3, 3>().trace();
    rotation_bound += tip_bound_at.bottomRightCorner<3, 3>().trace();
  }
  [[nodiscard]] double rms(double squares) const {
    return std::sqrt(squares / static_cast<double>(found));
  }
};

double nees_of(const RefinedPose& refined, const Pose& truth, const Vector3& tip_m) {
  Vector6 error;
  error << refined.T_camera_tool * tip_m - truth * tip_m,
      rotation_vector(refined.T_camera_tool.rotation * truth.rotation.conjugate());
  const Result<PoseFactor> factor = pose_factor(refined.covariance);
  return factor ? error.dot(factor.value.solve(error)) / 6 : 1e9;
}

ExperimentCase case_of(const BoundCase& c, const BoundErrors& errors, bool judged) {
  const bool glint = errors.method == "glint";
  const Bar ratio = glint && judged ? Bar::at_most(k_bound_ratio_max) : Bar::none();
  ExperimentCase out{name_of(c), errors.method, errors.found, {}};
  out.figures = {
      {"position_rms", "mm", 1e3 * errors.rms(errors.position), {}},
      {"position_above_bound", "", std::sqrt(errors.position / errors.position_bound), ratio},
      {"tip_rms", "mm", 1e3 * errors.rms(errors.tip), {}},
      {"tip_above_bound", "", std::sqrt(errors.tip / errors.tip_bound), ratio},
      {"rotation_rms", "deg", errors.rms(errors.rotation) / k_radians_per_degree, {}},
      {"rotation_above_bound", "", std::sqrt(errors.rotation / errors.rotation_bound), ratio},
      {"tip_bias", "mm", 1e3 * errors.tip_mean.norm() / static_cast<double>(errors.found), {}},
      {"flipped",
       "%",
       100.0 * static_cast<double>(errors.flips) / static_cast<double>(errors.found),
       {}},
      {"found",
       "%",
       100.0 * static_cast<double>(errors.found) / static_cast<double>(errors.frames),
       {}},
  };
  if (!glint) return out;
  const double nees = errors.nees / static_cast<double>(errors.found);
  out.figures.push_back({"nees", "", nees, {}});
  out.figures.push_back({"nees_off_one", "", std::abs(nees - 1),
                         judged ? Bar::at_most(k_nees_deviation_max) : Bar::none()});
  return out;
}

struct Methods {
  BoundErrors glint{"glint"}, svd{"svd"}, baseline{"baseline"};
};

void try_sample(const BoundCase& c, const Camera& camera, SampleNumbers& numbers,
                const EstimatorSettings& settings, Methods& methods) {
  const Tool& tool = c.tool.tool;
  const double tilt = k_radians_per_degree * numbers.within(c.tilt.from_deg, c.tilt.to_deg);
  const DrawnPose drawn = draw_pose(c.tool, c.range_m, tilt, numbers);
  const Pose& truth = drawn.T_camera_tool;
  PointView view;
  view.clear();
  std::vector<WeightedMarker> weighted;
  std::vector<Vector3> model, measured;
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3& marker = tool.markers_m[static_cast<std::size_t>(i)];
    if (!view.add(camera, tool, truth * marker, i, c.noise, numbers)) return;
    const Marker& seen = view.markers.items[static_cast<std::size_t>(i)];
    const MarkerMeasurementModel& sight = view.sights[static_cast<std::size_t>(i)];
    const double range_m = seen.surface_range_m + tool.centre_offset_m();
    weighted.push_back(whiten_marker(marker, sight.rays, range_m, sight.variance).value);
    model.push_back(marker);
    measured.push_back(seen.ray * range_m);
  }
  const Matrix6 tip_bound = cramer_rao_bound(camera, tool, truth, tool.tip_m, c.noise);
  const Matrix6 mean_bound = cramer_rao_bound(camera, tool, truth, marker_mean(tool), c.noise);
  for (BoundErrors* errors : {&methods.glint, &methods.svd, &methods.baseline}) ++errors->frames;
  const RefinedPose refined = refine_pose(weighted, tool.tip_m, nullptr, settings.refine);
  if (refined.reason == Reason::none) {
    methods.glint.add(c.tool, drawn, refined.T_camera_tool, mean_bound, tip_bound);
    methods.glint.nees += nees_of(refined, truth, tool.tip_m);
  }
  const RigidFit svd = fit_rigid(model, measured);
  if (svd.reason == Reason::none)
    methods.svd.add(c.tool, drawn, svd.transform, mean_bound, tip_bound);
  const BaselineMatch baseline = match_tool(measured, tool, {});
  if (baseline.reason == Reason::none)
    methods.baseline.add(c.tool, drawn, baseline.T_camera_tool, mean_bound, tip_bound);
}

Methods run_case(const BoundCase& c, std::size_t case_number, const Camera& camera, int samples,
                 std::uint64_t seed) {
  const EstimatorSettings settings;
  Methods methods;
  for (int sample = 0; sample < samples; ++sample) {
    SampleNumbers numbers(seed, case_number, static_cast<std::uint64_t>(sample));
    try_sample(c, camera, numbers, settings, methods);
  }
  return methods;
}

std::vector<BoundCase> cases_of(std::span<const PointTool> tools) {
  std::vector<BoundCase> cases;
  for (const PointTool& tool : tools) {
    for (const TiltRange& tilt : k_tilts) {
      for (const double range_m : k_ranges_m) {
        for (const ObservationNoise& noise : k_noises)
          cases.push_back({tool, range_m, noise, tilt});
      }
    }
  }
  return cases;
}

}  // namespace

CaseList run_bound(const CaseOptions& options) {
  const Camera camera = ahat_ray_table();
  const std::array tools = {ndi_8700339(), five_marker_pen()};
  const std::vector<BoundCase> cases = cases_of(tools);
  const int samples = options.quick ? k_samples_quick : k_samples;
  CaseList list{"bound", {}, {}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Methods methods =
        options.piece([&] { return run_case(cases[k], k, camera, samples, options.seed); });
    for (const BoundErrors* errors : {&methods.glint, &methods.svd, &methods.baseline})
      list.cases.push_back(case_of(cases[k], *errors, cases[k].tilt.judged && !options.quick));
    if (options.progress) options.progress(static_cast<int>(k) + 1, static_cast<int>(cases.size()));
  }
  return list;
}

std::vector<ExperimentCase> bound_cases_at(const Camera& camera, double range_m, int samples,
                                           std::uint64_t seed) {
  const std::array tools = {ndi_8700339(), five_marker_pen()};
  const std::vector<BoundCase> cases = cases_of(tools);
  std::vector<ExperimentCase> out;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (!cases[k].tilt.judged || cases[k].range_m != range_m) continue;
    const Methods methods = run_case(cases[k], k, camera, samples, seed);
    for (const BoundErrors* errors : {&methods.glint, &methods.svd, &methods.baseline})
      out.push_back(case_of(cases[k], *errors, false));
  }
  return out;
}

}  // namespace glint

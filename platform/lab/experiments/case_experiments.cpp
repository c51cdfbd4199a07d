#include "platform/lab/experiments/case_experiments.hpp"
#include "platform/lab/experiments/anchored_experiment.hpp"

#include <vector>

#include "platform/lab/experiments/acquisition_experiment.hpp"
#include "platform/lab/experiments/bound_experiment.hpp"
#include "platform/lab/experiments/centroid_experiment.hpp"
#include "platform/lab/experiments/cis_pivot.hpp"
#include "platform/lab/experiments/clutter_experiment.hpp"
#include "platform/lab/experiments/f2554.hpp"
#include "platform/lab/experiments/field_experiment.hpp"
#include "platform/lab/experiments/map_experiment.hpp"
#include "platform/lab/experiments/marker_mocap.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/noise_experiment.hpp"
#include "platform/lab/experiments/reference_experiment.hpp"
#include "platform/lab/experiments/strokes_run.hpp"
#include "platform/lab/experiments/verify_experiment.hpp"
#include "platform/lab/experiments/warnings_experiment.hpp"

namespace glint {
namespace {

// An experiment without repetitions: a single piece of work.
template <CaseList (*Run)(const CaseOptions&)>
CaseList in_one_piece(const CaseOptions& options) {
  return options.piece([&] { return Run(options); });
}

}  // namespace

std::span<const CaseExperiment> case_experiments() {
  using enum DataFolder;
  static const std::vector<CaseExperiment> k_experiments = {
      {"centroid", "rendered spheres: centroid error, and its stated standard deviation", none,
       run_centroid_experiment},
      {"cis_pivot", "pivot posts and two-body tips of a course, against its answers", required,
       in_one_piece<run_cis_pivot>},
      {"marker_mocap", "a real probe's markers from unlabelled points, and its tip on a landmark",
       required, in_one_piece<run_marker_mocap>},
      {"f2554", "a tip on one point, rotated about each axis, and distances between points", none,
       run_f2554},
      {"rest", "the pose of a tool after it comes to rest", none, run_static_tool},
      {"lag", "lag of the estimate as a tool starts to move", none, run_lag},
      {"sine", "a tool that swings at 2 Hz, predicted by 25 ms", none, run_sine},
      {"prediction", "recorded motion predicted by 25 and 50 ms, against five other predictors",
       required, run_prediction},
      {"occlusion", "recorded motion with all markers but one or two hidden for 0.2 s", required,
       run_occlusion},
      {"rates", "frames at 45, 5 and 45 Hz, dropped, doubled, late and stamped backwards", none,
       run_rates},
      {"strokes", "drawn strokes smoothed in hindsight, beside the live prediction, at 45 and 5 Hz",
       optional, run_strokes},
      {"anchored",
       "a reference body in view, built-in settings, a headset that drifts more than declared",
       none, run_drift_correction},
      {"correlated", "real tools at rest: correlated errors, their model and stated covariance",
       required, run_correlated},
      {"bound", "the pose of one frame, against the lower bound of any estimator", none, run_bound},
      {"noise", "detections and false detections of a tool against range noise", none, run_noise},
      {"map", "a map of depth images against a second one of the same place", required,
       in_one_piece<run_map>},
      {"clutter", "five tools among up to 200 strays, and two tools that look alike", none,
       run_clutter},
      {"acquire", "acquisition time among more bright spots than [budget] blobs", optional,
       run_acquisition},
      {"field", "devices that differ from their cells' stated values, judged at the output",
       optional, run_field, true},
      {"warnings", "detection of a device's calibration error by a run", none, run_warnings},
      {"verify",
       "touches of known points by devices with the stated errors, and with one error of four "
       "sigma",
       none, run_verify_experiment},
      {"reference", "a robot located in real and simulated depth, from hundreds of initial poses",
       required, run_reference_experiment, true},
  };
  return k_experiments;
}

}  // namespace glint

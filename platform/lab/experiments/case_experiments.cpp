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
#include "platform/lab/experiments/verify_experiment.hpp"
#include "platform/lab/experiments/warnings_experiment.hpp"

namespace glint {

std::span<const CaseExperiment> case_experiments() {
  using enum DataFolder;
  static const std::vector<CaseExperiment> k_experiments = {
      {"centroid", "rendered spheres: how far centroids are off, and whether they say so", none,
       run_centroid_experiment},
      {"cis_pivot", "pivot posts and two-body tips of a course, against its answers", required,
       run_cis_pivot},
      {"marker_mocap", "a real probe's markers from unlabelled points, and its tip on a landmark",
       required, run_marker_mocap},
      {"f2554", "a tip on one point, turned about each axis, and from point to point", none,
       run_f2554},
      {"rest", "the pose of a tool that has come to rest", none, run_static_tool},
      {"lag", "how far the estimate trails a tool that sets off", none, run_lag},
      {"sine", "a tool that swings at 2 Hz, foretold by 25 ms", none, run_sine},
      {"prediction", "recorded motion foretold by 25 and 50 ms, against five rivals", required,
       run_prediction},
      {"occlusion", "recorded motion with all markers but one or two hidden for 0.2 s", required,
       run_occlusion},
      {"rates", "frames at 45, 5 and 45 Hz, dropped, doubled, late and stamped backwards", none,
       run_rates},
      {"anchored", "a board in view, shipped settings, a headset that drifts more than declared",
       none, run_drift_correction},
      {"correlated", "real tools at rest: errors that last, their model and stated covariance",
       required, run_correlated},
      {"bound", "the pose of one frame beside the best that any estimator could do", none,
       run_bound},
      {"noise", "how often a tool is found, and wrongly, as the range noise grows", none,
       run_noise},
      {"map", "a map of depth pictures against a second one of the same place", required, run_map},
      {"clutter", "five tools among up to 200 strays, and two tools that look alike", none,
       run_clutter},
      {"acquire", "how soon a tool is found among more bright spots than the cell has blobs for",
       optional, run_acquisition},
      {"field", "devices that differ from what their cells state, judged at the output", optional,
       run_field, true},
      {"warnings", "whether a run names the calibration error that a device has", none,
       run_warnings},
      {"verify", "touches of known points by devices as stated, and with one error of four sigma",
       none, run_verify_experiment},
      {"reference", "a robot found in real and simulated depth, from hundreds of rough poses",
       required, run_reference_experiment, true},
  };
  return k_experiments;
}

}  // namespace glint

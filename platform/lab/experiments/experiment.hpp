// Experiments static and dynamic of the publication on simulated frames: error of the pen's tip in
// the headset's world against an external tracker.
//
// Protocol, after the publication: with headset and pen still, k_aligning_frames samples give the
// rigid transform between the headset's world and the reference tracker's frame (align_worlds), for
// each method by its own poses. Then
//   static:  headset and pen still, an arm's length apart, k_static_frames samples;
//   dynamic: both moving, k_dynamic_runs times k_dynamic_frames samples, each run aligned anew.
// Both methods process the same frames and head poses. A second row runs Glint on the same
// scenario, noise and drift with a reference body on the table, which corrects the headset's drift.
// Its settings are the shipped ones. A sample is a frame in which the method measured the tool.
//
// Figures: position and rotation vector errors have three signed components along the reference's
// axes, pooled into one column of 3 x samples. mean_abs is the mean of their absolute values, sd
// their standard deviation, median their signed median. The published figures agree with this
// definition: 22.1 / 30.7 = 0.72 and 3.87 / 5.39 = 0.72 are ratios of mean absolute value to
// standard deviation of a column with heavier tails than a normal distribution (0.80). The length
// of an error would have a mean of 2.4 times its deviation and no negative median. The mean length
// is also reported.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "platform/lab/experiments/alignment.hpp"
#include "platform/shards/sharded_work.hpp"
#include "platform/sim/scenario.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {

enum class ExperimentKind { still, moving };

struct ExperimentOptions {
  bool quick = false;      // a tenth of the frames: a smoke test, not for figures
  std::uint64_t seed = 1;  // random seed of the simulator
  // Called from time to time with the frames done and in total; may be empty.
  std::function<void(int done, int total)> progress;
  Pieces piece;  // runs each run of the protocol
};

// Error statistics of position (mm) or angle (deg).
struct ErrorColumn {
  Summary summary;       // of the pooled signed components
  double norm_mean = 0;  // of the error's length
  double norm_p95 = 0;
  GaussianFit fit;  // to the histogram
  Histogram histogram;
};

struct MethodFigures {
  std::string name;
  ErrorColumn position_mm;
  ErrorColumn angle_deg;
  double frames_per_s = 0;  // 1 / mean processing time of a frame on this machine, one thread
  // Fraction of the samples whose tip is inside the 95 % ellipsoid that the method states.
  std::optional<double> covered;
  int samples = 0;  // frames with a pose
  int frames = 0;   // frames processed, without the aligning ones
};

// Figures of the publication.
struct PublishedFigures {
  double position_mean_abs_mm = 0, angle_mean_abs_deg = 0;
  std::optional<double> position_sd_mm, angle_sd_deg;
  std::optional<double> position_median_mm, angle_median_deg;
  double frames_per_s = 0;
  int samples = 0;
};
[[nodiscard]] PublishedFigures published_figures(ExperimentKind kind);

// Tip positions along one run, in the reference's frame, one per frame; not finite without a pose.
struct ExperimentPath {
  std::vector<Vector3> reference_m, baseline_m, glint_m;
};

struct ExperimentResult {
  ExperimentKind kind = ExperimentKind::still;
  bool quick = false;
  MethodFigures baseline, glint;
  MethodFigures glint_held;  // with the built-in reference body in view
  MethodFigures perfect;     // ground-truth pose in the camera: error of the headset's drift alone
  ExperimentPath path;       // of the last run
  std::string declared;      // every declared parameter, as text
  std::string config_hash;   // FNV-1a of `declared`, 16 hexadecimal digits
};

[[nodiscard]] ExperimentResult run_static(const ExperimentOptions& options);
[[nodiscard]] ExperimentResult run_dynamic(const ExperimentOptions& options);

// Limits for Glint with a reference body in view: mean absolute values.
struct ExperimentBars {
  double position_mm = 0, angle_deg = 0;
};
[[nodiscard]] ExperimentBars bars_of(ExperimentKind kind);
[[nodiscard]] int missed_bars(const ExperimentResult& result);

// Returns the scenario with the built-in reference body on the table as its last tool.
[[nodiscard]] sim::Scenario with_reference(sim::Scenario scenario);

// The same protocol on other scenarios. Of each, the first `skipped` frames are not rendered, the
// next `aligning` align, the next `judged` are judged.
struct ExperimentRun {
  sim::Scenario scenario;
  int skipped = 0;
  int aligning = 0;
  int judged = 0;
};
[[nodiscard]] ExperimentResult run_experiment(ExperimentKind kind,
                                              const std::vector<ExperimentRun>& runs,
                                              const ExperimentOptions& options);

// Statistics of one column. values: the pooled components; norms: the errors' lengths.
[[nodiscard]] ErrorColumn make_error_column(std::span<const double> values,
                                            std::span<const double> norms);

}  // namespace glint

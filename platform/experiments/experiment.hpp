// The published method's two experiments, on simulated frames: how far is the pen's tip, as the
// headset puts it into its world, from where an outside tracker sees it?
//
// Protocol, after the publication: with headset and pen still, k_aligning_frames samples give the
// rigid transform between the headset's world and the reference tracker's (align_worlds), for each
// method by its own poses. Then
//   static:  headset and pen still, an arm's length apart, k_static_frames samples;
//   dynamic: both moving, k_dynamic_runs times k_dynamic_frames samples, each run aligned anew.
// Both methods get the very same frames and head poses; Glint in a second row those of the same
// scenario, noise and drift with a board on the table, to which it holds the headset's world. Its
// settings are the shipped ones. A sample is a frame in which the method measured the tool.
//
// Figures: an error's position and rotation vector have three signed components along the
// reference's axes; all of them are pooled into one column of 3 x samples. mean_abs is the mean of
// their absolute values, sd their standard deviation, median their signed median. This is how the
// published figures fit together: 22.1 / 30.7 = 0.72 and 3.87 / 5.39 = 0.72 are the ratio of mean
// absolute value and standard deviation of a pooled column with tails heavier than a normal
// distribution's (0.80); the length of an error would have a mean of 2.4 times its deviation and no
// negative median. The mean length stands beside them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "platform/experiments/alignment.hpp"
#include "platform/report/statistics.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

enum class ExperimentKind { still, moving };

struct ExperimentOptions {
  bool quick = false;      // a tenth of the frames: to see that it works, not for figures
  std::uint64_t seed = 1;  // of the simulator
  // Called now and then with frames done and frames in all; may be empty.
  std::function<void(int done, int total)> progress;
};

// One of position (mm) and angle (deg).
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
  double frames_per_s = 0;  // 1 / mean processing time of a frame here, one thread
  // Of the samples, those whose tip lies inside the 95 % ellipsoid that the method states.
  std::optional<double> covered;
  int samples = 0;  // frames with a pose
  int frames = 0;   // frames given, without the aligning ones
};

// What the publication states.
struct PublishedFigures {
  double position_mean_abs_mm = 0, angle_mean_abs_deg = 0;
  std::optional<double> position_sd_mm, angle_sd_deg;
  std::optional<double> position_median_mm, angle_median_deg;
  double frames_per_s = 0;
  int samples = 0;
};
[[nodiscard]] PublishedFigures published_figures(ExperimentKind kind);

// The tip along one run, in the reference's frame, frame by frame; not finite where there is no
// pose.
struct ExperimentPath {
  std::vector<Vector3> reference_m, seed_m, glint_m;
};

struct ExperimentResult {
  ExperimentKind kind = ExperimentKind::still;
  bool quick = false;
  MethodFigures seed, glint;
  MethodFigures glint_held;  // with the built-in board in view, as the reference that does not move
  MethodFigures perfect;     // the true pose before the camera: what the headset's drift alone does
  ExperimentPath path;       // of the last run
  std::string declared;      // every declared parameter, as text
  std::string config_hash;   // FNV-1a of `declared`, 16 hexadecimal digits
};

[[nodiscard]] ExperimentResult run_static(const ExperimentOptions& options);
[[nodiscard]] ExperimentResult run_dynamic(const ExperimentOptions& options);

// What Glint has to reach with a reference in view: mean absolute values.
struct ExperimentBars {
  double position_mm = 0, angle_deg = 0;
};
[[nodiscard]] ExperimentBars bars_of(ExperimentKind kind);
[[nodiscard]] int missed_bars(const ExperimentResult& result);

// The scenario with the built-in board on the table as its last tool.
[[nodiscard]] sim::Scenario with_reference(sim::Scenario scenario);

// The same on scenarios of one's own: of each, `aligning` frames align and all after them are
// judged; the first `skipped` are not even rendered.
struct ExperimentRun {
  sim::Scenario scenario;
  int skipped = 0;
  int aligning = 0;
  int judged = 0;
};
[[nodiscard]] ExperimentResult run_experiment(ExperimentKind kind,
                                              const std::vector<ExperimentRun>& runs,
                                              const ExperimentOptions& options);

// The figures of one column; values: the pooled components, norms: the errors' lengths.
[[nodiscard]] ErrorColumn make_error_column(std::span<const double> values,
                                            std::span<const double> norms);

}  // namespace glint

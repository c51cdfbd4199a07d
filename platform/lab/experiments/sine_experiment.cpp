#include <cmath>
#include <string>

#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "platform/lab/experiments/baselines.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/glint_predictor.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/point_run.hpp"

namespace glint {
namespace {

constexpr double k_sine_tilt_rad = 25 / k_degrees_per_radian;
constexpr double k_swing_rad_s = 2 * 6.283185307179586;
constexpr Duration k_sine_ahead = milliseconds(25);
constexpr int k_sine_frames = 225, k_first_judged = 45;
constexpr int k_sine_runs = 100, k_sine_quick_runs = 10;

struct Oscillation {
  const char* name;
  int axis;
  double amplitude_m;
  double bar_mm;
};
constexpr Oscillation k_swing_frames[] = {{"+-50 mm lateral", 0, 0.05, 1.8},
                                          {"+-50 mm axial", 2, 0.05, 3.1},
                                          {"+-25 mm lateral", 0, 0.025, 1.3},
                                          {"+-25 mm axial", 2, 0.025, 2.2}};

Pose oscillated(const Pose& middle, const Oscillation& swing, double phase, Time time) {
  Pose pose = middle;
  const double angle = k_swing_rad_s * (time - Time{}).seconds() + phase;
  pose.translation[swing.axis] += swing.amplitude_m * sine_cosine(angle).sine;
  return pose;
}

struct SineErrors {
  double squares = 0;
  int n = 0;
};

// Adds the errors of one run.
void add_sine_run(const PointNoise& noise, const Oscillation& swing, Predictor& predictor,
                  SineErrors& errors) {
  const PointCamera camera;
  const std::vector<Vector3> model = tool_8700339();
  const Pose middle = held_pose(k_sine_tilt_rad, noise.seed, noise.run);
  const double phase = 0.7 * static_cast<double>(noise.run);  // no simple fraction of a full turn
  for (int frame = 0; frame < k_sine_frames; ++frame) {
    const Time time = frame_time(frame);
    Result<UncertainPose> measured = measure(camera, model, oscillated(middle, swing, phase, time),
                                             noise, static_cast<std::uint64_t>(frame));
    if (!measured) continue;
    measured.value.time = time;
    predictor.update(measured.value);
    if (frame < k_first_judged) continue;
    const Vector3 truth = oscillated(middle, swing, phase, time + k_sine_ahead).translation;
    errors.squares += (predictor.predict(time + k_sine_ahead).translation - truth).squaredNorm();
    ++errors.n;
  }
}

ExperimentCase oscillation_case(const CaseOptions& options, const Oscillation& swing,
                                const char* method, const std::function<PredictorPointer()>& make,
                                Bar bar) {
  const int runs = options.quick ? k_sine_quick_runs : k_sine_runs;
  const SineErrors errors = options.piece([&] {
    SineErrors sums;
    for (int run = 0; run < runs; ++run) {
      add_sine_run({1, options.seed, static_cast<std::uint64_t>(run)}, swing, *make(), sums);
      if (options.progress) options.progress(run + 1, runs);
    }
    return sums;
  });
  return {std::string("2 Hz, ") + swing.name,
          method,
          errors.n,
          {{"error_rms", "mm", 1000 * std::sqrt(errors.squares / errors.n), bar}}};
}

}  // namespace

CaseList run_sine(const CaseOptions& options) {
  CaseList list{"sine", {}, {}};
  const ToolMotionSettings settings = EstimatorSettings{}.motion;
  for (const Oscillation& swing : k_swing_frames) {
    list.cases.push_back(oscillation_case(
        options, swing, "glint", [&] { return std::make_unique<GlintPredictor>(settings); },
        Bar::at_most(swing.bar_mm)));
    list.cases.push_back(oscillation_case(
        options, swing, "linear + SLERP", [] { return make_linear_slerp(); }, Bar::none()));
  }
  return list;
}

}  // namespace glint

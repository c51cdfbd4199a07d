#include "platform/lab/experiments/strokes_run.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "nodes/output.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/lab/experiments/experiment.hpp"
#include "platform/lab/experiments/prediction_run.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/tools/programming/smoothed_motion.hpp"

namespace glint {
namespace {

constexpr double k_inside_95_of_3 = 7.815;  // chi-square quantile, 3 degrees of freedom
constexpr Duration k_stroke_tick = milliseconds(4);
// The hand of sim::HandSettings moves from 2.4 to 12 s.
constexpr Time k_moving_from{2'400'000'000}, k_stroke_run_end{12'000'000'000};
constexpr double k_draw_begin_s = 3, k_draw_s = 6;
constexpr double k_edge_m = 0.3, k_circle_radius_m = 0.05;

Time stroke_time(double seconds) { return Time{std::llround(1e9 * seconds)}; }

// The tip's displacement along the edge or around the circle, in the world.
Vector3 along(StrokeShape shape, double t) {
  const double share = sim::smooth_step(t, k_draw_begin_s, k_draw_s);
  if (shape == StrokeShape::edge)
    return Vector3(0.1, (share - 0.5) * std::sqrt(k_edge_m * k_edge_m - 0.2 * 0.2), 0) +
           Vector3(0.2 * (share - 0.5) - 0.1, 0, 0);
  const SineCosine angle = sine_cosine(2 * std::numbers::pi * share);
  return k_circle_radius_m * Vector3(angle.cosine, angle.sine, 0);
}

// Distance of a displacement from the line that along() follows.
double distance_from_line(StrokeShape shape, const Vector3& offset) {
  if (shape == StrokeShape::circle)
    return std::hypot(offset.head<2>().norm() - k_circle_radius_m, offset.z());
  const Vector3 from = along(shape, 0), to = along(shape, k_draw_begin_s + k_draw_s);
  const Vector3 direction = (to - from).normalized();
  return (offset - from).cross(direction).norm();
}

class GuidedMotion final : public sim::Motion {
 public:
  explicit GuidedMotion(StrokeShape shape) : shape_(shape) {}
  [[nodiscard]] Pose pose(Time time) const override {
    return {Quaternion::Identity(), along(shape_, Duration{time.nanoseconds}.seconds())};
  }

 private:
  StrokeShape shape_;
};

sim::Scenario stroke_scenario(const StrokeCase& stroke, std::uint64_t seed) {
  sim::Scenario scenario = sim::hand_held_run(hololens2_ahat(), {}, seed);
  scenario.duration = k_stroke_run_end - Time{};
  if (stroke.slow) scenario.timing.slow.push_back({k_moving_from, k_stroke_run_end});
  if (stroke.shape != StrokeShape::hand) {
    sim::ToolBody& pen = scenario.tools.front();
    sim::HandSettings hand;  // turns the pen about its tip, which the edge guides
    hand.T_world_tool =
        sim::still_run(scenario.camera, {pen.tool}).tools.front().motion->pose(Time{});
    hand.grip_m = pen.tool.tip_m;
    hand.stroke_rms_m = hand.tremor_rms_m = 0;
    pen.motion = sim::attached_motion(std::make_shared<GuidedMotion>(stroke.shape),
                                      sim::hand_motion(hand, seed, 0));
  }
  return stroke.reference_body ? with_reference(std::move(scenario)) : scenario;
}

// The tracker and the tick group, as in a run.
class StrokeChain {
 public:
  StrokeChain(const sim::Scenario& scenario, bool reference_body) {
    cell_ = default_cell();
    set_camera(cell_, scenario.camera);
    cell_.camera.uncertainty = k_exact_camera;
    cell_.tools.count = 0;
    for (const sim::ToolBody& body : scenario.tools) {
      Tool& tool = cell_.tools.items[static_cast<std::size_t>(cell_.tools.count++)];
      tool = body.tool;
      tool.marker_sigma_m = tool.tip_sigma_m = 0;
    }
    cell_.reference = reference_body ? 1 : -1;
    cell_.robot_sigma_m = cell_.robot_sigma_rad = 0;
    configure(cell_, *tracker_);
    configure(cell_, *output_);
    tracker_->latest<ToolSet>().set(cell_.tools, 1, 0);
    robot_ = {RegistrationState::given, {}, 0, reference_body};
    output_->latest<RobotFrame>().set(robot_, 1, 0);
    frames_ = std::make_unique<MeasuredFrames>(0, cell_.camera.uncertainty.time_stamp_s);
  }

  void frame(const sim::SimFrame& frame) {
    tracker_->input<Frame>() = frame.view();
    tracker_->input<HeadPose>() = frame.head;
    tracker_->activate();
    output_->latest<Estimates>().set(tracker_->output<Estimates>(), ++version_, 0);
    frames_->add(tracked_frame(*tracker_), robot_);
  }

  [[nodiscard]] PoseSample sample(Time time) {
    output_->input<Now>() = {time, 0, 0};
    output_->activate();
    return output_->output<PoseSamples>().items[0];
  }

  [[nodiscard]] SmoothedMotion smoothed() const {
    SmoothedMotionSettings settings;
    settings.motion = cell_.motion;
    settings.slow_gap_max = cell_.lost_after;
    return {frames_->frames(), settings};
  }

 private:
  Cell cell_;
  RobotFrame robot_;
  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  std::unique_ptr<MeasuredFrames> frames_;
  std::uint64_t version_ = 0;
};

double root_mean(double sum, std::int64_t n) {
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : NAN;
}

}  // namespace

void StrokeErrors::add(const UncertainPose& estimate, const Pose& truth) {
  const Vector6 error = pose_difference(estimate.pose, truth);
  const Matrix3 position = estimate.covariance.topLeftCorner<3, 3>();
  const Matrix3 rotation = estimate.covariance.bottomRightCorner<3, 3>();
  const auto inside = [](const Matrix3& covariance, const Vector3& off) {
    const Cholesky<3> root(covariance);
    return root.positive && root.squared_length(off) <= k_inside_95_of_3 ? 1 : 0;
  };
  ++n;
  position_m2 += error.head<3>().squaredNorm();
  rotation_rad2 += error.tail<3>().squaredNorm();
  position_variance_m2 += position.trace();
  rotation_variance_rad2 += rotation.trace();
  position_inside += inside(position, error.head<3>());
  rotation_inside += inside(rotation, error.tail<3>());
}

void StrokeErrors::add(const StrokeErrors& other) {
  n += other.n;
  position_m2 += other.position_m2;
  rotation_rad2 += other.rotation_rad2;
  position_variance_m2 += other.position_variance_m2;
  rotation_variance_rad2 += other.rotation_variance_rad2;
  position_inside += other.position_inside;
  rotation_inside += other.rotation_inside;
  from_line_m2 += other.from_line_m2;
}

double StrokeErrors::position_rms_m() const { return root_mean(position_m2, n); }
double StrokeErrors::rotation_rms_rad() const { return root_mean(rotation_rad2, n); }
double StrokeErrors::position_sigma_m() const { return root_mean(position_variance_m2, n); }
double StrokeErrors::rotation_sigma_rad() const { return root_mean(rotation_variance_rad2, n); }
double StrokeErrors::from_line_rms_m() const { return root_mean(from_line_m2, n); }

void StrokeTally::add(const StrokeTally& other) {
  smoothed.add(other.smoothed);
  live.add(other.live);
  ticks += other.ticks;
  frames += other.frames;
}

StrokeTally follow_stroke(const StrokeCase& stroke, std::uint64_t seed) {
  StrokeTally tally;
  const sim::Simulator simulator(stroke_scenario(stroke, seed));
  const Tool& pen = simulator.scenario().tools.front().tool;
  StrokeChain chain(simulator.scenario(), stroke.reference_body);
  const Time begin = stroke_time(k_draw_begin_s), end = stroke_time(k_draw_begin_s + k_draw_s);
  std::vector<PoseSample> live;
  sim::SimFrame frame;
  int next = 0;
  for (Time tick; tick < k_stroke_run_end; tick = tick + k_stroke_tick) {
    for (; next < simulator.frame_count() && simulator.timing(next).arrival <= tick; ++next) {
      simulator.render(next, frame);
      chain.frame(frame);
    }
    if (tick >= begin && tick <= end) live.push_back(chain.sample(tick));
  }
  SmoothedMotion smoothed = chain.smoothed();
  smoothed.select(begin, end);
  tally.frames += smoothed.frames_used();
  tally.ticks += static_cast<std::int64_t>(live.size());
  const Pose T_world_robot = stroke.reference_body ? simulator.truth_tool(1, begin) : Pose{};
  const Vector3 rest =
      sim::still_run(simulator.scenario().camera, {pen}).tools.front().motion->pose(Time{}) *
      pen.tip_m;
  for (const PoseSample& sample : live) {
    PoseSample hindsight = sample;
    if (!sample.has_pose() || sample.frame != ReferenceFrame::robot || !smoothed.write(hindsight))
      continue;
    const Pose T_world_tool = simulator.truth_tool(0, sample.tick);
    const Pose truth =
        T_world_robot.inverse() * Pose{T_world_tool.rotation, T_world_tool * pen.tip_m};
    const auto judge = [&](const PoseSample& estimate, StrokeErrors& errors) {
      errors.add({estimate.tick, estimate.pose, estimate.covariance}, truth);
      if (stroke.shape == StrokeShape::hand) return;
      const Vector3 offset = T_world_robot * estimate.pose.translation - rest;
      const double off = distance_from_line(stroke.shape, offset);
      errors.from_line_m2 += off * off;
    };
    judge(hindsight, tally.smoothed);
    judge(sample, tally.live);
  }
  return tally;
}

StrokeErrors follow_recorded_stroke(const Trajectory& motion, Duration period, std::uint64_t seed) {
  StrokeErrors errors;
  PredictionSettings settings;
  settings.period = period;
  const NoisyRecording recording = noisy(motion, settings, seed);
  ToolMotion filter;  // adapts the process noise
  std::vector<StrokeFrame> frames;
  const auto judge = [&] {
    std::vector<SmoothedFrame> memory(frames.size());
    StrokeSmoother smoother;
    if (smoother.smooth(frames, filter.settings.motion, memory) != Reason::none) return;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
      for (const int quarter : {0, 1, 2, 3}) {
        const Time time = frames[i].measured.time + Duration{quarter * period.nanoseconds / 4};
        const Result<MotionState> state = smoother.at(time, frames);
        if (state) errors.add(pose_of(state.value), interpolated(recording.truth, time));
      }
    }
  };
  for (const UncertainPose& measured : recording.measured) {
    const bool follows =
        !frames.empty() &&
        2 * (measured.time - frames.back().measured.time).nanoseconds <= 3 * period.nanoseconds;
    if (!follows || frames.size() == k_stroke_frames_max) {
      judge();
      frames.clear();
    }
    if (filter.update(measured) != Reason::none) continue;
    frames.push_back({measured, filter.noise_scale(), {}, Matrix6::Zero()});
  }
  judge();
  return errors;
}

}  // namespace glint

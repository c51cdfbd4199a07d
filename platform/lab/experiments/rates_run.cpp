#include "platform/lab/experiments/rates_run.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/motion/integrate_motion.hpp"
#include "kernels/motion/predict_motion.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/point_run.hpp"
#include "platform/lab/experiments/point_view.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/hand_motion.hpp"

namespace glint {
namespace {

constexpr Duration k_tick = milliseconds(4);
constexpr Time k_never{INT64_MIN / 2};
constexpr double k_rates_tilt_rad = 0.5;
constexpr std::uint64_t k_view_case = 3000;  // case number of the random numbers

// The pen, with the mean of its markers as origin.
Tool centred_pen() {
  Tool tool = five_marker_pen().tool;
  const Vector3 mean = marker_mean(tool);
  for (Vector3& marker : tool.markers_m) marker -= mean;
  tool.tip_m -= mean;
  return tool;
}

// Hand motion that alternates between rest and drawing, from a random phase of its cycle on.
sim::MotionPointer hand_of(const RatesRun& run) {
  sim::HandSettings settings;
  settings.T_world_tool = held_pose(k_rates_tilt_rad, run.seed, run.run);
  const sim::RandomKey key{run.seed, sim::Stream::hand, 1};
  settings.begin_s = -settings.cycle_s * sim::uniform(key, run.run);
  return sim::hand_motion(settings, run.seed, run.run);
}

// Bytes of a kernel's state, for a bitwise comparison.
template <class State>
std::vector<std::byte> bytes_of(const State& state) {
  std::vector<std::byte> bytes(sizeof state);
  std::memcpy(bytes.data(), static_cast<const void*>(&state), sizeof state);
  return bytes;
}

class MotionChain {
 public:
  MotionChain(const RatesRun& run, const Tool& tool) : run_(run) {
    motion_.settings = EstimatorSettings{}.motion;
    if (integrator_.prepare(motion_.settings.motion) != Reason::none)
      throw std::runtime_error("SUNDIALS cannot be prepared: no memory");
    model_.assign(tool.markers_m.begin(), tool.markers_m.begin() + tool.marker_count);
  }

  void frame(const sim::FrameTiming& timing, const Pose& truth, RatesTally& tally) {
    FrameVerdict verdict;
    check_({timing.mid_exposure, {}, timing.arrival, timing.sequence + 1, Reason::none}, verdict);
    ++(verdict.usable() ? tally.accepted : tally.rejected);
    Result<UncertainPose> measured =
        measure(camera_, model_, truth, {1, run_.seed, run_.run}, timing.sequence);
    if (!measured) return;
    measured.value.time = timing.mid_exposure;
    if (verdict.usable()) {
      (void)motion_.update(measured.value);
      return;
    }
    // The filter itself must reject what the node has rejected.
    const std::vector<std::byte> before = bytes_of(motion_);
    (void)motion_.update(measured.value);
    if (bytes_of(motion_) != before) ++tally.rejected_changed;
  }

  void tick(Time time, const Pose& truth, Consistency& consistency) {
    if (!motion_.known()) return;
    const MotionState state = motion_.estimate();
    UncertainPose then = predict_pose(state, time, motion_.settings.motion, motion_.noise_scale());
    const Result<MovingPose> later = integrator_.after(state, time - state.time);
    if (later) then.pose = later.value.pose;
    consistency.add(then, truth);
  }

 private:
  RatesRun run_;
  PointCamera camera_;
  std::vector<Vector3> model_;
  CheckFrame check_;
  ToolMotion motion_;
  MotionIntegrator integrator_;
};

bool same(const Pose& a, const Pose& b) {
  return std::memcmp(a.translation.data(), b.translation.data(), 3 * sizeof(double)) == 0 &&
         std::memcmp(a.rotation.coeffs().data(), b.rotation.coeffs().data(), 4 * sizeof(double)) ==
             0;
}

bool same(const PoseSample& a, const PoseSample& b) {
  return same(a.pose, b.pose) && a.state == b.state && a.measurement == b.measurement &&
         std::memcmp(a.covariance.data(), b.covariance.data(), 36 * sizeof(double)) == 0;
}

class GraphChain {
 public:
  GraphChain(const RatesRun& run, const Tool& tool)
      : tool_(tool), camera_(hololens2_ahat()), run_(run) {
    Cell cell = default_cell();
    set_camera(cell, camera_);
    cell.tools.items[0] = tool;
    cell.tools.count = 1;
    configure(cell, *tracker_);
    configure(cell, *output_);
    tracker_->latest<ToolSet>().set(cell.tools, 1, 0);
    tracker_->input<HeadPose>().valid = true;
    output_->latest<RobotFrame>().set({RegistrationState::given, {}, 0}, 1, 0);
  }

  void frame(const sim::FrameTiming& timing, const Pose& truth, Time next_tick, RatesTally& tally) {
    SampleNumbers numbers(run_.seed, k_view_case + run_.run, timing.sequence);
    view_->clear();
    for (int i = 0; i < tool_.marker_count; ++i) {
      const Vector3 place = truth * tool_.markers_m[static_cast<std::size_t>(i)];
      (void)view_->add(camera_, tool_, place, i, ObservationNoise{}, numbers);
    }
    const PoseSample before = sample(next_tick);
    tracker_->input<FrameStamp>() = {
        timing.mid_exposure, {}, timing.arrival, timing.sequence + 1, Reason::none};
    tracker_->input<Markers>() = view_->markers;
    tracker_->activate();
    const Estimates& estimates = tracker_->output<Estimates>();
    output_->latest<Estimates>().set(estimates, ++version_, 0);
    if (!estimates.verdict.usable() && !same(before, sample(next_tick))) ++tally.rejected_changed;
    const Duration age = next_tick - timing.mid_exposure;
    if (estimates.verdict.usable() && fresh(age, camera_.period)) ++frames_unmeasured_;
  }

  // newest: latest exposure whose frame has arrived with a true time stamp, or k_never.
  void tick(Time time, Time newest, const Pose& truth, GraphTally& graph, RatesTally& tally) {
    const PoseSample now = sample(time);
    ++graph.ticks;
    graph.states_correct += now.state == expected_state(time, newest, camera_.period) ? 1 : 0;
    const bool measured = now.state == TrackState::measured;
    if (measured && !was_measured_)
      tally.frames_to_measured = std::max(tally.frames_to_measured, frames_unmeasured_);
    if (measured || was_measured_) frames_unmeasured_ = 0;
    was_measured_ = measured;
    if (!now.has_pose()) return;
    const std::int64_t age_error = now.age().nanoseconds - (time - newest).nanoseconds;
    graph.age_error_max_ns = std::max(graph.age_error_max_ns, std::abs(age_error));
    const Pose tip{truth.rotation, truth * tool_.tip_m};
    graph.tip.add({time, now.pose, now.covariance}, tip);
  }

 private:
  static bool fresh(Duration age, Duration period) {
    return 2 * age.nanoseconds <= 3 * period.nanoseconds;
  }

  // Expected track state, from the schedule alone.
  static TrackState expected_state(Time time, Time newest, Duration period) {
    if (newest == k_never) return TrackState::none;
    if (fresh(time - newest, period)) return TrackState::measured;
    return time - newest <= k_lost_after ? TrackState::predicted : TrackState::lost;
  }

  PoseSample sample(Time time) {
    output_->input<Now>() = {time, 0, 0};
    output_->activate();
    return output_->output<PoseSamples>().items[0];
  }

  Tool tool_;
  Camera camera_;
  RatesRun run_;
  std::unique_ptr<MarkerTracker> tracker_ = std::make_unique<MarkerTracker>();
  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  std::unique_ptr<PointView> view_ = std::make_unique<PointView>();
  std::uint64_t version_ = 0;
  std::int64_t frames_unmeasured_ = 0;
  bool was_measured_ = false;
};

}  // namespace

void GraphTally::add(const GraphTally& other) {
  ticks += other.ticks;
  states_correct += other.states_correct;
  age_error_max_ns = std::max(age_error_max_ns, other.age_error_max_ns);
  tip.add(other.tip);
}

void RatesTally::add(const RatesTally& other) {
  for (std::size_t rate = 0; rate < graph.size(); ++rate) {
    graph[rate].add(other.graph[rate]);
    motion[rate].add(other.motion[rate]);
  }
  accepted += other.accepted;
  rejected += other.rejected;
  rejected_changed += other.rejected_changed;
  frames_to_measured = std::max(frames_to_measured, other.frames_to_measured);
}

RatesTally follow_rates(const RatesRun& run) {
  RatesTally tally;
  const Camera camera = hololens2_ahat();
  const Tool tool = centred_pen();
  const sim::MotionPointer hand = hand_of(run);
  const std::vector<sim::FrameTiming> frames =
      rates_schedule(camera, run.faults, run.seed * 1000 + run.run);
  MotionChain motion(run, tool);
  GraphChain graph(run, tool);
  Time newest = k_never;
  std::size_t next = 0;
  for (Time time; time < Time{} + k_rates_length; time = time + k_tick) {
    for (; next < frames.size() && frames[next].arrival <= time; ++next) {
      const sim::FrameTiming& frame = frames[next];
      const Pose truth = hand->pose(frame.exposed);
      motion.frame(frame, truth, tally);
      graph.frame(frame, truth, time, tally);
      if (frame.mid_exposure == frame.exposed) newest = std::max(newest, frame.exposed);
    }
    const Rate rate = time >= k_slow_from && time < k_slow_until ? Rate::slow : Rate::fast;
    const auto r = static_cast<std::size_t>(rate);
    const Pose truth = hand->pose(time);
    motion.tick(time, truth, tally.motion[r]);
    graph.tick(time, newest, truth, tally.graph[r], tally);
  }
  return tally;
}

}  // namespace glint

#include "platform/runtime/session/session_groups.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "graph/describe.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {
namespace {

std::unique_ptr<FrameMethod> method_of(const Cell& cell, const SessionOptions& options) {
  if (cell.method == Method::glint) return nullptr;
  if (options.method) return options.method(cell);
  throw InputError(cell.file + ": method is \"seed\": not in this program; expected \"glint\"");
}

template <class G>
RunnerSettings<G> runner_settings(const GroupSchedule<G>& plan, std::uint8_t group,
                                  const Cell& cell, const SessionOptions& options,
                                  TraceWriter* trace) {
  RunnerSettings<G> settings;
  settings.plan = plan.tables;
  settings.group = group;
  settings.live = cell.realtime;
  settings.bounds_ns = plan.bounds_ns;
  settings.trace = trace;
  for (std::size_t w = 1; w < plan.cores.size(); ++w) {
    // Without real time worker 0 is a normal thread on any core; so are the others.
    settings.worker_threads.push_back(
        cell.realtime ? ThreadSettings{"glint-worker", plan.cores[w], plan.priority}
                      : ThreadSettings{"glint-worker"});
  }
  const bool is_tick = group == k_tick_group;
  for (const Injection& injection : options.injections) {
    if (injection.in_tick == is_tick) settings.injections.push_back(injection);
  }
  settings.watch.deadline = is_tick ? cell.deadlines.tick : cell.deadlines.frame;
  settings.watch.policy = is_tick ? cell.overrun.tick : cell.overrun.frame;
  settings.watch.remaining_ns = plan.remaining_ns;
  settings.watch.on = cell.overrun.watch && (cell.realtime || !settings.injections.empty());
  if (!cell.realtime && settings.watch.on) {
    // Only injected delays advance time: one worker, so that every run makes the same decisions.
    settings.plan = graph::default_schedule<G>(1);
    settings.worker_threads.clear();
    settings.watch.remaining_ns = remaining_in_order(plan.bounds_ns);
  }
  return settings;
}

template <class G>
nlohmann::ordered_json group_json(const char* name, const GroupSchedule<G>& plan) {
  nlohmann::ordered_json nodes = nlohmann::ordered_json::array(), cores = nodes;
  int number = 0;
  for (const graph::NodeInfo& node : graph::Description<G>::nodes) {
    std::string text(node.name);
    if (node.copies > 1) text.append("#").append(std::to_string(node.copy));
    nodes.push_back(text);
    const auto worker = plan.tables.worker[static_cast<std::size_t>(number++)];
    cores.push_back(plan.cores[worker]);
  }
  return {{"name", name}, {"nodes", nodes}, {"cores", cores}};
}

}  // namespace

SessionGroups::SessionGroups(const Cell& cell, const SessionOptions& options, KeptFrames kept,
                             Sinks& sinks, TraceWriter* trace, const Clock& now,
                             std::int64_t unix_offset_ns, BackgroundScene scene)
    : frame_runner_(runner_settings(options.plan.frame, k_frame_group, cell, options, trace)),
      tick_runner_(runner_settings(options.plan.tick, k_tick_group, cell, options, trace)),
      counters_(&sinks.overruns()),
      roster_(cell, &sinks.tool_requests()),
      frame_(cell, roster_.published(), now, frame_runner_,
             sinks.recorder() != nullptr ? &sinks.recorder()->frame_lane() : nullptr,
             method_of(cell, options)),
      tick_(cell, frame_.estimates(), robot_, sinks.held_buttons(), now,
            {sinks.can(),
             sinks.dds(),
             sinks.files(),
             sinks.recorder() != nullptr ? &sinks.recorder()->tick_lane() : nullptr,
             sinks.recorder(),
             &sinks.losses(),
             {},
             options.headset,
             sinks.openigtlink()},
            unix_offset_ns, kept.latencies > 0 ? kept.latencies : LatencyLog::k_entries_max,
            tick_runner_, frame_.overrun_notes()),
      calibration_(cell),
      calibration_notes_(&sinks.calibration_notes()) {
  robot_.write_slot() = declared_robot_frame(cell);
  robot_.publish(1, 0);
  outcomes_.resize(kept.outcomes);
  frame_.publish_transforms_to(sinks.dds());
  if (cell.tick_release == TickRelease::estimate) frame_.announce_to(&measured_);
  if (options.plan.background) {
    Recorder* const recorder = sinks.recorder();
    background_ = std::make_unique<BackgroundGroup>(
        cell, *options.plan.background, trace, std::move(scene),
        RobotSinks{&robot_, recorder != nullptr ? &recorder->slice_lane() : nullptr,
                   &sinks.robot_notes(), sinks.dds()});
    if (sinks.inputs() != nullptr) background_->set_joint_source(sinks.inputs()->joints());
  }
}

void SessionGroups::process(const ArrivedFrame& arrived) noexcept {
  frame_.process(arrived);
  counters_->frame.store(frame_runner_.overruns().total(), std::memory_order_relaxed);
  const Estimates& newest = frame_.newest();
  if (processed_ < outcomes_.size()) {
    outcomes_[processed_] = outcome_of(newest, frame_.tracker());
  }
  if (frame_.tracker() != nullptr) calibration_.add_frame(*frame_.tracker());
  ++processed_;
  if (decisions_.add(arrived.frame.sequence, newest, frame_runner_)) ++tracked_;
  if (background_ == nullptr) return;
  background_->tracked().write_slot() = capsules_of(newest);
  background_->tracked().publish(processed_, arrived.frame.arrival.nanoseconds);
}

void SessionGroups::tick(std::uint64_t number, Time nominal, Time woken) noexcept {
  tick_.tick(number, nominal, woken);
  decisions_.add(number, tick_.samples(), tick_runner_);
  counters_->tick.store(tick_runner_.overruns().total(), std::memory_order_relaxed);
  counters_->source.store(tick_.ticks_source_late(), std::memory_order_relaxed);
}

void SessionGroups::report(SessionResult& result) {
  outcomes_.resize(std::min(processed_, outcomes_.size()));
  result.outcomes = std::move(outcomes_);
  result.frames = static_cast<std::int64_t>(processed_);
  result.frames_tracked = static_cast<std::int64_t>(tracked_);
  result.noise = frame_.newest().noise;
  result.calibration = calibration_.findings();
  const SentTicks& sent = tick_.sent();
  result.sent = sent.summary();
  result.latencies = sent.latencies().entries();
  result.latencies_overwritten = sent.latencies().overwritten();
  result.ticks_source_late = tick_.ticks_source_late();
  result.worker_overruns = frame_runner_.overlong_waits() + tick_runner_.overlong_waits();
  result.frame_overruns = frame_runner_.overruns();
  result.tick_overruns = tick_runner_.overruns();
  if (background_ != nullptr) result.background = background_->counts();
  result.can_frames = tick_.can_frames();
  result.output_sha256 = tick_.output_sha256();
  result.decision_sha256 = decisions_.hex();
  for (const auto& reports : {frame_runner_.reports(), tick_runner_.reports()}) {
    for (const ThreadReport& report : reports) {
      if (!report.refused.empty()) result.refused.push_back(report.name + ": " + report.refused);
    }
  }
}

std::string trace_header(const Cell& cell, const RunSchedule& plan, std::int64_t epoch_unix_ns) {
  nlohmann::ordered_json groups{group_json("frame", plan.frame), group_json("tick", plan.tick)};
  if (plan.background) groups.push_back(group_json("background", *plan.background));
  return nlohmann::ordered_json{{"groups", groups},
                                {"epoch_unix_ns", epoch_unix_ns},
                                {"board", plan.board},
                                {"cell", cell.file}}
      .dump();
}

}  // namespace glint

#include "platform/boards/board_groups.hpp"

#include <array>
#include <span>
#include <utility>

#include "kernels/wire/bits.hpp"
#include "platform/session/pipeline.hpp"
#include "platform/session/run_plan.hpp"

namespace glint {

namespace {

// One core, every node in the graph's order, deadlines watched as the cell says.
template <class G>
RunnerSettings<G> runner_settings(std::uint8_t group, Duration deadline,
                                  graph::OverrunPolicy policy, bool watch,
                                  const std::vector<std::int64_t>& bounds_ns) {
  RunnerSettings<G> settings;
  settings.group = group;
  settings.watch.remaining_ns = remaining_in_order(bounds_ns);
  settings.watch.deadline = deadline;
  settings.watch.policy = policy;
  settings.watch.on = watch;
  return settings;
}

// After each activation: how many overruns of each kind there were so far, and what was decided on
// the last, after which node.
template <class G>
void add_decisions(const GroupRunner<G>& runner, Sha256& hash) {
  std::array<std::uint8_t, 18> said{};
  put_little_endian(std::span(said).first(8), runner.overruns().will_miss);
  put_little_endian(std::span(said).subspan(8, 8), runner.overruns().missed);
  said[16] = static_cast<std::uint8_t>(runner.last_overrun().policy);
  said[17] = runner.last_overrun().after_node;
  hash.add(said);
}

}  // namespace

BoardGroups::BoardGroups(const Cell& cell, Sinks& sinks, const Clock& now,
                         std::int64_t unix_offset_ns, std::size_t frames, const BoardBounds& bounds,
                         BackgroundScene scene)
    : roster_(cell),
      frame_runner_(runner_settings<Tracker>(k_frame_group, cell.deadlines.frame,
                                             cell.overrun.frame, cell.overrun.watch,
                                             bounds.frame_ns)),
      tick_runner_(runner_settings<Output>(k_tick_group, cell.deadlines.tick, cell.overrun.tick,
                                           cell.overrun.watch, bounds.tick_ns)),
      frame_(cell, roster_.published(), now, frame_runner_,
             sinks.recorder() != nullptr ? &sinks.recorder()->frame_lane() : nullptr),
      tick_(cell, frame_.estimates(), robot_, sinks.held_buttons(), now,
            {sinks.can(), sinks.dds(), nullptr,
             sinks.recorder() != nullptr ? &sinks.recorder()->tick_lane() : nullptr,
             sinks.recorder(), &sinks.losses()},
            unix_offset_ns, frames, tick_runner_, frame_.overrun_notes()) {
  frame_.tell_transforms_to(sinks.dds());
  robot_.write_slot() = declared_robot_frame(cell);
  robot_.publish(1, 0);
  if (!cell.background) return;
  Recorder* const recorder = sinks.recorder();
  background_ = std::make_unique<BackgroundGroup>(
      cell, *plan_by_rule(cell).background, nullptr, std::move(scene),
      RobotSinks{&robot_, recorder != nullptr ? &recorder->slice_lane() : nullptr,
                 &sinks.robot_notes(), sinks.dds()});
  if (sinks.inputs() != nullptr) background_->hear(sinks.inputs()->joints());
}

void BoardGroups::process(const ArrivedFrame& arrived) noexcept {
  frame_.process(arrived);
  const Estimates& estimates = frame_.newest();
  std::array<std::uint8_t, 5> said{};
  put_little_endian(std::span(said).first(4), arrived.frame.sequence);
  said[4] = static_cast<std::uint8_t>(estimates.verdict.reason);
  verdicts_.add(said);
  bool seen = false;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const Track& track = estimates.tracks[static_cast<std::size_t>(t)];
    seen = seen || track.seen_now;
    const std::array<std::uint8_t, 3> of_tool{static_cast<std::uint8_t>(track.seen_now),
                                              static_cast<std::uint8_t>(track.reason),
                                              track.marker_mask};
    verdicts_.add(of_tool);
  }
  add_decisions(frame_runner_, verdicts_);
  ++frames_;
  if (seen) ++tracked_;
  if (background_ == nullptr) return;
  background_->tracked().write_slot() = capsules_of(estimates);
  background_->tracked().publish(static_cast<std::uint64_t>(frames_),
                                 arrived.frame.arrival.nanoseconds);
}

void BoardGroups::tick(std::uint64_t number, Time nominal, Time woken) noexcept {
  tick_.tick(number, nominal, woken);
  const PoseSamples& samples = tick_.samples();
  for (int t = 0; t < samples.count; ++t) {
    const PoseSample& sample = samples.items[static_cast<std::size_t>(t)];
    std::array<std::uint8_t, 10> said{};
    put_little_endian(std::span(said).first(4), number);
    put_little_endian(std::span(said).subspan(4, 4), sample.frame_sequence);
    said[8] = static_cast<std::uint8_t>(sample.state);
    said[9] = static_cast<std::uint8_t>(sample.reason);
    states_.add(said);
  }
  add_decisions(tick_runner_, states_);
}

void BoardGroups::report(BoardResult& result) {
  result.frames = frames_;
  result.frames_tracked = tracked_;
  result.frame_overruns = frame_runner_.overruns();
  result.tick_overruns = tick_runner_.overruns();
  const SentTicks& sent = tick_.sent();
  result.sent = sent.left();
  result.latencies = sent.latencies().entries();
  result.latencies_left_out = sent.latencies().left_out();
  if (background_ != nullptr) result.background = background_->counts();
  result.can_frames = tick_.can_frames();
  result.output_sha256 = tick_.output_sha256();
  Sha256 both;
  both.add(verdicts_.digest());
  both.add(states_.digest());
  result.decision_sha256 = both.hex();
}

}  // namespace glint

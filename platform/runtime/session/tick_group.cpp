#include "platform/runtime/session/tick_group.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "kernels/wire/node_frames.hpp"
#include "kernels/wire/output_record.hpp"
#include "nodes/overrun_effects.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {

template class GroupRunner<Output>;

namespace {

// PredictTools still runs: its samples have the buttons and the newest frame's time.
constexpr graph::OverrunDecision k_not_enabled{graph::OverrunKind::not_enabled,
                                               graph::OverrunPolicy::stop_safe, 0};

}  // namespace

TickGroup::TickGroup(const Cell& cell, graph::TripleBuffer<Estimates>& estimates,
                     graph::TripleBuffer<RobotFrame>& robot,
                     graph::TripleBuffer<PenButtons>& buttons, Clock now, TickSinks sinks,
                     std::int64_t unix_offset_ns, std::size_t latency_entries,
                     GroupRunner<Output>& runner, OverrunNotes& frame_notes)
    : group_(*output_, k_tick_group),
      now_(std::move(now)),
      sinks_(std::move(sinks)),
      runner_(&runner),
      frame_notes_(&frame_notes),
      node_(static_cast<unsigned>(cell.can.node)),
      frames_a_pose_(can_frames_per_pose(cell.can.format)),
      tick_release_(cell.tick_release),
      lost_after_(cell.lost_after),
      samples_(&output_->output<PoseSamples>()),
      frames_(&output_->output<CanFrames>()),
      unix_offset_ns_(unix_offset_ns),
      losses_({sinks_.can, sinks_.dds, sinks_.recorder, sinks_.files, sinks_.losses}),
      sent_(latency_entries) {
  configure(cell, *output_);
  output_->latest<Estimates>().bind(estimates);
  output_->latest<RobotFrame>().bind(robot);
  output_->latest<PenButtons>().bind(buttons);
}

void TickGroup::tick(std::uint64_t number, Time nominal, Time woken) noexcept {
  (void)group_.release(nominal.nanoseconds);
  run({nominal, number, unix_offset_ns_}, woken, nullptr);
}

bool TickGroup::release_as(const ChoiceRecord& recorded) noexcept {
  return group_.release_as(as_choice(recorded));
}

void TickGroup::tick_as(std::uint64_t number, const ChoiceRecord& recorded) noexcept {
  run({recorded.nominal, number, recorded.unix_offset_ns}, recorded.nominal, &recorded.overrun);
}

void TickGroup::run(const Now& now, Time woken, const graph::OverrunDecision* recorded) noexcept {
  output_->input<Now>() = now;
  // State of PackCan before the tick; restored if its frames do not leave.
  const PackCan previous_state = output_->node<PackCan>();
  if (recorded == nullptr && !enabled_) recorded = &k_not_enabled;
  overrun_ = recorded != nullptr ? runner_->run_as(*output_, *recorded, recorded->after_node)
                                 : runner_->run(*output_, {group_.choice().activation, now.number,
                                                           now.tick, woken, carried_sequence()});
  skipped_ = false;
  if (overrun_.happened()) {
    output_->node<PackCan>() = previous_state;
    compute_substitute(now);
  } else {
    samples_ = &output_->output<PoseSamples>();
    frames_ = &output_->output<CanFrames>();
  }
  if (source_ != nullptr && source_->late(now.tick) && lacks_measurement()) ++ticks_source_late_;
  if (source_ != nullptr && source_->faults() != nullptr) {
    source_->faults()->check_silence(now.tick);
  }
  losses_.count();
  if (!skipped_) send(now, woken);
  runner_->finish_activation(*output_);
  if (!overrun_.happened()) *in_time_ = *samples_;

  if (sinks_.lane != nullptr) {
    ChoiceRecord choice = as_record(group_.choice(), unix_offset_ns_);
    choice.overrun = overrun_;
    (void)sinks_.lane->offer_choice(choice);
  }
  offer_samples();
}

void TickGroup::stop_safe() noexcept { send_alone(heartbeat_frame(node_, CanNodeState::stopped)); }

void TickGroup::compute_substitute(const Now& now) noexcept {
  if (overrun_.kind == graph::OverrunKind::not_enabled) {
    *in_time_ = output_->output<PoseSamples>();
  } else {
    (void)own_notes_.push({k_tick_group, overrun_});
  }
  samples_ = substitute_.get();
  frames_ = substitute_frames_.get();
  substitute_frames_->count = 0;
  const OverrunTick tick{now, lost_after_, output_->latest<PenButtons>().value()};
  skipped_ = !substitute(overrun_.policy, tick, *in_time_, *substitute_);
  if (skipped_) {
    substitute_->count = 0;
    return;
  }
  output_->node<PackCan>()(now, *substitute_, *substitute_frames_);
}

void TickGroup::offer_samples() noexcept {
  static_assert(k_output_record_bytes <= k_offered_record_bytes_max);
  std::array<std::uint8_t, k_output_record_bytes> record;
  const std::optional<Time> newest =
      samples_->any_frame ? std::optional(samples_->newest_frame) : std::nullopt;
  for (int t = 0; t < samples_->count; ++t) {
    const PoseSample& sample = samples_->items[static_cast<std::size_t>(t)];
    encode(sample, record);
    hash_.add(record);
    ++records_;
    if (sinks_.lane != nullptr) (void)sinks_.lane->offer_output(sample, record);
    if (sinks_.dds != nullptr) (void)sinks_.dds->offer(sample);
    if (sinks_.openigtlink != nullptr) (void)sinks_.openigtlink->offer(sample);
    if (sinks_.files != nullptr) sinks_.files->offer(sample, newest);
    if (sinks_.record) sinks_.record(record);
    if (sinks_.headset != nullptr) {
      sinks_.headset->offer({sample, output_->latest<RobotFrame>().value(), {unix_offset_ns_}});
    }
  }
}

std::uint64_t TickGroup::carried_sequence() const noexcept {
  return std::as_const(*output_).token<graph::Latest<Estimates>>().value().verdict.stamp.sequence;
}

// Number of pose frames at this tick; they precede the node's own frames.
std::size_t TickGroup::pose_frames() const noexcept {
  return static_cast<std::size_t>(std::min(samples_->count * frames_a_pose_, frames_->count));
}

bool TickGroup::lacks_measurement() const noexcept {
  if (skipped_) return true;
  for (int t = 0; t < samples_->count; ++t) {
    if (samples_->items[static_cast<std::size_t>(t)].state == TrackState::measured) return false;
  }
  return true;
}

void TickGroup::send(const Now& now, Time woken) noexcept {
  send_poses(woken);
  for (const CanFrame& frame : frames_->frames().subspan(pose_frames())) {
    send_alone(with_node_state(frame));
  }
  send_emergency(now.tick);
  runner_->add_span(k_span_sent, woken, now_());
}

// While not enabled, the heartbeat after the boot-up message is "stopped".
CanFrame TickGroup::with_node_state(const CanFrame& frame) const noexcept {
  const CanFrame stopped = heartbeat_frame(node_, CanNodeState::stopped);
  const bool replaced = overrun_.kind == graph::OverrunKind::not_enabled &&
                        frame.identifier == stopped.identifier &&
                        frame.data[0] != static_cast<std::uint8_t>(CanNodeState::boot_up);
  return replaced ? stopped : frame;
}

void TickGroup::send_poses(Time woken) noexcept {
  const auto& estimates = std::as_const(*output_).token<graph::Latest<Estimates>>();
  // A substitute carries older estimates: the newest ones remain for the next tick. If
  // estimates release ticks, one that measured no tool is carried by the clock's: it has no
  // latency.
  const bool counts = tick_release_ == TickRelease::clock || has_measurement(estimates.value());
  const bool first_carried = !overrun_.happened() && estimates.version() != carried_version_ &&
                             estimates.value().verdict.usable() && counts;
  if (!overrun_.happened() && !first_carried) carried_version_ = estimates.version();
  if (pose_frames() == 0) return;

  TickOfFrames tick;
  tick.all_accepted = true;
  tick.tools = samples_->count;
  for (int t = 0; t < tick.tools; ++t) {
    tick.states[static_cast<std::size_t>(t)] = samples_->items[static_cast<std::size_t>(t)].state;
  }
  bool first = true;
  if (sinks_.can != nullptr) sinks_.can->begin_set();
  for (const CanFrame& frame : frames_->frames().first(pose_frames())) {
    const Time time = now_();
    const bool accepted = send_one(frame, time);
    tick.all_accepted = tick.all_accepted && accepted;
    if (first) tick.at = time;
    if (first && accepted && first_carried) {
      // If this frame is refused, the next tick is the first to carry the estimate.
      carried_version_ = estimates.version();
      const Time published{estimates.time_ns()};
      tick.carries = true;
      tick.latency = {published - estimates.value().verdict.stamp.arrival, woken - published,
                      now_() - woken};
    }
    first = false;
  }
  tick.last = can_accepted_;
  if (tick.all_accepted || tick.carries) sent_.add(tick, sinks_.can->counts().sent);
}

// Sends at most one emergency per tick: first the frame group's overruns, then the tick's, then
// losses. The others remain queued for later ticks.
void TickGroup::send_emergency(Time tick) noexcept {
  OverrunNote note;
  if (frame_notes_->pop(note) || own_notes_.pop(note)) {
    const graph::OverrunDecision& decision = note.decision;
    send_alone(overrun_frame(node_, {note.group, static_cast<std::uint8_t>(decision.kind),
                                     reason_of(decision.policy), decision.after_node}));
    return;
  }
  if (const auto kind = losses_.next_due_report(tick)) {
    send_alone(lost_output_frame(node_, static_cast<std::uint8_t>(*kind)));
  }
}

void TickGroup::send_alone(const CanFrame& frame) noexcept {
  if (sinks_.can != nullptr) sinks_.can->begin_set();
  (void)send_one(frame, now_());
}

bool TickGroup::send_one(const CanFrame& frame, Time time) noexcept {
  ++can_frames_;
  const bool accepted = sinks_.can != nullptr && sinks_.can->send(frame, time);
  if (accepted) ++can_accepted_;
  return accepted;
}

const SentTicks& TickGroup::sent() noexcept {
  if (sinks_.can != nullptr) {
    sinks_.can->flush();
    sent_.settle(sinks_.can->counts().sent);
  }
  return sent_;
}

std::string TickGroup::output_sha256() const { return hash_.hex(); }

}  // namespace glint

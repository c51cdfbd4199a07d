#include "platform/session/tick_group.hpp"

#include <array>
#include <utility>

#include "kernels/wire/output_record.hpp"
#include "platform/session/pipeline.hpp"

namespace glint {

TickGroup::TickGroup(const Cell& cell, graph::TripleBuffer<Estimates>& estimates,
                     graph::TripleBuffer<RobotFrame>& robot, Clock now, TickSinks sinks,
                     std::int64_t unix_offset_ns, std::size_t latency_entries)
    : group_(*output_, k_tick_group),
      now_(std::move(now)),
      sinks_(sinks),
      unix_offset_ns_(unix_offset_ns),
      latencies_(latency_entries) {
  configure(cell, *output_);
  output_->latest<Estimates>().bind(estimates);
  output_->latest<RobotFrame>().bind(robot);
}

void TickGroup::tick(std::uint32_t number, Time nominal, Time woken) noexcept {
  output_->input<Now>() = {nominal, number, unix_offset_ns_};
  (void)group_.release(nominal.nanoseconds);
  group_.activate();
  send(woken);

  if (sinks_.lane != nullptr) {
    (void)sinks_.lane->offer_choice(as_record(group_.choice(), unix_offset_ns_));
  }
  const PoseSamples& samples = output_->output<PoseSamples>();
  std::array<std::uint8_t, k_output_record_bytes> record;
  for (int t = 0; t < samples.count; ++t) {
    const PoseSample& sample = samples.items[static_cast<std::size_t>(t)];
    encode(sample, record);
    hash_.add(record);
    ++records_;
    if (sinks_.lane != nullptr) (void)sinks_.lane->offer_output(sample, record);
    if (sinks_.dds != nullptr) (void)sinks_.dds->offer(sample);
    if (sinks_.files != nullptr) sinks_.files->offer(sample);
  }
}

void TickGroup::send(Time woken) noexcept {
  const auto& estimates = std::as_const(*output_).token<graph::Latest<Estimates>>();
  const bool first_carried =
      estimates.version() != carried_version_ && estimates.value().verdict.usable();
  carried_version_ = estimates.version();

  bool first = true;
  for (const CanFrame& frame : output_->output<CanFrames>().frames()) {
    if (sinks_.can != nullptr) sinks_.can->send(frame, now_());
    ++can_frames_;
    if (first && first_carried) {
      const Time published{estimates.time_ns()};
      latencies_.add(
          {published - estimates.value().verdict.stamp.arrival, woken - published, now_() - woken});
    }
    first = false;
  }
}

std::string TickGroup::output_sha256() const { return hash_.hex(); }

}  // namespace glint

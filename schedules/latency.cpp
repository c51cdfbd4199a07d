#include "schedules/latency.hpp"

namespace glint {
namespace {

void add(Chain& chain, const char* name, StageKind kind, std::int64_t ns) {
  chain.stages.push_back({name, kind, ns});
  chain.total_ns += ns;
  if (kind == StageKind::estimate) chain.estimate_ns += ns;
}

// No stage of zero blocking: only a resumable group blocks.
void add_blocking(Chain& chain, const char* name, const SharedResponse& response) {
  if (response.blocking_ns > 0) add(chain, name, StageKind::bound, response.blocking_ns);
}

void add_groups(Chain& chain, const ChainParts& parts, std::int64_t writes_ns) {
  add(chain, "frame: wake-up", StageKind::estimate, parts.frame.wake_up_ns);
  add_blocking(chain, "frame: blocked by a slice", parts.frame);
  add(chain, "frame: nodes and preemption", StageKind::bound, parts.frame.bound_ns);
  add(chain, "frame: interrupts, hand-over, writes", StageKind::estimate, parts.frame.system_ns);
  add(chain, "sampling", StageKind::bound, parts.tick_gap_ns);
  add(chain, "tick: wake-up", StageKind::estimate, parts.tick.wake_up_ns);
  add_blocking(chain, "tick: blocked by a slice", parts.tick);
  add(chain, "tick: nodes and preemption", StageKind::bound, parts.tick.bound_ns);
  add(chain, "tick: interrupts", StageKind::estimate, parts.tick.system_ns);
  add(chain, "CAN write", StageKind::estimate, writes_ns);
}

void finish(Chain& chain, const ChainParts& parts, std::int64_t total_min_ns) {
  chain.maximum_reaction_time_ns = chain.total_ns + parts.frame_gap_ns;
  chain.maximum_data_age_ns = chain.total_ns - parts.tick_gap_ns + parts.frame_gap_ns;
  chain.jitter_ns = chain.total_ns - total_min_ns;
}

}  // namespace

const char* name_of(StageKind kind) {
  switch (kind) {
    case StageKind::bound:
      return "bound";
    case StageKind::estimate:
      return "estimate";
    case StageKind::declared:
      break;
  }
  return "declared";
}

std::vector<Chain> chains_of(const ChainParts& parts) {
  Chain to_can;
  to_can.name = "frame_to_can";
  to_can.deadline_ns = parts.frame_to_can_deadline_ns;
  add_groups(to_can, parts, parts.first_write_ns);
  finish(to_can, parts, 0);
  if (!parts.bus_ns) return {to_can};

  Chain to_bus;
  to_bus.name = "mid_exposure_to_bus";
  to_bus.deadline_ns = parts.age_deadline_ns;
  add(to_bus, "half the exposure", StageKind::declared, parts.sensor.exposure_ns / 2);
  add(to_bus, "readout and transport", StageKind::declared, parts.sensor.transport_ns);
  add(to_bus, "transport jitter", StageKind::declared, parts.arrival_jitter_ns);
  add_groups(to_bus, parts, parts.tick.writes_ns);
  add(to_bus, "CAN: queue and bus", StageKind::bound, *parts.bus_ns);
  finish(to_bus, parts,
         parts.sensor.exposure_ns / 2 + parts.sensor.transport_ns + parts.bus_min_ns);
  return {to_can, to_bus};
}

}  // namespace glint

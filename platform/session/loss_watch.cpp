#include "platform/session/loss_watch.hpp"

#include "kernels/wire/node_frames.hpp"

namespace glint {

CanFrame loss_frame(unsigned node, LossKind kind) noexcept {
  constexpr std::uint8_t k_losses = 0x80;  // of the device's own error codes
  const auto number = static_cast<std::uint8_t>(kind);
  CanFrame frame = overrun_frame(node, {number, 0, Reason::none, 0});
  frame.data[0] = static_cast<std::uint8_t>(k_losses + number);
  return frame;
}

void LossWatch::count() noexcept {
  if (sources_.counters == nullptr) return;
  LossCounters& counters = *sources_.counters;
  if (sources_.can != nullptr) counters.store(LossKind::can, sources_.can->counts().lost());
  if (sources_.dds != nullptr) counters.store(LossKind::dds, sources_.dds->counts().lost());
  if (sources_.recorder != nullptr) {
    counters.store(LossKind::recording, sources_.recorder->lost());
  }
  if (sources_.files != nullptr) counters.store(LossKind::files, sources_.files->lost());
}

std::optional<LossKind> LossWatch::take_due(Time tick) noexcept {
  if (sources_.counters == nullptr) return {};
  for (const LossKind kind : {LossKind::dds, LossKind::recording, LossKind::files}) {
    Reported& reported = reported_[static_cast<std::size_t>(kind)];
    const std::uint64_t lost = sources_.counters->of(kind);
    if (lost <= reported.lost || tick < reported.next) continue;
    reported = {lost, tick + k_emergency_gap};
    return kind;
  }
  return {};
}

}  // namespace glint

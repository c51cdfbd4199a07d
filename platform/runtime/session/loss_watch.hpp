// Counts the run's output losses at each tick and selects the kind that a CAN emergency frame
// reports: at most one a second per kind, none for CAN losses.
#pragma once

#include <array>
#include <optional>

#include "kernels/units.hpp"
#include "kernels/wire/node_frames.hpp"
#include "platform/runtime/rt/loss_counters.hpp"
#include "platform/runtime/session/file_sink.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "platform/sinks/dds/pose_output.hpp"
#include "platform/sinks/record/recorder.hpp"

namespace glint {

// Each may be null. `counters` must outlive the watch.
struct LossSources {
  const CanSink* can = nullptr;
  const PoseOutput* dds = nullptr;
  const Recorder* recorder = nullptr;
  const FileSink* files = nullptr;
  LossCounters* counters = nullptr;
};

class LossMonitor {
 public:
  static constexpr Duration k_emergency_gap = milliseconds(1000);

  explicit LossMonitor(const LossSources& sources) : sources_(sources) {}

  // Copies the sinks' counts into the counters. No lock, no heap.
  void count() noexcept {
    if (sources_.counters == nullptr) return;
    LossCounters& counters = *sources_.counters;
    if (sources_.can != nullptr) counters.store(LossKind::can, sources_.can->counts().lost());
    if (sources_.dds != nullptr) counters.store(LossKind::dds, sources_.dds->lost());
    if (sources_.recorder != nullptr) {
      counters.store(LossKind::recording, sources_.recorder->lost());
    }
    if (sources_.files != nullptr) counters.store(LossKind::files, sources_.files->lost());
  }
  // Returns a kind that lost more than its last emergency frame reported, and marks the loss as
  // reported.
  [[nodiscard]] std::optional<LossKind> next_due_report(Time tick) noexcept {
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

 private:
  struct Reported {
    std::uint64_t lost = 0;
    Time next;  // earliest time of the next emergency frame
  };

  LossSources sources_;
  std::array<Reported, k_loss_kinds> reported_{};
};

}  // namespace glint

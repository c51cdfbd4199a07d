// Counts at each tick what the run has lost so far, and decides which kind of loss a CAN emergency
// frame reports: at most one a second and kind, none for CAN's own.
#pragma once

#include <array>
#include <optional>

#include "kernels/units.hpp"
#include "platform/can/can_sink.hpp"
#include "platform/dds/dds_sink.hpp"
#include "platform/record/recorder.hpp"
#include "platform/rt/loss_counters.hpp"
#include "platform/session/file_sink.hpp"

namespace glint {

// Each may be null; `counters` outlives the watch.
struct LossSources {
  const CanSink* can = nullptr;
  const DdsSink* dds = nullptr;
  const Recorder* recorder = nullptr;
  const FileSink* files = nullptr;
  LossCounters* counters = nullptr;
};

// CANopen emergency: identifier 0x80 + node, error code FF80 + kind, error register 81, the kind in
// the place of the tool, the rest 0.
[[nodiscard]] CanFrame loss_frame(unsigned node, LossKind kind) noexcept;

class LossWatch {
 public:
  static constexpr Duration k_emergency_gap = milliseconds(1000);

  explicit LossWatch(const LossSources& sources) : sources_(sources) {}

  // Reads the sinks' counts into the counters. No lock, no heap.
  void count() noexcept;
  // The kind of which more was lost than its last emergency frame reported; from then on that is
  // reported.
  [[nodiscard]] std::optional<LossKind> take_due(Time tick) noexcept;

 private:
  struct Reported {
    std::uint64_t lost = 0;
    Time next;  // emergency frame at the earliest
  };

  LossSources sources_;
  std::array<Reported, k_loss_kinds> reported_{};
};

}  // namespace glint

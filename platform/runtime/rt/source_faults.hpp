// Faults of a live source as they happen: counts, and the first events of each kind.
//
// One thread notes the silence (the tick thread), another all other kinds (the reading thread); any
// thread reads the counts. No lock, no heap.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "kernels/units.hpp"

namespace glint {

enum class SourceFault : std::uint8_t {
  no_frame = 0,         // the newest frame arrived more than 1.5 nominal gaps ago
  connection_lost = 1,  // or a producer left
  packet_refused = 2,   // a message or packet of another size or type, or without a frame
  stamp_refused = 3,    // doubled, backward, or of another clock
  frame_dropped = 4,    // the tracker's slots were full
  head_pose_missing = 5,
};
inline constexpr std::size_t k_source_faults = 6;

[[nodiscard]] constexpr std::string_view name_of(SourceFault fault) {
  constexpr std::array<std::string_view, k_source_faults> names{"no frame",       "connection lost",
                                                                "packet refused", "stamp refused",
                                                                "frame dropped",  "no head pose"};
  return names[static_cast<std::size_t>(fault)];
}

class SourceFaults {
 public:
  static constexpr std::size_t k_events_max = 16;  // of each kind; later ones are counted only

  struct Event {
    Time time;                 // session time
    std::uint64_t frames = 0;  // published before it
  };

  explicit SourceFaults(Duration nominal_gap) : silence_max_{nominal_gap.nanoseconds * 3 / 2} {}

  void note(SourceFault fault, Time time) noexcept {
    const auto kind = static_cast<std::size_t>(fault);
    const std::uint64_t number = counts_[kind];
    if (number < k_events_max) events_[kind][number] = {time, frames_};
    ++counts_[kind];
    newest_ = fault;
  }
  void note_frame(Time arrival) noexcept {
    newest_arrival_ = arrival.nanoseconds;
    ++frames_;
  }
  // The source delivers no more: its silence is no fault.
  void end() noexcept { ended_ = true; }
  // Notes one silence if the newest frame is too old. Call at each tick.
  void check_silence(Time tick) noexcept {
    const bool silent = frames_ > 0 && !ended_ && tick - Time{newest_arrival_} > silence_max_;
    if (silent && !silent_) note(SourceFault::no_frame, tick);
    silent_ = silent;
  }

  [[nodiscard]] std::uint64_t of(SourceFault fault) const noexcept {
    return counts_[static_cast<std::size_t>(fault)];
  }
  [[nodiscard]] std::uint64_t total() const noexcept {
    std::uint64_t sum = 0;
    for (const auto& count : counts_) sum += count;
    return sum;
  }
  [[nodiscard]] bool silent() const noexcept { return silent_; }
  // Of all kinds; valid if total() is above 0.
  [[nodiscard]] SourceFault newest() const noexcept { return newest_; }
  // Call after the noting threads have ended.
  [[nodiscard]] std::span<const Event> events(SourceFault fault) const noexcept {
    const std::uint64_t number = of(fault);
    return std::span(events_[static_cast<std::size_t>(fault)])
        .first(number < k_events_max ? static_cast<std::size_t>(number) : k_events_max);
  }

 private:
  Duration silence_max_;
  std::array<std::atomic<std::uint64_t>, k_source_faults> counts_{};
  std::array<std::array<Event, k_events_max>, k_source_faults> events_{};
  std::atomic<std::int64_t> newest_arrival_{0};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<bool> silent_{false}, ended_{false};
  std::atomic<SourceFault> newest_{SourceFault::no_frame};
};

}  // namespace glint

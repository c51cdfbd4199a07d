// Frame source from a loop in memory. A thread of its own releases each frame at its absolute time
// and wakes the waiting thread, like a driver's interrupt. No polling.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/latency.hpp"

namespace glint {

struct ArrivalSettings {
  std::int64_t frames = 0;  // total number; 0: until `stop`
  Duration period;
  Duration first;  // session time of the first arrival
  int priority = 0;
  int core = -1;
  const std::atomic<bool>* stop = nullptr;  // set: no further frame arrives
};

class LoopSource final : public FrameSource {
 public:
  LoopSource(const FrameLoop& loop, const ArrivalSettings& settings);
  ~LoopSource() override;  // returns at the next arrival

  void start(const SourceClock& clock) override;  // starts the arrivals
  [[nodiscard]] std::size_t frame_count() const noexcept override {
    return static_cast<std::size_t>(settings_.frames);
  }
  [[nodiscard]] Duration duration() const noexcept override {
    return settings_.period * settings_.frames;
  }

  // Queued frames are not lost: the next call returns them, and their latency counts from their own
  // arrival.
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void release_pixels(const ArrivedFrame& arrived) noexcept override;

  // Time from a frame's nominal arrival to the first instruction of the waiting thread; only for
  // frames that arrived during wait().
  [[nodiscard]] const std::vector<std::int64_t>& wake_ups_ns() const {
    return wake_ups_ns_.entries();
  }
  [[nodiscard]] std::int64_t worst_frames_delivered() const { return worst_frames_delivered_; }
  // Report of the arrival thread, in a live run.
  [[nodiscard]] const ThreadReport& thread_report() const { return arrivals_->report(); }

 private:
  void arrive();
  [[nodiscard]] bool ends() const noexcept {
    return stop_ || (settings_.stop != nullptr && *settings_.stop);
  }

  const FrameLoop& loop_;
  ArrivalSettings settings_;
  SourceClock clock_;
  Release arrived_;
  std::atomic<std::int64_t> arrived_count_{0};
  std::atomic<bool> stop_{false};
  std::int64_t delivered_ = 0;
  std::int64_t worst_frames_delivered_ = 0;
  WakeUpLog wake_ups_ns_;
  std::unique_ptr<RealTimeThread> arrivals_;
};

}  // namespace glint

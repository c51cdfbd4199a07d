// A loop of frames as a camera: a thread of its own lets each frame arrive at its absolute time and
// wakes whoever waits for it, as a driver's interrupt would. Nobody polls.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "platform/boards/frame_loop.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/rt/release.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/session/latency.hpp"

namespace glint {

struct ArrivalSettings {
  std::int64_t frames = 0;  // how many arrive in all; 0: until `stop`
  Duration period;
  Duration first;  // of the first one's arrival, of the session's time
  int priority = 0;
  int core = -1;
  const std::atomic<bool>* stop = nullptr;  // set: no further frame arrives
};

class LoopSource final : public FrameSource {
 public:
  LoopSource(const FrameLoop& loop, const ArrivalSettings& settings);
  ~LoopSource() override;  // at the next arrival

  void start(const SourceClock& clock) override;  // frames begin to arrive
  [[nodiscard]] std::size_t frame_count() const noexcept override {
    return static_cast<std::size_t>(settings_.frames);
  }
  [[nodiscard]] Duration duration() const noexcept override {
    return settings_.period * settings_.frames;
  }

  // A frame that waits in memory while an older one is worked on is not lost: it comes next, and
  // its latency counts from its own arrival.
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void give_back(const ArrivedFrame& arrived) noexcept override;

  // From a frame's nominal arrival to the first instruction of who waited for it; only for frames
  // that found their group waiting.
  [[nodiscard]] const std::vector<std::int64_t>& wake_ups_ns() const {
    return wake_ups_ns_.entries();
  }
  [[nodiscard]] std::int64_t worst_shown() const { return worst_shown_; }
  // Of the thread that lets frames arrive, in a live run.
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
  std::int64_t worst_shown_ = 0;
  WakeUpLog wake_ups_ns_;
  std::unique_ptr<RealTimeThread> arrivals_;
};

}  // namespace glint

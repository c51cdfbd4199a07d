// Simulated frames that arrive when a camera's would. A thread of its own renders ahead into a ring
// of slots, so that a frame's pixels are in memory before the moment they are due.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "graph/ring.hpp"
#include "platform/rt/release.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

// Waits until a Time of the session's clock.
using SleepUntil = std::function<void(Time)>;

class SimulatedSource final : public FrameSource {
 public:
  static constexpr int k_slots = 24;  // half a second at 45 Hz, 1 MB each for AHAT

  // `sleep_until` empty: frames arrive as fast as they are asked for, stamped with their simulated
  // arrival. `now` gives the session's clock.
  SimulatedSource(const sim::Simulator& simulator, SleepUntil sleep_until,
                  std::function<Time()> now);
  ~SimulatedSource() override;
  SimulatedSource(const SimulatedSource&) = delete;
  SimulatedSource& operator=(const SimulatedSource&) = delete;

  // Blocks until half of the slots are rendered, so that the first frames are not late.
  void fill();
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void give_back(const ArrivedFrame& arrived) noexcept override;

  // One for each frame delivered so far, in the order of delivery; complete once wait() said false.
  [[nodiscard]] const std::vector<sim::SimTruth>& truths() const { return truths_; }
  // Frames that were not rendered by the time they were due: the machine was too slow.
  [[nodiscard]] int late_renders() const { return late_renders_; }

 private:
  void render_all();

  const sim::Simulator& simulator_;
  SleepUntil sleep_until_;
  std::function<Time()> now_;
  std::vector<std::unique_ptr<sim::SimFrame>> slots_;
  graph::Ring<int, 32> rendered_, free_;
  std::vector<sim::SimTruth> truths_;
  int delivered_ = 0;
  int late_renders_ = 0;
  std::atomic<int> rendered_count_{0};
  Release is_rendered_;  // once for each frame
  std::atomic<bool> stop_{false};
  std::thread renderer_;
};

}  // namespace glint

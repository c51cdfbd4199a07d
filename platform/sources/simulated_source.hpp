// Simulated frames that arrive when a camera's would. Threads of its own render ahead into a ring
// of slots, so that a frame's pixels are in memory before the moment they are due.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "platform/rt/release.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

struct SimulatedSourceSettings {
  bool live = false;    // render as far ahead as fill() finds necessary
  Duration frame_time;  // the source needs so long for each frame from when it is due: a slow one
};

class SimulatedSource final : public FrameSource {
 public:
  // Starts to render.
  explicit SimulatedSource(const sim::Simulator& simulator, SimulatedSourceSettings settings = {});
  ~SimulatedSource() override;
  SimulatedSource(const SimulatedSource&) = delete;
  SimulatedSource& operator=(const SimulatedSource&) = delete;

  // Blocks until so many frames wait that the rest will be rendered in time even if the machine
  // becomes half as fast; a short run is rendered whole. At most k_fill_limit, and as far as memory
  // goes.
  void prepare(const std::function<bool(int, int)>& go_on) override;
  // In order, frames are stamped with their simulated arrival.
  void start(const SourceClock& clock) override { clock_ = clock; }

  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void give_back(const ArrivedFrame& arrived) noexcept override;
  [[nodiscard]] bool late(Time now) const noexcept override {
    return now.nanoseconds >= late_since_ns_.load(std::memory_order_relaxed);
  }

  // Frames that were not rendered by the time they were due: the machine was too slow.
  [[nodiscard]] int late_frames() const noexcept override { return late_frames_; }
  [[nodiscard]] std::size_t frame_count() const noexcept override { return truths_.size(); }
  [[nodiscard]] Duration duration() const noexcept override {
    return simulator_.scenario().duration;
  }
  [[nodiscard]] double delivered_part() const noexcept override;
  [[nodiscard]] const std::vector<FrameTruth>& truths() const noexcept override { return truths_; }
  [[nodiscard]] std::optional<Pose> truth_of_tool(int tool, Time time) const override {
    return simulator_.truth_tool(tool, time);
  }

 private:
  // Until its frame was given back a slot belongs to the frame group.
  struct Slot {
    FrameBuffer pixels;
    Time mid_exposure;
    std::uint32_t sequence = 0;
    HeadPose head;
    bool rendered = false;  // by `order_`
  };

  void render_all();
  void put(int number, sim::SimFrame& frame);
  void sleep_until(Time time) const;
  [[nodiscard]] int frames_wanted(double frames_a_second) const;
  [[nodiscard]] Slot& slot_of(int number) {
    return slots_[static_cast<std::size_t>(number) % slots_.size()];
  }

  const sim::Simulator& simulator_;
  SimulatedSourceSettings settings_;
  SourceClock clock_;
  std::vector<Slot> slots_;
  std::vector<FrameTruth> truths_;
  std::mutex order_;  // of the renderers alone
  std::atomic<int> next_{0}, rendered_count_{0}, delivered_{0}, given_back_{0};
  std::atomic<int> ahead_max_;                          // frames rendered and not given back
  std::atomic<std::int64_t> late_since_ns_{INT64_MAX};  // when the first of the late ones was due
  std::atomic<bool> stop_{false};
  std::atomic<int> late_frames_{0};
  Time ready_;           // when a slow source was done with the last frame
  Release is_rendered_;  // once for each frame, in their order
  std::vector<std::thread> renderers_;
};

}  // namespace glint

// Source of simulated frames with the arrival times of a camera. Its own threads render ahead into
// a ring of slots, so that a frame's pixels are in memory before it is due.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

struct SimulatedSourceSettings {
  bool live = false;    // render ahead as far as prepare() requires
  Duration frame_time;  // emulates a slow source: time per frame from its due time
};

class SimulatedSource final : public FrameSource {
 public:
  // Starts rendering.
  explicit SimulatedSource(const sim::Simulator& simulator, SimulatedSourceSettings settings = {});
  ~SimulatedSource() override;
  SimulatedSource(const SimulatedSource&) = delete;
  SimulatedSource& operator=(const SimulatedSource&) = delete;

  // Blocks until the rendered frames suffice for the rest to be rendered in time at half of the
  // present speed; a short run is rendered completely. Limits: k_fill_limit and the available
  // memory.
  void prepare(const std::function<bool(int, int)>& go_on) override;
  // Without a live clock, frames are stamped with their simulated arrival.
  void start(const SourceClock& clock) override { clock_ = clock; }

  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void release_pixels(const ArrivedFrame& arrived) noexcept override;
  [[nodiscard]] bool late(Time now) const noexcept override {
    return now.nanoseconds >= late_since_ns_.load(std::memory_order_relaxed);
  }

  // Number of frames rendered after their due time: the machine was too slow.
  [[nodiscard]] int late_frames() const noexcept override { return late_frames_; }
  [[nodiscard]] std::size_t frame_count() const noexcept override { return truths_.size(); }
  [[nodiscard]] Duration duration() const noexcept override {
    return simulator_.scenario().duration;
  }
  [[nodiscard]] double delivered_part() const noexcept override;
  [[nodiscard]] const std::vector<FrameGroundTruth>& ground_truths() const noexcept override {
    return truths_;
  }
  [[nodiscard]] std::optional<Pose> ground_truth_of_tool(int tool, Time time) const override {
    return simulator_.truth_tool(tool, time);
  }

 private:
  // A slot belongs to the frame group until its frame is given back.
  struct Slot {
    FrameBuffer pixels;
    Time mid_exposure;
    std::uint32_t sequence = 0;
    HeadPose head;
    bool rendered = false;  // protected by `order_`
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
  std::vector<FrameGroundTruth> truths_;
  std::mutex order_;  // shared by the renderers only
  std::atomic<int> next_{0}, rendered_count_{0}, delivered_{0}, released_{0};
  std::atomic<int> ahead_max_;                          // frames rendered and not given back
  std::atomic<std::int64_t> late_since_ns_{INT64_MAX};  // due time of the first late frame
  std::atomic<bool> stop_{false};
  std::atomic<int> late_frames_{0};
  Time ready_;           // end of a slow source's last frame
  Release is_rendered_;  // once per frame, in order
  std::vector<std::thread> renderers_;
};

}  // namespace glint

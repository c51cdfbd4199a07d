// Runs both rate groups with changing input, one cycle at a time: a frame, its estimates passed on,
// and the ticks until the next frame. The rest of a session (sinks, recorder) is not included.
#pragma once

#include <memory>
#include <utility>

#include "graph/rate_group.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "tests/footprint/frames.hpp"

namespace glint::footprint {

inline constexpr std::uint32_t k_cycles = 10'000;
// Each frame is shown at least once, so that every page and path is warm.
inline constexpr std::uint32_t k_warm_up_cycles = 4 * 128;

// TickGraph: Output, or a graph with the same inputs and one additional node.
template <class TickGraph = Output>
class Groups {
 public:
  Groups() {
    const Cell& cell = test_frames().cell;
    configure(cell, *tracker_);
    tracker_->template latest<ToolSet>().bind(tools_);
    Output configured;
    configure(cell, configured);
    tick_->template node<PredictTools>().settings = configured.node<PredictTools>().settings;
    tick_->template node<PackCan>().settings = configured.node<PackCan>().settings;
    tick_->template latest<Estimates>().bind(estimates_);
    tick_->template latest<RobotFrame>().bind(robot_);
    tick_->template latest<PenButtons>().bind(buttons_);
    publish_tools(0);
    robot_.write_slot() = declared_robot_frame(cell);
    robot_.publish(1, 0);
  }

  // Runs one cycle; calls `run` with each graph after setting its inputs.
  template <class Run>
  void cycle(std::uint32_t number, Run&& run) noexcept {
    if (number % 500 == 499) publish_tools(number);
    const PlayedFrame& shown = frame_of_cycle(number);
    // Some time stamps repeat or go backwards, to take every path through CheckFrame.
    const std::int64_t step = number % 97 == 96 ? number - 3 : number;
    const Time exposed{(step + 1) * k_period_ns};
    tracker_->template input<Frame>() = shown.pixels.view(exposed, exposed, number);
    tracker_->template input<HeadPose>() = shown.head;
    tracker_->template input<HeadPose>().time = exposed;
    (void)frame_group_.release(exposed.nanoseconds);
    run(*tracker_);
    estimates_.write_slot() = tracker_->template output<Estimates>();
    estimates_.publish(number + 1, exposed.nanoseconds);
    buttons_.write_slot().held = static_cast<std::uint8_t>(number & k_buttons_mask);
    buttons_.publish(number + 1, exposed.nanoseconds);
    for (int tick = 0; tick < k_ticks_a_frame; ++tick) {
      const Time nominal{exposed.nanoseconds + tick * k_period_ns / k_ticks_a_frame};
      tick_->template input<Now>() = {nominal, ++ticks_, 0};
      (void)tick_group_.release(nominal.nanoseconds);
      run(*tick_);
    }
  }

  [[nodiscard]] Tracker& tracker() noexcept { return *tracker_; }
  [[nodiscard]] TickGraph& tick() noexcept { return *tick_; }
  // Number of poses of the tick group that are marked measured: shows that the cycles processed
  // tools.
  [[nodiscard]] int measured_now() const noexcept {
    int count = 0;
    const PoseSamples& samples = std::as_const(*tick_).template output<PoseSamples>();
    for (int t = 0; t < samples.count; ++t) {
      count += samples.items[static_cast<std::size_t>(t)].state == TrackState::measured ? 1 : 0;
    }
    return count;
  }

 private:
  static constexpr std::int64_t k_period_ns = 22'222'222;
  static constexpr int k_ticks_a_frame = 5;

  // Publishes all tools, or one fewer.
  void publish_tools(std::uint32_t number) noexcept {
    tools_.write_slot() = test_frames().cell.tools;
    tools_.write_slot().count -= static_cast<int>(number / 500 % 2);
    tools_.publish(number + 1, 0);
  }

  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  std::unique_ptr<TickGraph> tick_ = std::make_unique<TickGraph>();
  graph::RateGroup<Tracker> frame_group_{*tracker_, 0};
  graph::RateGroup<TickGraph> tick_group_{*tick_, 1};
  graph::TripleBuffer<ToolSet> tools_;
  graph::TripleBuffer<Estimates> estimates_;
  graph::TripleBuffer<RobotFrame> robot_;
  graph::TripleBuffer<PenButtons> buttons_;
  std::uint32_t ticks_ = 0;
};

}  // namespace glint::footprint

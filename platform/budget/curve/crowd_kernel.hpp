// The complete frame group as one measured call, on simulated frames of many tools and stray
// reflections.
//
// run() is one activation of the graph with all its nodes. The frames are one camera period apart,
// so that the tools are tracked and the ROIs are active, as in a run.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "nodes/tracker.hpp"
#include "platform/budget/curve/crowd_point.hpp"
#include "platform/budget/measured_kernel.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class DenseSceneKernel final : public MeasuredKernel {
 public:
  explicit DenseSceneKernel(DenseScenePoint point) : point_(point), name_(point.name()) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::span<const std::string_view> loops() const override { return k_loops; }
  [[nodiscard]] graph::LoopCounts worst(const Limits& /*limits*/) const override { return {{1}}; }
  // Ignores the kind. Frame `number` of the sequence, forward, then backward.
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override;
  // New delivery of the same frame: a repeated one would be rejected.
  void rewind() override;
  void run() noexcept override { tracker_->activate(); }
  [[nodiscard]] graph::LoopCounts counts() const override { return {{1}}; }

  // Sets frame `number` as the next delivery, for any caller that activates tracker().
  void set_frame(std::uint64_t number) {
    set_input(InputKind::typical, number, {});
    rewind();
  }
  [[nodiscard]] Tracker& tracker() { return *tracker_; }  // after the first input
  // In the last run.
  [[nodiscard]] int tools_seen() const;

 private:
  static constexpr std::array<std::string_view, 1> k_loops = {"call"};
  static constexpr std::size_t k_frames = 16;

  void prepare();

  DenseScenePoint point_;
  std::string name_;
  std::unique_ptr<Tracker> tracker_;
  graph::TripleBuffer<ToolSet> tool_set_;
  std::array<std::unique_ptr<sim::SimFrame>, k_frames> frames_;
  const sim::SimFrame* frame_ = nullptr;
  Duration period_;
  std::uint64_t sequence_ = 0;
};

}  // namespace glint

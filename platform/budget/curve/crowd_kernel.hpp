// The whole frame group as one measured call, on simulated frames of a crowd.
//
// run() is one activation: graph, every node, nothing else. Its frames come one camera period after
// the other, so that the tools are tracked and the ROIs are on, as in a run.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "nodes/tracker.hpp"
#include "platform/budget/curve/crowd_point.hpp"
#include "platform/budget/measured_kernel.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class CrowdKernel final : public MeasuredKernel {
 public:
  explicit CrowdKernel(CrowdPoint point) : point_(point), name_(point.name()) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::span<const std::string_view> loops() const override { return k_loops; }
  [[nodiscard]] graph::LoopCounts worst(const Limits& /*limits*/) const override { return {{1}}; }
  // The kind does not matter: frame `number` of the crowd, shown to and fro.
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override;
  // The next delivery of the same picture: one that came twice would be refused.
  void rewind() override;
  void run() noexcept override { tracker_->activate(); }
  [[nodiscard]] graph::LoopCounts counts() const override { return {{1}}; }

  // Frame `number`, as the next delivery: whatever activates tracker() next sees it.
  void show(std::uint64_t number) {
    set_input(InputKind::typical, number, {});
    rewind();
  }
  [[nodiscard]] Tracker& tracker() { return *tracker_; }  // after the first input
  // Of the last run.
  [[nodiscard]] int tools_seen() const;

 private:
  static constexpr std::array<std::string_view, 1> k_loops = {"call"};
  static constexpr std::size_t k_frames = 16;

  void prepare();

  CrowdPoint point_;
  std::string name_;
  std::unique_ptr<Tracker> tracker_;
  graph::TripleBuffer<ToolSet> tool_set_;
  std::array<std::unique_ptr<sim::SimFrame>, k_frames> frames_;
  const sim::SimFrame* shown_ = nullptr;
  Duration period_;
  std::uint64_t sequence_ = 0;
};

}  // namespace glint

// Measurement inputs of Correspond: scenes of many tools, and adversarial marker arrangements.
#include <algorithm>

#include "nodes/pose_nodes.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

// The partition with the most tools.
constexpr graph::Partition k_partition{0, k_tool_partitions};
constexpr int k_trials = 3000;  // until the worst input uses up every budget
constexpr int k_climbs = 5;     // of the search for a worse input

enum class Shape { crowd, line, swarm, copies };

// Of several random tools, the one with the most equal distances: more of them match any pair.
Tool equidistant_tool(Numbers& numbers, int markers) {
  Tool best;
  double ratio_min = 1e9;
  for (int trial = 0; trial < 12; ++trial) {
    const Tool tool = any_tool(numbers, markers);
    double longest = 0, shortest = 1e9;
    for (int i = 0; i < markers; ++i) {
      for (int j = 0; j < i; ++j) {
        longest = std::max(longest, tool.distance_m[i][j]);
        shortest = std::min(shortest, tool.distance_m[i][j]);
      }
    }
    if (longest / shortest >= ratio_min) continue;
    ratio_min = longest / shortest;
    best = tool;
  }
  return best;
}

class CorrespondKernel final : public NodeKernel<Correspond> {
 public:
  CorrespondKernel() : NodeKernel("Correspond") { start_.settings.focal_px = 253; }

  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    start_.limits = limits;
    Numbers numbers(kind, number);
    switch (kind) {
      case InputKind::typical:
        fill(Shape::crowd, numbers, numbers.one_in(2), limits);
        break;
      case InputKind::recorded:
        fill(Shape::crowd, numbers, true, limits);
        break;
      case InputKind::worst:
        set_worst(number, limits);
        break;
      case InputKind::searched:
        climb(number, limits);
        break;
    }
    rewind();
  }
  // Scratch keeps the last call's values; each call writes before it reads.
  void rewind() override {
    node_.limits = start_.limits;
    node_.settings = start_.settings;
  }
  void run() noexcept override {
    node_(verdict_, markers_, tools_, predictions_, k_partition, labelings_);
  }

 private:
  void fill(Shape shape, Numbers& numbers, bool predicted, const Limits& limits) {
    const bool crowd = shape == Shape::crowd;
    verdict_ = accepted_verdict(1);
    set_.count = crowd ? 1 + numbers.below(limits.tools) : limits.tools;
    markers_.count = 0;
    predictions_ = {};
    for (int t = 0; t < set_.count; ++t) {
      const int fewest = std::min(4, limits.markers_per_tool);
      const int markers = crowd ? fewest + numbers.below(limits.markers_per_tool - fewest + 1)
                                : limits.markers_per_tool;
      set_.items[t] =
          shape == Shape::line ? equidistant_tool(numbers, markers) : any_tool(numbers, markers);
      const Pose pose = any_view(numbers);
      if (crowd) add_tool(markers_, set_.items[t], pose, 0.0015, numbers, limits.blobs);
      if (shape == Shape::copies) add_copies(set_.items[t], pose, numbers, limits);
      predictions_.tools[t].has_prior = predicted;
      predictions_.tools[t].T_camera_tool = crowd ? displaced(pose, numbers) : pose;
      predictions_.tools[t].reach_m = 0.02;
    }
    if (crowd) {
      for (int s = numbers.below(40); s > 0; --s) {
        add_marker(markers_, Vector3(0, 0, 0.6) + numbers.in_box(0.7), set_.items[0], limits.blobs);
      }
    }
    if (shape == Shape::line) add_line(numbers, limits);
    if (shape == Shape::swarm) add_swarm(numbers, limits);
    tools_.set(set_, 1, 0);
  }

  // Blobs on a line: each pair has the distance of some pair of the tool's markers, but no three
  // blobs have the shape of three markers. The search finds partners everywhere and never reaches a
  // fit.
  void add_line(Numbers& numbers, const Limits& limits) {
    const Vector3 along = (numbers.rotation() * Vector3::UnitX()).normalized();
    const double gap = numbers.within(0.15, 0.5) / limits.blobs;
    for (int b = 0; b < limits.blobs; ++b) {
      const double place = gap * (b - 0.5 * limits.blobs);
      add_marker(markers_, Vector3(0, 0, 0.6) + along * place, set_.items[0], limits.blobs);
    }
  }

  void add_swarm(Numbers& numbers, const Limits& limits) {
    const double side = numbers.within(0.08, 0.4);
    while (markers_.count < limits.blobs) {
      add_marker(markers_, Vector3(0, 0, 0.6) + numbers.in_box(side), set_.items[0], limits.blobs);
    }
  }

  // Several blobs at each marker of the partition's first tool: every combination fits.
  void add_copies(const Tool& tool, const Pose& pose, Numbers& numbers, const Limits& limits) {
    if (markers_.count > 0) return;
    while (markers_.count < limits.blobs) {
      const Vector3 place = pose * tool.markers_m[markers_.count % tool.marker_count];
      add_marker(markers_, place + numbers.in_box(0.004), tool, limits.blobs);
    }
  }

  // Input 0 uses up every budget; the others are lines, swarms and copies in turn.
  void set_worst(std::uint64_t number, const Limits& limits) {
    constexpr Shape shapes[] = {Shape::line, Shape::swarm, Shape::copies};
    if (number > 0) {
      Numbers numbers(InputKind::worst, number);
      fill(shapes[number % 3], numbers, number % 2 == 0, limits);
      return;
    }
    for (std::uint64_t trial = 0; trial < k_trials; ++trial) {
      Numbers numbers(InputKind::worst, trial * 1'000'003);
      fill(Shape::line, numbers, true, limits);
      rewind();
      run();
      if (node_.counts() == Correspond::worst(limits)) return;
    }
  }

  // Keeps the most expensive of several candidate inputs.
  void climb(std::uint64_t number, const Limits& limits) {
    constexpr Shape shapes[] = {Shape::line, Shape::swarm, Shape::copies};
    std::uint64_t best_step = 0;
    std::int64_t effort_max = -1;
    const auto set = [&](std::uint64_t climb_step) {
      Numbers numbers(InputKind::searched, number * k_climbs + climb_step);
      fill(shapes[number % 3], numbers, numbers.one_in(2), limits);
    };
    for (std::uint64_t step = 0; step < k_climbs; ++step) {
      set(step);
      rewind();
      run();
      const graph::LoopCounts counts = node_.counts();
      const std::int64_t effort = counts[6];
      if (effort <= effort_max) continue;
      effort_max = effort;
      best_step = step;
    }
    set(best_step);
  }

  FrameVerdict verdict_;
  Markers markers_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  Predictions predictions_;
  ToolLabelings labelings_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> correspond_kernel() { return std::make_unique<CorrespondKernel>(); }

}  // namespace glint::inputs

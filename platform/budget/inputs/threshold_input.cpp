// Measurement inputs of RoiThreshold: one band of a frame, and the ROIs in it.
#include <algorithm>

#include "nodes/image_nodes.hpp"
#include "platform/budget/inputs/image_inputs.hpp"

namespace glint {
namespace {

// Runs at equal distances. Their number over all rows is the capacity of a band's buffer, so that
// none ends the search before the last block.
struct SpreadRuns {
  int per_band = 0;        // runs per band; 0: none, but the layout's pattern
  int length = 1;          // limited so that runs never touch
  bool scattered = false;  // at a random position in its part of the row
};

struct Layout {
  RunPattern pattern;
  SpreadRuns spread;
  int rois = 1;         // ROIs side by side
  bool narrow = false;  // all but one of them one pixel wide
};

class MeasuredRoiThreshold final : public MeasuredKernel {
 public:
  [[nodiscard]] std::string_view name() const override { return "RoiThreshold"; }
  [[nodiscard]] std::span<const std::string_view> loops() const override {
    return RoiThreshold::k_loops;
  }
  [[nodiscard]] graph::LoopCounts worst(const Limits& limits) const override {
    return RoiThreshold::worst(limits);
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    CounterRandom random(1, kind, number);
    node_->limits = limits;
    node_->threshold = drawn_threshold(limits);
    band_ = {static_cast<int>(number % k_row_bands), k_row_bands};
    drawn_.clear(limits);
    switch (kind) {
      case InputKind::typical:
        drawn_.scene(random);
        break;
      case InputKind::recorded:
        drawn_.recorded(random);
        break;
      case InputKind::worst:
        lay_out(worst_layout(number / k_row_bands, limits));
        break;
      case InputKind::searched:
        search(random, limits);
        break;
    }
    if (kind == InputKind::typical || kind == InputKind::recorded) random_rois(random, limits);
    frame_ = drawn_.view();
  }
  void run() noexcept override { (*node_)(frame_, rois_, band_, *runs_); }
  [[nodiscard]] graph::LoopCounts counts() const override { return node_->counts(); }

 private:
  // Variant 0: every row has the maximum number of stretches, each with the maximum number of
  // blocks, and all runs just fit. Each of the others drives one loop beyond the others.
  static Layout worst_layout(std::uint64_t variant, const Limits& limits) {
    Layout layout;
    layout.pattern.x1 = limits.width;
    layout.pattern.y1 = limits.height;
    layout.pattern.skip = 0;
    layout.rois = std::max(limits.tools, 1);
    layout.narrow = variant % 2 == 0;
    layout.spread.per_band = threshold_work_max(limits, k_row_bands).runs;
    switch (variant / 2 % 6) {
      case 1:
        layout.spread.scattered = true;
        break;
      case 2:
        layout.spread.length = limits.width;
        break;
      case 3:
        layout.spread.per_band = 0;  // a checkerboard, which fills the buffer early
        layout.pattern.shift = 1;
        break;
      case 4:
        layout.spread.per_band = 0;
        layout.pattern.run = limits.width;
        break;
      case 5:
        layout.spread.per_band /= 2;
        layout.spread.scattered = true;
        break;
      default:
        break;
    }
    if (variant / 12 % 2 == 1) layout.rois = 1;
    return layout;
  }

  void draw_spread(const SpreadRuns& spread) {
    const int width = drawn_.width(), height = drawn_.height();
    const int top = height * band_.index / band_.count;
    const int rows = height * (band_.index + 1) / band_.count - top;
    CounterRandom random(3, InputKind::worst, 0);
    for (int row = 0; row < rows; ++row) {
      const int n = spread.per_band * (row + 1) / rows - spread.per_band * row / rows;
      const int part = n > 0 ? width / 2 / n : 0;  // of a row's even columns, for each run
      for (int i = 0; i < n; ++i) {
        const int x = 2 * (i * part + (spread.scattered ? random.below(part) : 0));
        const int end = std::min(x + spread.length, 2 * (i + 1) * part - 1);
        drawn_.pattern({width, 0, 1, 0, 0, x, end, top + row, top + row + 1});
      }
    }
  }

  // Narrow: single-pixel ROIs at even columns, where the patterns have their runs, then one wide
  // ROI.
  void lay_out(const Layout& layout) {
    drawn_.clear(node_->limits);
    if (layout.spread.per_band > 0) {
      draw_spread(layout.spread);
    } else {
      drawn_.pattern(layout.pattern);
    }
    const int width = drawn_.width(), height = drawn_.height();
    rois_.count = std::clamp(layout.rois, 1, std::min(width, node_->limits.tools));
    for (int i = 0; i < rois_.count; ++i) {
      Roi& roi = rois_.items[static_cast<std::size_t>(i)];
      roi = {width * i / rois_.count, 0, width * (i + 1) / rois_.count, height};
      if (layout.narrow) {
        const bool last = i + 1 == rois_.count;
        roi.x0 = 2 * i;
        roi.x1 = last ? width : roi.x0 + 1;
      }
    }
  }

  void random_rois(CounterRandom& random, const Limits& limits) {
    rois_.items[0] = {0, 0, limits.width, limits.height};
    rois_.count = 1;
    if (random.below(2) == 0) return;
    rois_.count = random.between(1, std::max(limits.tools, 1));
    for (int i = 0; i < rois_.count; ++i) {
      const int x = random.below(limits.width), y = random.below(limits.height);
      rois_.items[static_cast<std::size_t>(i)] = {x, y, x + random.between(20, 120),
                                                  y + random.between(20, 120)};
    }
  }

  void search(CounterRandom& random, const Limits& limits) {
    const Layout first{random_pattern(random, limits),
                       {},
                       random.between(1, std::max(limits.tools, 1)),
                       random.below(2) == 0};
    const auto change = [&](Layout layout) {
      const RunPattern other = random_pattern(random, limits);
      switch (random.below(5)) {
        case 0:
          layout.pattern.run = other.run;
          break;
        case 1:
          layout.pattern.gap = other.gap;
          break;
        case 2:
          layout.pattern.skip = other.skip;
          break;
        case 3:
          layout.rois = random.between(1, std::max(limits.tools, 1));
          break;
        default:
          layout.narrow = !layout.narrow;
          break;
      }
      return layout;
    };
    lay_out(climb(first, change, [&](const Layout& layout) {
      lay_out(layout);
      frame_ = drawn_.view();
      run();
      const graph::LoopCounts n = counts();
      return 3 * n[1] + 2 * n[2] + 5 * n[3];
    }));
  }

  std::unique_ptr<RoiThreshold> node_ = std::make_unique<RoiThreshold>();
  std::unique_ptr<Runs> runs_ = std::make_unique<Runs>();
  DrawnFrame drawn_;
  Frame frame_;
  Rois rois_;
  graph::Partition band_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> measured_roi_threshold() {
  return std::make_unique<MeasuredRoiThreshold>();
}

}  // namespace glint

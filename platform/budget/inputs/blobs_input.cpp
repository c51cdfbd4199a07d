// Measurement inputs of FindBlobs: a frame with its runs, and the predicted markers.
#include <algorithm>
#include <array>

#include "kernels/image/grown_box.hpp"
#include "nodes/image_nodes.hpp"
#include "platform/budget/inputs/image_inputs.hpp"

namespace glint {
namespace {

constexpr int k_wide_px = k_grown_box_max;  // widest blob with a grown box
constexpr int k_wide_pitch_px = 64;
constexpr std::uint16_t k_marker_level = 60'000;  // on a surface of k_drawn_bright

class MeasuredFindBlobs final : public MeasuredKernel {
 public:
  [[nodiscard]] std::string_view name() const override { return "FindBlobs"; }
  [[nodiscard]] std::span<const std::string_view> loops() const override {
    return FindBlobs::k_loops;
  }
  [[nodiscard]] graph::LoopCounts worst(const Limits& limits) const override {
    return FindBlobs::worst(limits);
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    CounterRandom random(2, kind, number);
    limits_ = limits;
    node_->limits = limits;
    node_->settings = {1, 4096, drawn_threshold(limits), 0xFFFF};
    expect_markers(0.005);
    drawn_.clear(limits);
    predict_at_random(random);
    switch (kind) {
      case InputKind::typical:
        drawn_.scene(random);
        break;
      case InputKind::recorded:
        drawn_.recorded(random);
        break;
      case InputKind::worst:
        draw_worst(number, random);
        break;
      case InputKind::searched:
        search(random);
        break;
    }
    find_runs();
  }
  void run() noexcept override { (*node_)(frame_, *bands_, *predictions_, *blobs_); }
  [[nodiscard]] graph::LoopCounts counts() const override { return node_->counts(); }

 private:
  void expect_markers(double radius_m) {
    MarkerOptics optics;
    optics.focal_px = 250;
    optics.radius_min_m = optics.radius_max_m = radius_m;
    node_->settings.sizes = marker_sizes(optics);
  }

  void find_runs() {
    frame_ = drawn_.view();
    for (int band = 0; band < k_row_bands; ++band) {
      threshold_runs(frame_, whole_frame(frame_), drawn_threshold(limits_), {band, k_row_bands},
                     (*bands_)[band], limits_);
    }
  }

  // Includes a tool that is searched for everywhere: one more distance per four candidates.
  void predict_at_random(CounterRandom& random) {
    predictions_->search_whole_frame = true;
    predictions_->frame_number = static_cast<std::uint32_t>(random.below(1 << 20));
    predictions_->marker_count = limits_.tools * limits_.markers_per_tool;
    for (int i = 0; i < predictions_->marker_count; ++i) {
      const double x = random.uniform() * limits_.width;
      predictions_->markers_px[static_cast<std::size_t>(i)] = {x,
                                                               random.uniform() * limits_.height};
    }
  }

  // Draws single-pixel dots, as many as there are runs, all of them candidates, and blobs of the
  // maximum box width, as many as each band may keep. Predictions and focus (the first candidate of
  // turn 0) are between the wide blobs, and dots do not match so large a marker: only wide blobs
  // are kept.
  void draw_dots_and_bars(int gap) {
    const int per_row = std::max(limits_.width / k_wide_pitch_px, 1);
    const int wide_a_band = limits_.blobs;
    const int wide_rows = (wide_a_band + per_row - 1) / per_row;
    const int dots_a_row = (limits_.width + gap) / (1 + gap);
    const int dot_rows = (limits_.runs_per_band - wide_a_band + dots_a_row - 1) / dots_a_row;
    const int predicted = predictions_->marker_count;
    predictions_->frame_number = 0;
    expect_markers(0.011);
    for (int band = 0; band < k_row_bands; ++band) {
      const int top = limits_.height * band / k_row_bands + 2;
      const int bottom = limits_.height * (band + 1) / k_row_bands;
      drawn_.pattern({k_wide_px, k_wide_pitch_px - k_wide_px, 1, 1, 0, 0, limits_.width, top,
                      std::min(top + 2 * wide_rows, bottom)});
      // At the lower end of the band: far from its bars, and far from the next band's.
      const int first = std::max(top + 2 * wide_rows, bottom - 40 - 2 * dot_rows);
      drawn_.pattern({1, gap, 1, 1, 0, 0, limits_.width, first, bottom - 1});
      for (int i = predicted * band / k_row_bands; i < predicted * (band + 1) / k_row_bands; ++i) {
        predictions_->markers_px[static_cast<std::size_t>(i)] = {
            62.0 + 128 * (i % 4), top + static_cast<double>(wide_rows)};
      }
    }
  }

  void draw_worst(std::uint64_t variant, CounterRandom& random) {
    const int side = limits_.width;
    switch (variant % 13) {
      case 0:
        draw_dots_and_bars(1);
        break;
      case 1:
        drawn_.pattern({1, 1, 1, 0, 1, 0, side, 0, side});
        break;  // checkerboard
      case 2:
        drawn_.pattern({60, 4, 60, 4, 0, 0, side, 0, side});
        break;  // squares
      case 3:
        drawn_.pattern({1, 4, 60, 2, 0, 0, side, 0, side});
        break;  // vertical bars
      case 4:
        draw_dots_and_bars(2);
        break;
      case 5:
        drawn_.pattern({1, 1, 1, 1, 0, 0, side, 0, side});
        break;  // dots
      case 6:
        drawn_.pattern({12, 6, 12, 6, 0, 0, side, 0, side});
        break;
      case 7:
        draw_comb();
        break;
      case 8:
        draw_scattered(random, 1);
        break;
      case 9:
        draw_scattered(random, 8);
        break;
      case 10:
        draw_surface(random, 1, 1);
        break;
      case 11:
        draw_surface(random, 1, 8);
        break;
      default:
        draw_surface(random, std::max(runs_of_all_bands_max(limits_) / (2 * side), 1), 3);
        break;
    }
  }

  // Random short runs, nearly as many as the capacity; some touch.
  void draw_scattered(CounterRandom& random, int longest) {
    const int rows = limits_.height / k_row_bands;
    for (int band = 0; band < k_row_bands; ++band) {
      for (int i = 0; i < limits_.runs_per_band; ++i) {
        const int x = random.below(limits_.width), y = band * rows + random.below(rows);
        const int end = x + random.between(1, longest);
        drawn_.pattern({limits_.width, 0, 1, 0, 0, x, end, y, y + 1});
      }
    }
  }

  // A surface that fills the frame, in so many runs a row, and on it random short runs of markers,
  // as many as the capacity leaves: one rescan of the complete frame.
  void draw_surface(CounterRandom& random, int runs_per_row, int longest) {
    const int pitch = limits_.width / runs_per_row, gap = runs_per_row > 1 ? 1 : 0;
    drawn_.pattern({pitch - gap, gap, 1, 0, gap, 0, limits_.width, 0, limits_.height});
    for (int i = runs_of_all_bands_max(limits_) - runs_per_row * limits_.height; i > 0; --i) {
      const int x = random.below(limits_.width), y = random.below(limits_.height);
      const int end = x + random.between(1, longest);
      drawn_.pattern({limits_.width, 0, 1, 0, 0, x, end, y, y + 1, k_marker_level});
    }
  }

  // Comb: vertical teeth, four pixels apart, on a horizontal bar: a component of many runs.
  void draw_comb() {
    for (int y = 0; y + 60 < limits_.height; y += 64) {
      drawn_.pattern({60, 4, 1, 0, 0, 0, limits_.width, y, y + 1});
      drawn_.pattern({1, 3, 59, 0, 0, 0, limits_.width, y + 1, y + 60});
    }
  }

  // Two patterns, one above the other.
  struct Halves {
    RunPattern upper, lower;
    int border = 0;
  };
  void draw(const Halves& halves) {
    drawn_.clear(limits_);
    RunPattern upper = halves.upper, lower = halves.lower;
    upper.y1 = lower.y0 = halves.border;
    drawn_.pattern(upper);
    drawn_.pattern(lower);
    find_runs();
  }
  void search(CounterRandom& random) {
    const auto any = [&] { return random_pattern(random, limits_); };
    const Halves first{any(), any(), random.below(limits_.height)};
    const auto change = [&](Halves halves) {
      const int which = random.below(3);
      if (which == 0) halves.upper = any();
      if (which == 1) halves.lower = any();
      if (which == 2) halves.border = random.below(limits_.height);
      return halves;
    };
    draw(climb(first, change, [&](const Halves& halves) {
      draw(halves);
      run();
      const graph::LoopCounts n = counts();
      return 60 * n[1] + 7 * n[2] + 600 * n[3] + 6 * n[4] + 40 * n[5];
    }));
  }

  Limits limits_;
  std::unique_ptr<FindBlobs> node_ = std::make_unique<FindBlobs>();
  std::unique_ptr<graph::Parts<Runs, k_row_bands>> bands_ =
      std::make_unique<graph::Parts<Runs, k_row_bands>>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  std::unique_ptr<Blobs> blobs_ = std::make_unique<Blobs>();
  DrawnFrame drawn_;
  Frame frame_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> measured_find_blobs() {
  return std::make_unique<MeasuredFindBlobs>();
}

}  // namespace glint

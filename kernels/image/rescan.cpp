#include "kernels/image/rescan.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>

#include "kernels/image/bright_mask.hpp"
#include "kernels/image/components.hpp"

namespace glint {
namespace {

// Level over the mean of the surface, and a marker's least reflectivity over the level, both in
// halves. Skin varies by 10 %, so that its noise stays below the level.
constexpr std::uint64_t k_level_halves = 3;
constexpr int k_contrast_halves = 3;
// Least distance of the level from the mean, in mean absolute deviations of the surface: the bright
// half of a texture is one above the mean.
constexpr std::uint64_t k_level_deviations = 3;

template <class Pixel>
class Rescanner {
 public:
  Rescanner(const ImageView<Pixel>& image, int runs_max, int blocks_max, BlobScratch& scratch)
      : image_(image), runs_max_(runs_max), blocks_max_(blocks_max), scratch_(scratch) {}

  void rescan(const Component& component) {
    const int first_run = scratch_.run_count;
    const Pixel level = level_of(component);
    std::uint16_t index = component.first_run;
    while (add_run(scratch_.runs[index], level) && index != component.last_run)
      index = scratch_.next_run[index];
    append_components(scratch_, first_run, level);
  }

  [[nodiscard]] Rescan result() const { return result_; }

 private:
  [[nodiscard]] Pixel level_of(const Component& component) const {
    const std::uint64_t mean = mean_of(component, [](std::int64_t value) { return value; });
    const auto middle = static_cast<std::int64_t>(mean);
    const std::uint64_t deviation =
        mean_of(component, [=](std::int64_t value) { return std::abs(value - middle); });
    const std::uint64_t level =
        std::max(mean * k_level_halves / 2, mean + k_level_deviations * deviation);
    return static_cast<Pixel>(std::min<std::uint64_t>(level, std::numeric_limits<Pixel>::max()));
  }

  // Mean of a function of the component's pixels, sampled at a quarter and three quarters of each
  // run.
  template <class Function>
  [[nodiscard]] std::uint64_t mean_of(const Component& component, Function function) const {
    std::int64_t sum = 0;
    for_each_run(scratch_, component, [&](const RasterRun& run) {
      const Pixel* row = image_.row(run.y());
      const int length = run.x1() - run.x0();
      sum += length *
             (function(row[run.x0() + length / 4]) + function(row[run.x0() + 3 * length / 4]));
    });
    return static_cast<std::uint64_t>(sum) / (2 * component.area_px);
  }

  // Appends the pixels of a run above the level as runs. Returns false if a budget is full.
  bool add_run(const RasterRun& run, Pixel level) {
    const int y = run.y(), x1 = run.x1();
    const Pixel* row = image_.row(y);
    BlockMask<Pixel> open = 0;
    int from = 0;
    for (int x = run.x0(); x < x1; x += k_mask_pixels<Pixel>) {
      if (result_.blocks == blocks_max_) return stop();
      ++result_.blocks;
      const BlockMask<Pixel> mask = bright_mask(row, image_.width, x, x1, level);
      for (BlockMask<Pixel> edges = mask ^ (mask << 1 | open); edges != 0; edges &= edges - 1) {
        const int at = x + std::countr_zero(edges);
        if (open != 0 && !put(y, from, at)) return false;
        from = at;
        open ^= 1;
      }
    }
    return open == 0 || put(y, from, x1);
  }

  bool put(int y, int x0, int x1) {
    if (scratch_.run_count >= runs_max_) return stop();
    const auto row = static_cast<std::uint32_t>(y) << 16;
    scratch_.runs[static_cast<std::size_t>(scratch_.run_count++)] = {
        row | static_cast<std::uint32_t>(x0), row | static_cast<std::uint32_t>(x1)};
    return true;
  }

  bool stop() {
    result_.reason = Reason::runs_full;
    return false;
  }

  const ImageView<Pixel>& image_;
  int runs_max_, blocks_max_;
  BlobScratch& scratch_;
  Rescan result_;
};

// The levels increase strictly: a mean exceeds the threshold of its component.
template <class Pixel>
Rescan rescan(const ImageView<Pixel>& image, std::uint32_t max_area_px, int runs_max,
              int blocks_max, BlobScratch& scratch) {
  Rescanner<Pixel> rescanner(image, runs_max, blocks_max, scratch);
  for (int i = 0; i < scratch.component_count && rescanner.result().reason == Reason::none; ++i) {
    const Component component = scratch.components[static_cast<std::size_t>(i)];
    if (component.area_px > max_area_px) rescanner.rescan(component);
  }
  return rescanner.result();
}

}  // namespace

Rescan rescan_oversized(const Frame& frame, std::uint32_t max_area_px, int runs_max, int blocks_max,
                        BlobScratch& scratch) noexcept {
  return frame.reflectivity_8.empty()
             ? rescan(frame.reflectivity_16, max_area_px, runs_max, blocks_max, scratch)
             : rescan(frame.reflectivity_8, max_area_px, runs_max, blocks_max, scratch);
}

bool has_marker_contrast(const Frame& frame, const Component& component) noexcept {
  const int x = (component.x0 + component.x1 - 1) / 2, y = (component.y0 + component.y1 - 1) / 2;
  const int centre = frame.reflectivity_8.empty() ? int{frame.reflectivity_16.row(y)[x]}
                                                  : int{frame.reflectivity_8.row(y)[x]};
  return 2 * centre >= k_contrast_halves * component.level;
}

}  // namespace glint

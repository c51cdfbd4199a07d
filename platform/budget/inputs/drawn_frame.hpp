// Synthetic frames for measurements: drawn from markers, hands and patterns, or from the simulator.
#pragma once

#include "kernels/image/frame.hpp"
#include "platform/budget/inputs/counter_random.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

inline constexpr std::uint16_t k_drawn_threshold = 1000;
inline constexpr std::uint16_t k_drawn_bright = 20'000;

// Bright runs at equal distances: dots, checkerboards, combs, bars, boxes.
struct RunPattern {
  int run = 1, gap = 1;    // along a row
  int rows = 1, skip = 1;  // rows with runs, then rows without
  int shift = 0;           // offset to the right from one row to the next
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  std::uint16_t level = k_drawn_bright;
};

class DrawnFrame {
 public:
  // Dark frame of the limits' size, with 16 bits if they allow it.
  void clear(const Limits& limits);
  void disc(double cx, double cy, double radius, std::uint16_t level);
  void depth_disc(double cx, double cy, double radius, std::uint16_t raw);
  void pattern(const RunPattern& pattern);
  // Markers of five tools, 20 stray reflections, and up to two hands.
  void scene(CounterRandom& random);
  // One of several frames of the simulator's default run, shifted, with added stray reflections.
  void recorded(CounterRandom& random);

  [[nodiscard]] int width() const { return buffer_.width; }
  [[nodiscard]] int height() const { return buffer_.height; }
  // Valid until the frame changes; 8 bits if the limits allow no more.
  [[nodiscard]] Frame view();

 private:
  void row_run(int y, int x0, int x1, std::uint16_t level);

  FrameBuffer buffer_;
  std::vector<std::uint8_t> narrow_;
  bool is_narrow_ = false;
};

}  // namespace glint

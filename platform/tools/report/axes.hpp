// One panel of a plot: frame, ticks at round numbers, and the transform from data to canvas units.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/report/svg.hpp"

namespace glint {

struct Range {
  double low = 0;
  double high = 1;
  [[nodiscard]] double span() const { return high - low; }
};

// Adds `part` of the range's span on both sides. Returns [low - 1, low + 1] for an empty or
// reversed range, [-1, 1] if its low end is not finite.
[[nodiscard]] Range with_margin(const Range& range, double part);

// Round numbers inside the range, about `wanted` of them; their step is 1, 2 or 5 times a power of
// 10.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
[[nodiscard]] Ticks round_ticks(const Range& range, int wanted);

struct AxesText {
  std::string title;
  std::string x_label;
  std::string y_label;
};

class Axes {
 public:
  // Corner and size of the plotted area. Labels are outside of it: 70 units left, 48 below, 28
  // above.
  Axes(SvgCanvas& canvas, const Vector2& corner, const Vector2& size, const Range& x,
       const Range& y);

  void draw(const AxesText& text);
  [[nodiscard]] Vector2 to_canvas(double x, double y) const;
  void line(std::vector<Vector2> values, const Stroke& stroke);
  // Bar from the axis up to y.
  void bar(double x_low, double x_high, double y, std::string_view fill, double opacity);
  void vertical(double x, const Stroke& stroke, std::string_view label, double label_drop);
  // Draws a stroke and its name in the upper right corner; `row` counts from the top.
  void legend(int row, std::string_view name, const Stroke& stroke);

 private:
  SvgCanvas& canvas_;
  Vector2 corner_, size_;
  Range x_, y_;
  std::string clip_;
};

// Colours that differ in brightness, so that they also differ in grey. Source: Okabe and Ito 2008,
// Color universal design.
[[nodiscard]] std::string_view series_colour(std::size_t index);

}  // namespace glint

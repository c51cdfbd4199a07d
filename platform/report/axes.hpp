// One panel of a diagram: a frame with ticks at round numbers, and the way from values to picture
// units.
#pragma once

#include <string>
#include <vector>

#include "platform/report/svg.hpp"

namespace glint {

struct Range {
  double low = 0;
  double high = 1;
  [[nodiscard]] double span() const { return high - low; }
};

// The range with `part` of its span added on both sides; an empty or reversed one becomes [-1, 1]
// about its low end.
[[nodiscard]] Range widened(const Range& range, double part);

// Round numbers (1, 2 or 5 times a power of ten apart) inside the range, about `wanted` of them.
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
  // corner and size of the plotted area; labels are drawn outside of it: 70 left, 48 below, 28
  // above.
  Axes(SvgCanvas& canvas, const Vector2& corner, const Vector2& size, const Range& x,
       const Range& y);

  void draw(const AxesText& text);
  [[nodiscard]] Vector2 place(double x, double y) const;
  void line(std::vector<Vector2> values, const Stroke& stroke);
  // From the axis up to y.
  void bar(double x_low, double x_high, double y, std::string_view fill, double opacity);
  void vertical(double x, const Stroke& stroke, std::string_view label, double label_drop);
  // A stroke and a name, in the upper right corner, `row` counting from the top.
  void legend(int row, std::string_view name, const Stroke& stroke);

 private:
  SvgCanvas& canvas_;
  Vector2 corner_, size_;
  Range x_, y_;
  std::string clip_;
};

// Far apart in brightness too, so that they differ in grey. Okabe and Ito 2008, Color universal
// design.
[[nodiscard]] std::string_view series_colour(std::size_t index);

}  // namespace glint

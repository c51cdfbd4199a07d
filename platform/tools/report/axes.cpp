#include "platform/tools/report/axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

constexpr std::string_view k_grid_colour = "#e4e4e4";
constexpr std::string_view k_frame_colour = "#777777";
constexpr double k_legend_row = 17;
constexpr int k_ticks_max = 50;

}  // namespace

Range with_margin(const Range& range, double part) {
  if (!(range.span() > 0) || !std::isfinite(range.span()))
    return std::isfinite(range.low) ? Range{range.low - 1, range.low + 1} : Range{-1, 1};
  return {range.low - part * range.span(), range.high + part * range.span()};
}

Ticks round_ticks(const Range& range, int wanted) {
  const double rough = range.span() / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double part = rough / power;
  const double step = power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
  Ticks ticks;
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step * 1.0001))));
  const double first = std::ceil(range.low / step - 1e-9);
  for (int i = 0; i < k_ticks_max; ++i) {
    const double value = (first + i) * step;
    if (value > range.high + 1e-9 * step) break;
    ticks.values.push_back(value);
  }
  return ticks;
}

std::string_view series_colour(std::size_t index) {
  constexpr std::array<std::string_view, 6> colours = {"#0072b2", "#d55e00", "#009e73",
                                                       "#cc79a7", "#e69f00", "#222222"};
  return colours[index % colours.size()];
}

Axes::Axes(SvgCanvas& canvas, const Vector2& corner, const Vector2& size, const Range& x,
           const Range& y)
    : canvas_(canvas), corner_(corner), size_(size), x_(with_margin(x, 0)), y_(with_margin(y, 0)) {
  clip_ = canvas_.clip_rectangle(corner, size);
}

Vector2 Axes::to_canvas(double x, double y) const {
  return {corner_.x() + size_.x() * (x - x_.low) / x_.span(),
          corner_.y() + size_.y() * (y_.high - y) / y_.span()};
}

void Axes::draw(const AxesText& text) {
  const double left = corner_.x(), top = corner_.y();
  const double right = left + size_.x(), bottom = top + size_.y();
  const Ticks x_ticks = round_ticks(x_, static_cast<int>(size_.x() / 70));
  for (const double value : x_ticks.values) {
    const double x = to_canvas(value, y_.low).x();
    canvas_.line({x, top}, {x, bottom}, {k_grid_colour, 1, {}});
    canvas_.text({x, bottom + 16}, number_text(value, x_ticks.decimals),
                 {.size = 11, .anchor = TextAnchor::middle});
  }
  const Ticks y_ticks = round_ticks(y_, static_cast<int>(size_.y() / 45));
  for (const double value : y_ticks.values) {
    const double y = to_canvas(x_.low, value).y();
    canvas_.line({left, y}, {right, y}, {k_grid_colour, 1, {}});
    canvas_.text({left - 6, y + 4}, number_text(value, y_ticks.decimals),
                 {.size = 11, .anchor = TextAnchor::end});
  }
  for (const auto& [from, to] : {std::pair(Vector2(left, bottom), Vector2(right, bottom)),
                                 std::pair(Vector2(left, top), Vector2(left, bottom))}) {
    canvas_.line(from, to, {k_frame_colour, 1, {}});
  }
  canvas_.text({left, top - 10}, text.title, {.size = 14, .bold = true});
  canvas_.text({left + size_.x() / 2, bottom + 36}, text.x_label, {.anchor = TextAnchor::middle});
  canvas_.text({left - 54, top + size_.y() / 2}, text.y_label,
               {.anchor = TextAnchor::middle, .upwards = true});
}

void Axes::line(std::vector<Vector2> values, const Stroke& stroke) {
  for (Vector2& value : values) value = to_canvas(value.x(), value.y());
  canvas_.polyline(values, stroke, clip_);
}

void Axes::bar(double x_low, double x_high, double y, std::string_view fill, double opacity) {
  const Vector2 top = to_canvas(x_low, std::clamp(y, y_.low, y_.high));
  const Vector2 bottom = to_canvas(x_high, std::clamp(0.0, y_.low, y_.high));
  if (bottom.y() > top.y()) canvas_.rectangle(top, bottom - top, fill, opacity);
}

void Axes::vertical(double x, const Stroke& stroke, std::string_view label, double label_drop) {
  if (!(x >= x_.low && x <= x_.high)) return;
  canvas_.line(to_canvas(x, y_.low), to_canvas(x, y_.high), stroke);
  // Without room to the right of the line, the label is to its left.
  const Vector2 top = to_canvas(x, y_.high);
  const bool right = top.x() < corner_.x() + 0.7 * size_.x();
  canvas_.text(
      {top.x() + (right ? 5 : -5), top.y() + label_drop}, label,
      {.size = 11, .colour = stroke.colour, .anchor = right ? TextAnchor::start : TextAnchor::end});
}

void Axes::legend(int row, std::string_view name, const Stroke& stroke) {
  const double y = corner_.y() + 14 + k_legend_row * row;
  const double right = corner_.x() + size_.x() - 8;
  canvas_.line({right - 22, y - 4}, {right, y - 4}, stroke);
  canvas_.text({right - 28, y}, name, {.anchor = TextAnchor::end});
}

}  // namespace glint

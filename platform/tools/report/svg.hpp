// Minimal SVG writer for plots: lines, polylines, rectangles, text. Coordinates are CSS pixels, x
// to the right, y down.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kernels/geometry.hpp"

namespace glint {

struct Stroke {
  std::string_view colour = "#222222";
  double width = 1;
  std::string_view dashes;  // as SVG's stroke-dasharray; empty: solid
};

enum class TextAnchor { start, middle, end };

struct TextStyle {
  double size = 12;
  std::string_view colour = "#222222";
  TextAnchor anchor = TextAnchor::start;
  bool bold = false;
  bool upwards = false;  // rotated by 90 degrees counterclockwise about its position
};

class SvgCanvas {
 public:
  SvgCanvas(double width, double height);

  void line(const Vector2& from, const Vector2& to, const Stroke& stroke);
  // A non-finite point breaks the line. `clip`: name returned by clip_rectangle(), or empty.
  void polyline(std::span<const Vector2> points, const Stroke& stroke, std::string_view clip = {});
  void rectangle(const Vector2& corner, const Vector2& size, std::string_view fill, double opacity);
  void text(const Vector2& position, std::string_view words, const TextStyle& style = {});
  // Declares a clip rectangle for polylines; returns its name.
  std::string clip_rectangle(const Vector2& corner, const Vector2& size);

  [[nodiscard]] std::string finished() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
  int clips_ = 0;
};

// At most `decimals` digits after the point, without trailing zeros; "-" if not finite.
[[nodiscard]] std::string number_text(double value, int decimals);

// Writes a temporary file beside `path` and renames it, so that readers never see a partial file.
// Throws InputError if the folder cannot be written.
void write_text_file(const std::string& path, std::string_view text);

}  // namespace glint

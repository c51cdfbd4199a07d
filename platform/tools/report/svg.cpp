#include "platform/tools/report/svg.hpp"

#include <cmath>
#include <cstdio>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

// Two decimals: a hundredth of a canvas unit is below the resolution of a screen.
std::string unit(double value) { return number_text(value, 2); }

std::string pair(std::string_view a, double x, std::string_view b, double y) {
  return ' ' + std::string(a) + "=\"" + unit(x) + "\" " + std::string(b) + "=\"" + unit(y) + '"';
}

std::string attributes(const Stroke& stroke) {
  std::string text =
      " stroke=\"" + std::string(stroke.colour) + "\" stroke-width=\"" + unit(stroke.width) + '"';
  if (!stroke.dashes.empty()) text += " stroke-dasharray=\"" + std::string(stroke.dashes) + '"';
  return text;
}

}  // namespace

std::string number_text(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char digits[64];
  std::snprintf(digits, sizeof digits, std::abs(value) < 1e15 ? "%.*f" : "%.*e", decimals, value);
  std::string text = digits;
  if (text.find('.') != std::string::npos && text.find('e') == std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

SvgCanvas::SvgCanvas(double width, double height) {
  body_ = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + pair("width", width, "height", height) +
          " viewBox=\"0 0 " + unit(width) + ' ' + unit(height) +
          "\" font-family=\"Helvetica, Arial, sans-serif\">\n";
  rectangle({0, 0}, {width, height}, "#ffffff", 1);
}

void SvgCanvas::line(const Vector2& from, const Vector2& to, const Stroke& stroke) {
  body_ += "<line" + pair("x1", from.x(), "y1", from.y()) + pair("x2", to.x(), "y2", to.y()) +
           attributes(stroke) + "/>\n";
}

void SvgCanvas::polyline(std::span<const Vector2> points, const Stroke& stroke,
                         std::string_view clip) {
  std::string path;
  bool pen_down = false;
  for (const Vector2& point : points) {
    if (!point.allFinite()) {
      pen_down = false;
      continue;
    }
    path += (pen_down ? 'L' : 'M') + unit(point.x()) + ' ' + unit(point.y());
    pen_down = true;
  }
  if (path.empty()) return;
  body_ += "<path d=\"" + path + "\" fill=\"none\" stroke-linejoin=\"round\"" + attributes(stroke);
  if (!clip.empty()) body_ += " clip-path=\"url(#" + std::string(clip) + ")\"";
  body_ += "/>\n";
}

void SvgCanvas::rectangle(const Vector2& corner, const Vector2& size, std::string_view fill,
                          double opacity) {
  body_ += "<rect" + pair("x", corner.x(), "y", corner.y()) +
           pair("width", size.x(), "height", size.y()) + " fill=\"" + std::string(fill) +
           "\" fill-opacity=\"" + unit(opacity) + "\"/>\n";
}

void SvgCanvas::text(const Vector2& position, std::string_view words, const TextStyle& style) {
  constexpr std::string_view anchors[] = {"start", "middle", "end"};
  body_ += "<text" + pair("x", position.x(), "y", position.y()) + " font-size=\"" +
           unit(style.size) + "\" fill=\"" + std::string(style.colour) + "\" text-anchor=\"" +
           std::string(anchors[static_cast<std::size_t>(style.anchor)]) + '"';
  if (style.bold) body_ += " font-weight=\"bold\"";
  if (style.upwards)
    body_ += " transform=\"rotate(-90 " + unit(position.x()) + ' ' + unit(position.y()) + ")\"";
  body_ += '>' + printable_markup(words) + "</text>\n";
}

std::string SvgCanvas::clip_rectangle(const Vector2& corner, const Vector2& size) {
  std::string name = "clip" + std::to_string(++clips_);
  body_ += "<clipPath id=\"" + name + "\"><rect" + pair("x", corner.x(), "y", corner.y()) +
           pair("width", size.x(), "height", size.y()) + "/></clipPath>\n";
  return name;
}

void write_text_file(const std::string& path, std::string_view text) {
  if (const std::string reason = write_file_atomically(path, text); !reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason +
                     "; expected a writable folder with free space");
  }
}

}  // namespace glint

#include "platform/budget/report/drawing.hpp"

#include "platform/printable.hpp"
#include "platform/tools/report/axes.hpp"
#include "platform/tools/report/svg.hpp"

namespace glint {
namespace {

std::string attribute(std::string_view name, double value) {
  return ' ' + std::string(name) + "=\"" + number_text(value, 2) + '"';
}

std::string class_attribute(std::string_view classes) {
  return classes.empty() ? "" : " class=\"" + std::string(classes) + '"';
}

// Width of a character relative to the font size; slightly above the mean of usual sans serifs.
constexpr double k_character = 0.56;

}  // namespace

std::string fitting(std::string_view words, double width, double size) {
  const auto room = static_cast<std::size_t>(std::max(0.0, width / (k_character * size)));
  if (words.size() <= room) return std::string(words);
  if (room < 3) return "";
  return std::string(words.substr(0, room - 1)) + "\u2026";
}

Drawing::Drawing(double width, double height, std::string_view alternative_text) {
  body_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\"" + attribute("width", width) +
          attribute("height", height) + " viewBox=\"0 0 " + number_text(width, 2) + ' ' +
          number_text(height, 2) + "\"><title>" + printable_markup(alternative_text) + "</title>\n";
}

void Drawing::line(double x1, double y1, double x2, double y2, std::string_view classes) {
  body_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) +
           attribute("y2", y2) + class_attribute(classes) + "/>\n";
}

void Drawing::box(const Box& box, std::string_view classes, std::string_view hint) {
  body_ += "<rect" + attribute("x", box.x) + attribute("y", box.y) +
           attribute("width", std::max(0.0, box.width)) + attribute("height", box.height) +
           class_attribute(classes);
  body_ += hint.empty() ? "/>\n" : "><title>" + printable_markup(hint) + "</title></rect>\n";
}

void Drawing::text(double x, double y, std::string_view words, std::string_view classes) {
  if (words.empty()) return;
  body_ += "<text" + attribute("x", x) + attribute("y", y) + class_attribute(classes) + '>' +
           printable_markup(words) + "</text>\n";
}

void Drawing::x_axis(const Box& area, double high, std::string_view label, int wanted) {
  const Ticks ticks = round_ticks({0, high}, wanted);
  for (const double value : ticks.values) {
    const double x = area.x + area.width * value / high;
    line(x, area.y, x, area.y + area.height, "grid");
    text(x, area.y + area.height + 14, number_text(value, ticks.decimals), "faint small middle");
  }
  line(area.x, area.y + area.height, area.x + area.width, area.y + area.height, "axis");
  text(area.x + area.width, area.y + area.height + 28, label, "faint small end");
}

}  // namespace glint

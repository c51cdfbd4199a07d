// SVG drawing for the report's figures. Colours are CSS classes of the page, so that a figure
// follows light mode, dark mode and print. Units are CSS pixels, y down.
#pragma once

#include <string>
#include <string_view>

namespace glint {

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
};

class Drawing {
 public:
  // `alternative_text`: alternative text for screen readers.
  Drawing(double width, double height, std::string_view alternative_text);

  void line(double x1, double y1, double x2, double y2, std::string_view classes);
  // `hint`: tooltip; may be empty.
  void box(const Box& box, std::string_view classes, std::string_view hint = {});
  void text(double x, double y, std::string_view words, std::string_view classes = {});
  // Grid lines and numbers at round values between 0 and `high`, below the plotted area.
  void x_axis(const Box& area, double high, std::string_view label, int wanted = 8);

  [[nodiscard]] std::string finished() const { return body_ + "</svg>"; }

 private:
  std::string body_;
};

// Shortens the text with an ellipsis if it is wider than `width`, at the style's 12 pixels.
[[nodiscard]] std::string fitting(std::string_view words, double width, double size = 12);

}  // namespace glint

// Shapes of a figure on the page. Colours are classes of the page's style, so that a figure follows
// it from light to dark and onto paper. Picture units are CSS pixels, y down.
#pragma once

#include <string>
#include <string_view>

namespace glint {

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
};

class Drawing {
 public:
  // `spoken`: what a reader hears who does not see it.
  Drawing(double width, double height, std::string_view spoken);

  void line(double x1, double y1, double x2, double y2, std::string_view classes);
  // `hint` appears under a pointer; may be empty.
  void box(const Box& box, std::string_view classes, std::string_view hint = {});
  void text(double x, double y, std::string_view words, std::string_view classes = {});
  // Grid lines and numbers at round values between 0 and `high`, below the plotted area.
  void x_axis(const Box& area, double high, std::string_view label, int wanted = 8);

  [[nodiscard]] std::string finished() const { return body_ + "</svg>"; }

 private:
  std::string body_;
};

// Shortened with an ellipsis where it would be wider than this, at the style's 12 pixels.
[[nodiscard]] std::string fitting(std::string_view words, double width, double size = 12);

}  // namespace glint

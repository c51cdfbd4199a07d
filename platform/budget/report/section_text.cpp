#include <algorithm>
#include <cmath>

#include "platform/budget/report/sections.hpp"
#include "platform/tools/report/svg.hpp"

namespace glint {

std::string us_text(double us) {
  if (!std::isfinite(us)) return "none";
  const double size = std::abs(us);
  if (size >= 1000) return count_text(us);
  return number_text(us, size < 10 ? 3 : size < 100 ? 2 : 1);
}

std::string count_text(double n) {
  if (!std::isfinite(n)) return "none";
  std::string digits = number_text(std::abs(n), 0);
  for (std::size_t place = digits.size(); place > 3;) {
    place -= 3;
    digits.insert(place, "\u2009");
  }
  return (n < 0 ? "-" : "") + digits;
}

std::string percent_text(double percent) {
  if (!std::isfinite(percent)) return "none";
  return (percent >= 1000 ? count_text(percent) : number_text(percent, 1)) + " %";
}

double left_percent(double bound_us, double deadline_us) {
  return deadline_us > 0 ? 100 * (1 - bound_us / deadline_us) : std::nan("");
}

Tone tone_of_left(double percent) { return percent >= 0 ? Tone::plain : Tone::bad; }

std::string node_label(const JsonView& node, const std::vector<JsonView>& all) {
  const std::string name = node.text("name");
  const auto copies = std::count_if(all.begin(), all.end(), [&](const JsonView& other) {
    return other.text("name") == name && other.text("group") == node.text("group");
  });
  return copies < 2 ? name : name + '#' + number_text(node.number_or("copy", 0), 0);
}

Sentence missing_input(const std::string& option, const std::string& command) {
  return {"Not given: pass `" + option + "`, made by `" + command + "`.", Tone::faint};
}

}  // namespace glint

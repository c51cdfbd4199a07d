#include <algorithm>
#include <cmath>

#include "platform/budget/report/sections.hpp"
#include "platform/report/svg.hpp"

namespace glint {

std::string us_text(double us) {
  const double size = std::abs(us);
  const int decimals = size < 10 ? 3 : size < 100 ? 2 : size < 1000 ? 1 : 0;
  return size >= 10'000 && std::isfinite(us) ? count_text(us) : number_text(us, decimals);
}

std::string count_text(double n) {
  std::string digits = number_text(std::abs(n), 0);
  if (!std::isfinite(n)) return "-";
  for (std::size_t place = digits.size(); place > 3;) {
    place -= 3;
    digits.insert(place, "\u2009");
  }
  return (n < 0 ? "-" : "") + digits;
}

std::string percent_text(double percent) { return number_text(percent, 1) + " %"; }

Tone tone_of_slack(double percent, double wanted) {
  return percent < std::max(0.0, wanted) ? Tone::bad : Tone::plain;
}

std::string node_label(const JsonView& node, const std::vector<JsonView>& all) {
  const std::string name = node.text("name");
  const auto copies = std::count_if(all.begin(), all.end(), [&](const JsonView& other) {
    return other.text("name") == name && other.text("group") == node.text("group");
  });
  return copies < 2 ? name : name + '#' + number_text(node.number_or("copy", 0), 0);
}

Sentence not_given(const std::string& option, const std::string& command) {
  return {"Not given: pass `" + option + "`, made by `" + command + "`.", Tone::faint};
}

}  // namespace glint

#include <algorithm>
#include <map>
#include <set>

#include "platform/budget/report/drawing.hpp"
#include "platform/budget/report/figures.hpp"
#include "platform/tools/report/svg.hpp"

namespace glint {
namespace {

constexpr double k_width = 1080, k_left = 76, k_right = 16;
constexpr double k_lane = 24, k_gap = 4, k_title = 24, k_axis = 34;
constexpr int k_shades = 8;
// Beyond this ratio a common axis would compress the shorter strips too much.
constexpr double k_common_axis_ratio_max = 2.5;

// Copies of a node share its shade.
std::string stem_of(const std::string& name) { return name.substr(0, name.find('#')); }

double end_of(const GanttStrip& strip) {
  double end = 0;
  for (const GanttBar& bar : strip.bars) end = std::max(end, bar.to_us);
  return end;
}

// The longest form that fits: full name, name without copy number, capitals, or nothing.
std::string label_for_width(const std::string& name, double width) {
  if (fitting(name, width - 6, 11) == name) return name;
  const std::string stem = stem_of(name);
  if (fitting(stem, width - 6, 11) == stem) return stem;
  std::string capitals;
  std::copy_if(stem.begin(), stem.end(), std::back_inserter(capitals),
               [](char c) { return c >= 'A' && c <= 'Z'; });
  return 8.5 * static_cast<double>(capitals.size()) < width - 2 ? capitals : "";
}

void draw_strip(Drawing& drawing, const GanttStrip& strip, double top, double range_us,
                double deadline_us, const std::map<std::string, int>& shades) {
  std::set<int> cores;
  for (const GanttBar& bar : strip.bars) cores.insert(bar.core);
  const double scale = (k_width - k_left - k_right) / range_us;
  const double height = static_cast<double>(cores.size()) * (k_lane + k_gap) - k_gap;
  drawing.text(0, top + 14, strip.title, "strong");
  drawing.x_axis({k_left, top + k_title, k_width - k_left - k_right, height + 2}, range_us,
                 "\u00b5s after release", 10);
  double y = top + k_title;
  for (const int core : cores) {
    drawing.box({k_left, y, k_width - k_left - k_right, k_lane}, "lane");
    drawing.text(k_left - 8, y + 16, "core " + std::to_string(core), "faint end");
    for (const GanttBar& bar : strip.bars) {
      if (bar.core != core) continue;
      const Box box{k_left + bar.from_us * scale, y + (bar.other ? 7 : 1),
                    std::max(0.6, (bar.to_us - bar.from_us) * scale),
                    bar.other ? k_lane - 14 : k_lane - 2};
      const std::string hint = bar.name + ": " + number_text(bar.from_us, 2) + " to " +
                               number_text(bar.to_us, 2) + " \u00b5s (" +
                               number_text(bar.to_us - bar.from_us, 2) + " \u00b5s)";
      const auto shade = shades.find(stem_of(bar.name));
      drawing.box(box,
                  bar.other ? "tick"
                            : std::string("n").append(std::to_string(shade->second)) +
                                  (bar.late ? " late" : " block"),
                  hint);
      if (!bar.other) {
        drawing.text(box.x + box.width / 2, y + 16, label_for_width(bar.name, box.width),
                     "inblock");
      }
    }
    y += k_lane + k_gap;
  }
  if (deadline_us > 0 && deadline_us <= range_us) {
    const double x = k_left + deadline_us * scale;
    drawing.line(x, top + k_title - 6, x, y, "deadline");
    drawing.text(x - 4, top + k_title - 2, "deadline", "bad small end");
  }
}

}  // namespace

Illustration gantt_figure(const std::string& name, const std::string& caption,
                          const std::vector<GanttStrip>& strips, double deadline_us) {
  std::map<std::string, int> shades;
  double height = 6, least = 0, most = 0;
  for (const GanttStrip& strip : strips) {
    std::set<int> cores;
    for (const GanttBar& bar : strip.bars) {
      cores.insert(bar.core);
      if (!bar.other) shades.try_emplace(stem_of(bar.name), shades.size() % k_shades);
    }
    height += k_title + static_cast<double>(cores.size()) * (k_lane + k_gap) + k_axis;
    const double end = end_of(strip);
    least = least == 0 ? end : std::min(least, end);
    most = std::max(most, end);
  }
  const bool one_axis = most <= k_common_axis_ratio_max * least;
  const std::string words = caption + (one_axis ? "" : " Each strip has its own time axis.");
  Drawing drawing(k_width, height, words);
  double top = 0;
  for (const GanttStrip& strip : strips) {
    std::set<int> cores;
    for (const GanttBar& bar : strip.bars) cores.insert(bar.core);
    const double end = one_axis ? most : end_of(strip);
    const double range = std::max(1e-3, end * 1.02);
    draw_strip(drawing, strip, top, range, deadline_us, shades);
    top += k_title + static_cast<double>(cores.size()) * (k_lane + k_gap) + k_axis;
  }
  return {name, words, drawing.finished()};
}

}  // namespace glint

#include "platform/cells/tool_notices.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_move_max_mm = 40;

const Tool& tool_at(const ToolSet& tools, int t) {
  return tools.items[static_cast<std::size_t>(t)];
}

// Rounds down, so that a value below a limit is never printed as the limit.
std::string sigmas(double distance) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", std::floor(distance * 10) / 10);
  return text;
}

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string listed(const std::vector<int>& markers) {
  std::string text;
  for (const int marker : markers) {
    text += (text.empty() ? "" : ", ") + std::to_string(marker + 1);
  }
  return text;
}

struct WarningWriter {
  const ToolSet& tools;
  const std::vector<std::string>& files;
  const DistinctionSettings& settings;

  std::string named(int t) const {
    const std::string& file = files.at(static_cast<std::size_t>(t));
    return std::string("\"") + tool_at(tools, t).name.data() + "\" (" +
           (file == "pen" ? "built in" : file) + ")";
  }

  std::string subject(const WrongLabeling& labeling) const {
    if (labeling.seen == labeling.other) return "tool " + named(labeling.seen);
    return "tools " + named(labeling.seen) + " and " + named(labeling.other);
  }

  // Markers count from 1, in the order of their file.
  static std::string labeling_text(const WrongLabeling& labeling) {
    const bool own = labeling.seen == labeling.other;
    std::vector<int> from, to;
    for (std::size_t i = 0; i < labeling.assignment.size(); ++i) {
      const int name = labeling.assignment[i];
      if (name < 0 || (own && name == static_cast<int>(i))) continue;
      from.push_back(static_cast<int>(i));
      to.push_back(name);
    }
    if (own) return "its markers " + listed(from) + " may be mistaken for its own " + listed(to);
    return "markers " + listed(from) + " of the first match " + listed(to) + " of the second";
  }

  std::string consequence(const WrongLabeling& labeling) const {
    const std::string share = number("%.2g", 100 * error_probability(labeling.distance_sigmas));
    return sigmas(labeling.distance_sigmas) + " sigma apart at " +
           number("%.1f", 1e3 * settings.sigma_m) + " mm of range noise: in up to " + share +
           " % of frames the wrong one fits better" +
           (labeling.steps_exhausted ? " (not all labelings were compared)" : "");
  }

  std::string next_step(const WrongLabeling& labeling) const {
    const auto move = separating_move(tools, labeling, settings);
    if (!move) return "";
    return "; e.g. move marker " + std::to_string(move->marker + 1) + " of " + std::string("\"") +
           tool_at(tools, move->tool).name.data() + "\" by " + std::to_string(std::abs(move->mm)) +
           " mm along " + (move->mm < 0 ? "-" : "") + "xyz"[move->axis];
  }

  std::string warning(const WrongLabeling& labeling) const {
    if (labeling.markers == 0) {
      return subject(labeling) + ": not all labelings were compared in " +
             std::to_string(settings.steps_max) + " steps; separation is not proved to be " +
             sigmas(settings.limit_sigmas) + " sigma; expected tools with more different geometry";
    }
    const bool refused = labeling.distance_sigmas <= k_refused_sigmas;
    return subject(labeling) + ": " + labeling_text(labeling) + ", " + consequence(labeling) +
           "; expected " +
           (refused ? "more than " + sigmas(k_refused_sigmas) + ", better " : "at least ") +
           sigmas(settings.limit_sigmas) + next_step(labeling);
  }
};

}  // namespace

std::optional<MarkerMove> separating_move(const ToolSet& tools, const WrongLabeling& labeling,
                                          const DistinctionSettings& settings) {
  const int moved = std::max(labeling.seen, labeling.other);
  const double wanted_m = settings.limit_sigmas * settings.sigma_m;
  for (int mm = 1; mm <= k_move_max_mm; ++mm) {
    std::optional<MarkerMove> best;
    double best_m2 = wanted_m * wanted_m;
    for (int marker = 0; marker < tool_at(tools, moved).marker_count; ++marker) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const int shift : {mm, -mm}) {
          Tool changed = tool_at(tools, moved);
          changed.markers_m[static_cast<std::size_t>(marker)](axis) += 1e-3 * shift;
          const auto tool = [&](int t) -> const Tool& {
            return t == moved ? changed : tool_at(tools, t);
          };
          const double left_m2 =
              residual_squares_m2(tool(labeling.seen), tool(labeling.other), labeling.assignment);
          if (left_m2 < best_m2) continue;
          best_m2 = left_m2;
          best = {moved, marker, axis, shift};
        }
      }
    }
    if (best) return best;
  }
  return std::nullopt;
}

std::vector<std::string> tool_warnings(const ToolSet& tools, const std::vector<std::string>& files,
                                       const std::string& place,
                                       const DistinctionSettings& settings) {
  const Distinction found = distinguish(tools, settings);
  const WarningWriter writer{tools, files, settings};
  std::vector<std::string> warnings;
  for (const WrongLabeling& labeling : found.wrong_labelings) {
    const std::string warning = writer.warning(labeling);
    if (labeling.markers > 0 && labeling.distance_sigmas <= k_refused_sigmas) {
      throw InputError(place + ": " + warning);
    }
    warnings.push_back(warning);
  }
  return warnings;
}

}  // namespace glint

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

struct Teller {
  const ToolSet& tools;
  const std::vector<std::string>& files;
  const DistinctionSettings& settings;

  std::string named(int t) const {
    const std::string& file = files.at(static_cast<std::size_t>(t));
    return std::string("\"") + tool_at(tools, t).name.data() + "\" (" +
           (file == "pen" ? "built in" : file) + ")";
  }

  std::string subject(const Likeness& likeness) const {
    if (likeness.seen == likeness.other) return "tool " + named(likeness.seen);
    return "tools " + named(likeness.seen) + " and " + named(likeness.other);
  }

  // Markers count from 1, in the order of their file.
  static std::string likeness_of(const Likeness& likeness) {
    const bool own = likeness.seen == likeness.other;
    std::vector<int> from, to;
    for (std::size_t i = 0; i < likeness.taken_for.size(); ++i) {
      const int name = likeness.taken_for[i];
      if (name < 0 || (own && name == static_cast<int>(i))) continue;
      from.push_back(static_cast<int>(i));
      to.push_back(name);
    }
    if (own) return "its markers " + listed(from) + " may be taken for its own " + listed(to);
    return "markers " + listed(from) + " of the first lie as " + listed(to) + " of the second";
  }

  std::string consequence(const Likeness& likeness) const {
    const std::string share = number("%.2g", 100 * wrong_share(likeness.distance_sigmas));
    return sigmas(likeness.distance_sigmas) + " sigma away at " +
           number("%.1f", 1e3 * settings.sigma_m) + " mm of range noise, so that in up to " +
           share + " % of frames the wrong one fits better" +
           (likeness.search_full ? " (not all labelings were tried)" : "");
  }

  std::string next_step(const Likeness& likeness) const {
    const auto move = move_apart(tools, likeness, settings);
    if (!move) return "";
    return "; e.g. move marker " + std::to_string(move->marker + 1) + " of " + std::string("\"") +
           tool_at(tools, move->tool).name.data() + "\" by " + std::to_string(std::abs(move->mm)) +
           " mm along " + (move->mm < 0 ? "-" : "") + "xyz"[move->axis];
  }

  std::string notice(const Likeness& likeness) const {
    if (likeness.markers == 0) {
      return subject(likeness) + ": not all labelings were tried in " +
             std::to_string(settings.steps_max) + " steps; not known to be told apart by " +
             sigmas(settings.limit_sigmas) + " sigma; expected tools less alike";
    }
    const bool refused = likeness.distance_sigmas <= k_refused_sigmas;
    return subject(likeness) + ": " + likeness_of(likeness) + ", " + consequence(likeness) +
           "; expected " +
           (refused ? "more than " + sigmas(k_refused_sigmas) + ", better " : "at least ") +
           sigmas(settings.limit_sigmas) + next_step(likeness);
  }
};

}  // namespace

std::optional<MarkerMove> move_apart(const ToolSet& tools, const Likeness& likeness,
                                     const DistinctionSettings& settings) {
  const int moved = std::max(likeness.seen, likeness.other);
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
              squares_left_m2(tool(likeness.seen), tool(likeness.other), likeness.taken_for);
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

std::vector<std::string> tool_notices(const ToolSet& tools, const std::vector<std::string>& files,
                                      const std::string& place,
                                      const DistinctionSettings& settings) {
  const Distinction found = distinguish(tools, settings);
  const Teller teller{tools, files, settings};
  std::vector<std::string> notices;
  for (const Likeness& likeness : found.likenesses) {
    const std::string notice = teller.notice(likeness);
    if (likeness.markers > 0 && likeness.distance_sigmas <= k_refused_sigmas) {
      throw InputError(place + ": " + notice);
    }
    notices.push_back(notice);
  }
  return notices;
}

}  // namespace glint

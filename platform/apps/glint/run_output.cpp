#include "platform/apps/glint/run_output.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/angles.hpp"
#include "platform/runtime/session/losses.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

double milliseconds_of(Duration duration) { return duration.seconds() * 1e3; }

double part_of(std::uint64_t count, std::uint64_t all) {
  return static_cast<double>(count) / static_cast<double>(all);
}

ordered_json share(std::uint64_t count, std::uint64_t all) {
  return all > 0 ? ordered_json(part_of(count, all)) : ordered_json(nullptr);
}

std::string percent(const ordered_json& part) {
  if (part.is_null()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * part.get<double>());
  return text;
}

std::string in_milliseconds(const ordered_json& item, const SessionResult& result) {
  if (result.sent.ticks == 0) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f ms", item.get<double>());
  return text;
}

bool sums_hold(const SessionResult& result) {
  const bool dds = result.dds.offered == result.dds.written + result.dds.ring_dropped;
  const bool reader = !result.dds_was_read ||
                      result.dds_reader.received + result.dds_reader.missed == result.dds.written;
  return dds && reader;
}

ordered_json source_late_part(const SessionResult& result) {
  return share(result.ticks_source_late, static_cast<std::uint64_t>(result.ticks));
}

std::string source_late_text(const SessionResult& result) {
  return (result.source.text.empty() ? "the simulator" : result.source.text) + ": " +
         std::to_string(result.frames_late) + " late frames, " + percent(source_late_part(result)) +
         " of the ticks without a measurement because of them";
}

// Source of recorded frames, and each count that is not 0.
std::vector<std::pair<std::string, std::string>> source_rows(const SessionResult& result) {
  std::vector<std::pair<std::string, std::string>> rows;
  if (result.source.text.empty()) return rows;
  rows.emplace_back("source", result.source.text);
  for (const auto& [name, count] : result.source.counts) {
    std::string words = "  " + name;
    std::replace(words.begin(), words.end(), '_', ' ');
    if (count > 0) rows.emplace_back(words, std::to_string(count));
  }
  for (const std::string& line : result.source.failures) rows.emplace_back("SOURCE", line);
  rows.emplace_back("frames with a pose",
                    std::to_string(result.frames_tracked) + " of " + std::to_string(result.frames));
  return rows;
}

// Null if no pose has ground truth.
ordered_json errors_of(const OutputErrors& errors) {
  if (errors.count == 0) return nullptr;
  const auto n = static_cast<double>(errors.count);
  return {{"n", errors.count},
          {"gross", errors.gross},
          {"tip_rms_mm", 1e3 * std::sqrt(errors.square_m2 / n)},
          {"tip_p95_mm", 0.1 * quantile(errors.histogram, 0.95)},
          {"tip_max_mm", 1e3 * errors.largest_m},
          {"tip_stated_mm", 1e3 * std::sqrt(errors.stated_m2 / n)},
          {"tip_random_mm", 1e3 * std::sqrt(errors.random_m2 / n)},
          {"angle_rms_deg", k_degrees_per_radian * std::sqrt(errors.square_rad2 / n)},
          {"angle_stated_deg", k_degrees_per_radian * std::sqrt(errors.stated_rad2 / n)},
          {"angle_random_deg", k_degrees_per_radian * std::sqrt(errors.random_rad2 / n)},
          {"coverage_tip", share(errors.inside_position, errors.count)},
          {"coverage_angle", share(errors.inside_rotation, errors.count)}};
}

// One item for each frame rate with ticks.
ordered_json by_rate(const OutputByRate& rates, std::size_t tool, Duration period) {
  const double period_ms = milliseconds_of(period);
  const double limits_ms[k_frame_rates + 1] = {0, 1.5 * period_ms, 4.5 * period_ms, INFINITY};
  ordered_json list = ordered_json::array();
  for (std::size_t r = 0; r < k_frame_rates; ++r) {
    const RateStatistics& figures = rates.tools[tool][r];
    if (figures.ticks == 0) continue;
    const double seconds = rates.seconds[r];
    list.push_back(
        {{"gap_from_ms", limits_ms[r]},
         {"gap_to_ms", std::isfinite(limits_ms[r + 1]) ? ordered_json(limits_ms[r + 1]) : nullptr},
         {"frames_per_s",
          seconds > 0 ? ordered_json(static_cast<double>(rates.gaps[r]) / seconds) : nullptr},
         {"ticks", figures.ticks},
         {"measured", share(figures.measured, figures.ticks)},
         {"predicted", share(figures.predicted, figures.ticks)},
         {"lost", share(figures.ticks - figures.measured - figures.predicted, figures.ticks)},
         {"age_ms",
          {{"p50", quantile(figures.ages, 0.5)},
           {"p99", quantile(figures.ages, 0.99)},
           {"sigma_max", figures.largest_age_sigma_s * 1e3}}},
         {"errors_measured", errors_of(figures.of_measured)},
         {"errors_predicted", errors_of(figures.of_predicted)}});
  }
  return list;
}

std::string rate_text(const ordered_json& rate) {
  char text[256];
  std::snprintf(text, sizeof text,
                "measured %s, predicted %s, lost %s; age p50 %.0f, p99 %.0f, sigma <= %.1f ms",
                percent(rate.at("measured")).c_str(), percent(rate.at("predicted")).c_str(),
                percent(rate.at("lost")).c_str(), rate.at("age_ms").at("p50").get<double>(),
                rate.at("age_ms").at("p99").get<double>(),
                rate.at("age_ms").at("sigma_max").get<double>());
  return text;
}

std::string error_text(const ordered_json& errors) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "tip %.2f mm rms (stated %.2f, random part %.2f), angle %.2f deg (%.2f, %.2f); inside 95 %%: "
      "%s, %s; gross: %llu",
      errors.at("tip_rms_mm").get<double>(), errors.at("tip_stated_mm").get<double>(),
      errors.at("tip_random_mm").get<double>(), errors.at("angle_rms_deg").get<double>(),
      errors.at("angle_stated_deg").get<double>(), errors.at("angle_random_deg").get<double>(),
      percent(errors.at("coverage_tip")).c_str(), percent(errors.at("coverage_angle")).c_str(),
      errors.at("gross").get<unsigned long long>());
  return text;
}

std::string rate_name(const ordered_json& rate) {
  char text[64];
  if (rate.at("gap_to_ms").is_null()) {
    std::snprintf(text, sizeof text, "  frames over %.0f ms apart",
                  rate.at("gap_from_ms").get<double>());
  } else {
    std::snprintf(text, sizeof text, "  frames %.0f to %.0f ms apart",
                  rate.at("gap_from_ms").get<double>(), rate.at("gap_to_ms").get<double>());
  }
  return text;
}

void add_rate_rows(const ordered_json& tool, const std::string& whose,
                   std::vector<std::pair<std::string, std::string>>& rows) {
  for (const ordered_json& rate : tool.at("by_rate")) {
    rows.emplace_back(rate_name(rate) + whose, rate_text(rate));
    for (const char* state : {"measured", "predicted"}) {
      const ordered_json& errors = rate.at(std::string("errors_") + state);
      if (!errors.is_null()) {
        rows.emplace_back(std::string("    error, ") + state, error_text(errors));
      }
    }
  }
}

}  // namespace

ordered_json output_of(const Cell& cell, const SessionResult& result) {
  ordered_json tools = ordered_json::array();
  for (int t = 0; t < cell.tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const ToolTicks& tool = result.sent.tools[i];
    tools.push_back(
        {{"name", std::string(cell.tools.items[i].name.data())},
         {"measured", share(tool.measured, tool.all())},
         {"predicted", share(tool.predicted, tool.all())},
         {"lost", share(tool.lost, tool.all())},
         {"none_yet", share(tool.none, tool.all())},
         {"longest_without_measurement_ms", milliseconds_of(tool.longest_without_measurement)}});
    if (result.by_rate) tools.back()["by_rate"] = by_rate(*result.by_rate, i, cell.camera.period);
  }
  return {{"ticks_sent", result.sent.ticks},
          {"longest_gap_ms", milliseconds_of(result.sent.longest_gap)},
          {"source_late", source_late_part(result)},
          {"tools", tools}};
}

ordered_json losses_json(const SessionResult& result) {
  ordered_json losses = ordered_json::array();
  for (const Loss& loss : losses_of(result)) {
    losses.push_back({{"kind", loss.kind}, {"count", loss.count}, {"text", loss.text}});
  }
  return losses;
}

std::vector<std::pair<std::string, std::string>> output_rows(const ordered_json& summary,
                                                             const SessionResult& result) {
  std::vector<std::pair<std::string, std::string>> rows;
  const ordered_json& output = summary.at("output");
  const ordered_json& tools = output.at("tools");
  const std::string left = std::to_string(result.sent.ticks) + " ticks";
  for (const ordered_json& tool : tools) {
    const std::string whose = tools.size() > 1 ? ", " + tool.at("name").get<std::string>() : "";
    std::string text = "measured " + percent(tool.at("measured")) + ", predicted " +
                       percent(tool.at("predicted")) + ", lost " + percent(tool.at("lost"));
    if (tool.at("none_yet") != 0 && !tool.at("none_yet").is_null()) {
      text += ", none so far " + percent(tool.at("none_yet"));
    }
    rows.emplace_back("sent over CAN" + whose, text + " of " + left);
    rows.emplace_back("longest unmeasured" + whose,
                      in_milliseconds(tool.at("longest_without_measurement_ms"), result));
    if (tool.contains("by_rate")) add_rate_rows(tool, whose, rows);
  }
  rows.emplace_back("longest gap of ticks", in_milliseconds(output.at("longest_gap_ms"), result));
  for (auto& row : source_rows(result)) rows.push_back(std::move(row));
  if (result.frames_late > 0) rows.emplace_back("LATE SOURCE", source_late_text(result));
  for (const Loss& loss : losses_of(result)) rows.emplace_back("LOST, " + loss.kind, loss.text);
  return rows;
}

std::vector<std::string> failures_of(const SessionResult& result) {
  std::vector<std::string> lines = lines_of(losses_of(result));
  if (!result.fault.empty()) lines.push_back(result.fault);
  if (!sums_hold(result)) {
    lines.emplace_back("DDS: the counts of offered, written and received samples do not agree");
  }
  const ordered_json late = source_late_part(result);
  if (!late.is_null() && late > k_source_late_max) {
    lines.push_back("source too slow: " + source_late_text(result) + "; expected at most 1 %");
  }
  for (const std::string& line : result.source.failures) lines.push_back("source: " + line);
  const bool any_pose = result.accuracy.frames > 0 ? result.accuracy.poses > 0  // by ground truth
                                                   : result.frames_tracked > 0;
  if (!any_pose) {
    lines.emplace_back("no pose in the whole run; check the tools, the camera and the method");
  } else if (result.sent.ticks > 0 && !result.sent.any_measured()) {
    lines.emplace_back(
        "no measured tick sent over CAN, although frames gave poses; check the age of the frames");
  }
  return lines;
}

}  // namespace glint

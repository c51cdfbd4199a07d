#include "platform/cli/run_output.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "platform/session/losses.hpp"

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
         std::to_string(result.frames_late) + " frames late, " + percent(source_late_part(result)) +
         " of the ticks without a measurement for it";
}

// Of recorded frames: where they are from, and each count that is not 0.
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

}  // namespace

ordered_json source_json(const SessionResult& result) {
  ordered_json counts = ordered_json::object();
  for (const auto& [name, count] : result.source.counts) counts[name] = count;
  return {{"text", result.source.text}, {"counts", counts}, {"failures", result.source.failures}};
}

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
  }
  return {{"ticks_left", result.sent.ticks},
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
      text += ", none yet " + percent(tool.at("none_yet"));
    }
    rows.emplace_back("left over CAN" + whose, text + " of " + left);
    rows.emplace_back("longest unmeasured" + whose,
                      in_milliseconds(tool.at("longest_without_measurement_ms"), result));
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
    lines.emplace_back("DDS: offered, written and received samples do not add up");
  }
  const ordered_json late = source_late_part(result);
  if (!late.is_null() && late > k_source_late_max) {
    lines.push_back("source too slow: " + source_late_text(result) + "; expected at most 1 %");
  }
  for (const std::string& line : result.source.failures) lines.push_back("source: " + line);
  const bool any_pose = result.accuracy.frames > 0 ? result.accuracy.poses > 0  // by truth
                                                   : result.frames_tracked > 0;
  if (!any_pose) {
    lines.emplace_back("not one pose in the whole run: see the tools, the camera and the method");
  }
  return lines;
}

}  // namespace glint

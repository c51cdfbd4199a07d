#include "platform/cells/cell_timing.hpp"

#include <algorithm>
#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

int markers_of(const ToolSet& tools) {
  int count = 0;
  for (int t = 0; t < tools.count; ++t) {
    count += tools.items[static_cast<std::size_t>(t)].marker_count;
  }
  return count;
}

}  // namespace

void read_rates(const toml::table* table, Cell& cell) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "rates.");
  cell.realtime = reader.boolean("realtime", cell.realtime);
  cell.tick_hz = reader.real("tick_hz", cell.tick_hz, 1, 1000);
  cell.tick_release = reader.one_of("tick_release", "clock", {"clock", "estimate"}) == "estimate"
                          ? TickRelease::estimate
                          : TickRelease::clock;
  cell.workers = static_cast<int>(reader.integer("workers", cell.workers, 1, 2));
  cell.lost_after = milliseconds(reader.integer("lost_after_ms", 250, 1, 400));
  cell.actuation_delay = {
      static_cast<std::int64_t>(reader.real("actuation_delay_ms", 0, 0, 100) * 1e6)};
  reader.done();
}

// A deadline beyond the next release would require a second buffer of all data.
void read_deadlines(const toml::table* table, Cell& cell) {
  static const toml::table k_empty;
  TomlReader reader(table != nullptr ? *table : k_empty, cell.file, "deadlines.");
  const double frame_ms = cell.camera.period.seconds() * 1e3;
  const double tick_ms = 1e3 / highest_tick_hz_of(cell);
  const auto read = [&](const char* key, double otherwise, double high) {
    return from_ms(reader.real(key, otherwise, 0.001, high));
  };
  cell.deadlines.frame = read("frame_ms", frame_ms, frame_ms);
  cell.deadlines.tick = read("tick_ms", tick_ms, tick_ms);
  cell.deadlines.frame_to_can = read(
      "frame_to_can_ms", (cell.deadlines.frame + cell.deadlines.tick * 2).seconds() * 1e3, 10'000);
  reader.done();
}

void read_overrun(const toml::table* table, Cell& cell) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "overrun.");
  const auto policy = [&](const char* key, graph::OverrunPolicy otherwise) {
    const std::string name = reader.one_of(key, std::string(name_of(otherwise)),
                                           {"skip_output", "hold_last", "predict", "stop_safe"});
    auto found = graph::OverrunPolicy::skip_output;
    while (name_of(found) != name) {
      found = static_cast<graph::OverrunPolicy>(static_cast<std::uint8_t>(found) + 1);
    }
    return found;
  };
  cell.overrun.watch = reader.boolean("watch", cell.overrun.watch);
  cell.overrun.frame = policy("frame", cell.overrun.frame);
  cell.overrun.tick = policy("tick", cell.overrun.tick);
  reader.done();
}

void read_budget(const toml::table* table, Cell& cell) {
  static const toml::table k_empty;
  TomlReader reader(table != nullptr ? *table : k_empty, cell.file, "budget.");
  BudgetSettings& budget = cell.budget;
  const int listed = cell.tools.count;
  budget.tools = static_cast<int>(reader.integer("tools", listed, 1, k_tools_max));
  // As many stray reflections as markers; without a budget for them, blobs of a tool may be
  // dropped.
  const int usual = std::clamp(2 * markers_of(cell.tools), budget.blobs, k_blobs_max);
  budget.blobs = static_cast<int>(reader.integer("blobs", usual, 8, k_blobs_max));
  // All blobs in one band; a marker of 6 mm radius has eight rows at 0.3 m from an AHAT camera.
  const int usual_runs = std::clamp(8 * budget.blobs, budget.runs_per_band, k_runs_per_band_max);
  budget.runs_per_band =
      static_cast<int>(reader.integer("runs_per_band", usual_runs, 64, k_runs_per_band_max));
  budget.search_steps =
      static_cast<int>(reader.integer("search_steps", budget.search_steps, 64, k_search_steps_max));
  reader.done();
  const auto require = [&](const char* key, int value, int needed, const std::string& what) {
    if (value >= needed) return;
    throw InputError(cell.file + ":" + std::to_string(reader.line_of(key)) + ": budget." + key +
                     " is " + std::to_string(value) + ", but " + what + "; expected at least " +
                     std::to_string(needed));
  };
  require("tools", budget.tools, listed, std::to_string(listed) + " tools are listed");
  const int markers = markers_of(cell.tools);
  require("blobs", budget.blobs, markers,
          "the listed tools have " + std::to_string(markers) + " markers, one blob each");
}

}  // namespace glint

// Why a tool is, or is not, tracked in a frame: a checklist in words with the next step.
//
// The cause is found by changing one setting at a time and searching the same frame again with a
// newly started tracker: a lower threshold, farther ranges, other marker sizes, other tools. What
// finds the tool is what was wrong.
#pragma once

#include <string>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

struct CheckRow {
  std::string check;  // "brightness"
  bool holds = true;
  std::string found;      // "2 spots above 1280; with 640 the tool is found"
  std::string next_step;  // empty where it holds
};

struct ToolDiagnosis {
  std::string tool;
  bool found = false;  // by three markers or more, in this frame
  std::string cause;   // the first check that does not hold; empty: found
  std::vector<CheckRow> rows;
};

// Of each tool of the cell. `tracker` has just been activated with the frame and the head pose.
// Each tool that was not found takes at most k_trials searches of the whole frame.
inline constexpr int k_trials = 16;  // 1 + 3 + 6 + 4 + 2
[[nodiscard]] std::vector<ToolDiagnosis> diagnose(const Cell& cell, Tracker& tracker);

// Names of markers by blob, "pen 2"; empty where a blob is no tool's.
[[nodiscard]] std::vector<std::string> marker_names(const Cell& cell, Tracker& tracker);

}  // namespace glint

// Diagnosis of tracking in one frame: why a tool is tracked or not, with the next step.
//
// Finds the cause by trials: changes one setting at a time and searches the same frame again with a
// newly started tracker (other ranges, other marker sizes, lower threshold, other tools). The
// setting that finds the tool is the cause.
#pragma once

#include <string>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

struct CheckRow {
  std::string check;  // "brightness"
  bool passes = true;
  std::string found;      // "2 spots above 1280; with 640 the tool is found"
  std::string next_step;  // empty if the check holds
};

struct ToolDiagnosis {
  std::string tool;
  bool found = false;  // with three or more markers, in this frame
  std::string cause;   // the first check that fails; empty if found
  std::vector<CheckRow> rows;
};

// Diagnoses each tool of the cell. Call after `tracker` was activated with the frame and the head
// pose. Each tool that was not found takes at most k_trials full-frame searches.
inline constexpr int k_trials = 19;  // 1 + 3 + 6 + 7 + 2
[[nodiscard]] std::vector<ToolDiagnosis> diagnose(const Cell& cell, Tracker& tracker);

// Diagnoses one of the cell's tools.
[[nodiscard]] ToolDiagnosis diagnose_tool(const Cell& cell, Tracker& tracker, std::size_t tool);

// Names of markers by blob, "pen 2" with a space as separator; empty for a blob of no tool.
[[nodiscard]] std::vector<std::string> marker_names(const Cell& cell, Tracker& tracker,
                                                    const std::string& separator = " ");

// What is wrong with a refused frame: the next step.
[[nodiscard]] const char* next_step_of_refused_frame(Reason reason);
// Why spots that are visible give no pose.
[[nodiscard]] const char* mismatch_text(Reason reason);

}  // namespace glint

// Input files of a report. Each is optional; the report states which are missing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/budget/report/json_view.hpp"
#include "platform/budget/report/run_observations.hpp"

namespace glint {

struct ReportPaths {
  std::vector<std::string> measures;  // glint budget measure --json
  std::string check;                  // glint budget check --json
  std::string run_folder;             // glint run --out: summary.json, trace.spans, run.mcap
  std::string footprint;
};

struct ReportInput {
  std::string path, what, sha256;
};

struct ReportSources {
  std::vector<JsonView> measures;
  std::optional<JsonView> check, summary, footprint;
  std::optional<TraceFile> trace;
  RunObservations run;  // of the trace; empty without one
  std::string run_folder;
  std::vector<ReportInput> inputs;

  // Whether the summary is of a real-time run, whose latencies were measured by a clock.
  [[nodiscard]] bool run_was_live() const;
  // Largest frame-to-CAN latency in the run's summary, in microseconds; negative: none.
  [[nodiscard]] double observed_frame_to_can_us() const;
  // Bound for that latency: the run's own, else that of the checked chain; negative: none.
  [[nodiscard]] double bound_frame_to_can_us() const;
  [[nodiscard]] std::vector<std::string> best_effort() const;
};

// Throws InputError if a file cannot be read or is of another kind, or if no file is given.
[[nodiscard]] ReportSources read_sources(const ReportPaths& paths);

}  // namespace glint

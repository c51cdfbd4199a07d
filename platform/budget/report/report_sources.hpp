// The files a report is made of. Each may be absent; what it would have shown is then said to be
// not given.
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

  // A summary of a run that kept real time: a clock measured its latencies.
  [[nodiscard]] bool run_was_live() const;
  // The largest frame to CAN that the run's summary saw, in microseconds; negative: none.
  [[nodiscard]] double observed_frame_to_can_us() const;
  // What it is held against: the run's own bound, else the checked chain of that name; negative:
  // none.
  [[nodiscard]] double bound_frame_to_can_us() const;
  [[nodiscard]] std::vector<std::string> best_effort() const;
};

// Throws InputError where a file cannot be read or is another, or where none is given.
[[nodiscard]] ReportSources read_sources(const ReportPaths& paths);

}  // namespace glint

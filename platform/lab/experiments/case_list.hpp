// Results of an experiment: a list of cases, each with figures and their acceptance bars.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "platform/shards/sharded_work.hpp"

namespace glint {

// Acceptance limit of a figure. Figures of a baseline have none.
struct Bar {
  enum class Kind { none, at_most, at_least };
  Kind kind = Kind::none;
  double limit = 0;
  static constexpr Bar none() { return {}; }
  static constexpr Bar at_most(double limit) { return {Kind::at_most, limit}; }
  static constexpr Bar at_least(double limit) { return {Kind::at_least, limit}; }
  // NaN meets no limit.
  [[nodiscard]] constexpr bool met_by(double value) const {
    if (kind == Kind::none) return true;
    return kind == Kind::at_most ? value <= limit : value >= limit;
  }
};

struct Figure {
  std::string name;  // "tip_rms"
  std::string unit;  // "mm"; empty for a ratio or a count
  double value = 0;
  Bar bar = Bar::none();
};

struct ExperimentCase {
  std::string name;    // "8700339 at 0.5 m, 3 mm"
  std::string method;  // "glint", "svd", "baseline", ...
  std::int64_t n = 0;  // number of samples
  std::vector<Figure> figures;
};

struct PlotFile {
  std::string path, svg;
};

struct CaseList {
  std::string experiment;
  std::vector<ExperimentCase> cases;
  std::vector<PlotFile> plots;
};

struct CaseOptions {
  bool quick = false;       // smoke test of a few seconds; without the bars that need more samples
  std::uint64_t seed = 1;   // random seed
  std::string out = "out";  // existing folder for plots and finished tries
  std::string data;         // folder of recordings; empty if not given
  // Called from time to time with the samples done and in total; may be empty.
  std::function<void(int done, int total)> progress;
  int tries = 0;  // for experiments with --tries; 0: their other cases
  Pieces piece;   // runs each repetition
};

// Returns the number of figures that miss their bar.
[[nodiscard]] int missed_bars(const CaseList& list);

// Returns a table with a row per case. A judged figure has "<=" or ">=" and its bar, and "MISSED"
// if it misses the bar.
[[nodiscard]] std::string case_table(const CaseList& list);

// Returns {"experiment", "config_hash", "quick", "missed", "cases": [{"case", "method", "n",
// "figures": {name: {"value", "unit", "bar", "met"}}}]}; "bar" is {"at_most": x}, {"at_least": x}
// or null.
[[nodiscard]] std::string case_json(const CaseList& list, const CaseOptions& options);

}  // namespace glint

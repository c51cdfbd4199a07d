// What an experiment found: a list of cases, each with its figures and the bars they are held to.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint {

// What a figure is held to. Figures of a baseline have none.
struct Bar {
  enum class Kind { none, at_most, at_least };
  Kind kind = Kind::none;
  double limit = 0;
  static constexpr Bar none() { return {}; }
  static constexpr Bar at_most(double limit) { return {Kind::at_most, limit}; }
  static constexpr Bar at_least(double limit) { return {Kind::at_least, limit}; }
  // A value that is not finite meets no bar.
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
  std::string method;  // "glint", "svd", "seed", ...
  std::int64_t n = 0;  // samples behind the figures
  std::vector<Figure> figures;
};

struct CaseList {
  std::string experiment;
  std::vector<ExperimentCase> cases;
  std::vector<std::string> plots;  // files written
};

struct CaseOptions {
  bool quick = false;       // a few seconds: to see that it works; bars that need more are left out
  std::uint64_t seed = 1;   // of the random numbers
  std::string out = "out";  // folder of the plots; it exists
  std::string data;         // folder of recordings; empty: none given
  // Called now and then with samples done and in all; may be empty.
  std::function<void(int done, int total)> progress;
  int tries = 0;  // of an experiment that counts tries; 0: its other cases
};

// Figures that miss their bar.
[[nodiscard]] int missed_bars(const CaseList& list);

// A table for people: a row a case, "<=" or ">=" and the bar behind each judged figure, "MISSED"
// where it is missed.
[[nodiscard]] std::string case_table(const CaseList& list);

// {"experiment", "config_hash", "quick", "missed", "cases": [{"case", "method", "n", "figures":
// {name: {"value", "unit", "bar", "met"}}}]}; "bar" is {"at_most": x}, {"at_least": x} or null.
[[nodiscard]] std::string case_json(const CaseList& list, const CaseOptions& options);

}  // namespace glint

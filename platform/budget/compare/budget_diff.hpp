// What changed between two measurements or two runs, told from noise.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace glint {

enum class Change { same, faster, slower, not_shown };

struct DiffRow {
  std::string name;  // kernel, or group and node
  std::string what;  // bound, largest, median
  double before = 0, after = 0;
  double low = 1, high = 1;  // of after / before; both the ratio itself where counts are exact
  double p = 1;              // of no difference; 0 or 1 where counts are exact
  Change change = Change::same;
  bool worse_beyond = false;  // than the tolerance, for certain
};

struct DiffSettings {
  double tolerance_percent = 0;  // how much slower is still accepted
  double confidence = 0.99;      // of all rows together: each is judged at its share of the rest
  int resamples = 1000;
};

struct BudgetDiff {
  std::string unit;
  bool exact = false;  // instruction counts: any difference is one
  double row_confidence = 1;
  std::vector<DiffRow> rows;
  std::vector<std::string> only_before, only_after;
  [[nodiscard]] bool worse() const;
};

// Two files of glint budget measure --json, two trace.spans, or two folders with one. Throws
// InputError where the two cannot be compared.
[[nodiscard]] BudgetDiff budget_diff(const std::string& before, const std::string& after,
                                     const DiffSettings& settings);

[[nodiscard]] std::string name_of(Change change);
[[nodiscard]] nlohmann::ordered_json as_json(const BudgetDiff& diff);

}  // namespace glint

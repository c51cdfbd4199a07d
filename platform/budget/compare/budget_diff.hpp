// Statistical comparison of two measurements or two runs: significant changes of costs or times.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace glint {

enum class Change { same, faster, slower, not_significant };

struct DiffRow {
  std::string name;  // kernel, or group and node
  std::string what;  // bound, largest, median
  double before = 0, after = 0;
  double low = 1, high = 1;  // interval of after / before; exact counts: the ratio
  double p = 1;              // of no difference; exact counts: 0 or 1
  Change change = Change::same;
  bool significantly_slower = false;  // slower than the tolerance, significantly
};

struct DiffSettings {
  double tolerance_percent = 0;  // accepted slowdown
  double confidence = 0.99;      // joint for all rows
  int resamples = 1000;
};

struct BudgetDiff {
  std::string unit;
  bool exact = false;  // instruction counts: any difference is significant
  double row_confidence = 1;
  std::vector<DiffRow> rows;
  std::vector<std::string> only_before, only_after;
  [[nodiscard]] bool worse() const;
};

// Compares two files of glint budget measure --json, two trace.spans, or two folders with one.
// Throws InputError if they are not comparable.
[[nodiscard]] BudgetDiff budget_diff(const std::string& before, const std::string& after,
                                     const DiffSettings& settings);

[[nodiscard]] std::string name_of(Change change);
[[nodiscard]] nlohmann::ordered_json as_json(const BudgetDiff& diff);

}  // namespace glint

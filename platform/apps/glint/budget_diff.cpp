// glint budget diff: significant changes between two measurements or runs.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/compare/budget_diff.hpp"
#include "platform/in_range.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

struct DiffArguments {
  std::string before, after, json;
  DiffSettings settings;
};

int print_diff(const DiffArguments& arguments) {
  const BudgetDiff diff = budget_diff(arguments.before, arguments.after, arguments.settings);
  std::printf("%-28s %-8s %14s %14s  %-19s %s\n", "", printable(diff.unit).c_str(), "before",
              "after", diff.exact ? "ratio" : "ratio, interval", "");
  for (const DiffRow& row : diff.rows) {
    char ratio[48];
    if (row.low == row.high) {
      std::snprintf(ratio, sizeof ratio, "%.4f", row.low);
    } else {
      std::snprintf(ratio, sizeof ratio, "%.4f to %.4f", row.low, row.high);
    }
    std::printf("%-28s %-8s %14.3f %14.3f  %-19s %s%s\n", printable(row.name).c_str(),
                printable(row.what).c_str(), row.before, row.after, ratio,
                name_of(row.change).c_str(),
                row.significantly_slower ? ", beyond the tolerance" : "");
  }
  for (const std::string& name : diff.only_before)
    std::printf("only before: %s\n", printable(name).c_str());
  for (const std::string& name : diff.only_after)
    std::printf("only after: %s\n", printable(name).c_str());
  if (diff.exact) {
    std::printf("instruction counts: every difference is real\n");
  } else {
    std::printf(
        "slower or faster: both the Mann-Whitney test and the interval of the medians' ratio "
        "agree, at %.3g %% a row, %.3g %% for all rows together\n",
        100 * diff.row_confidence, 100 * arguments.settings.confidence);
  }
  write_json(arguments.json, as_json(diff));
  return diff.worse() ? 1 : 0;
}

}  // namespace

void add_budget_diff(CLI::App& budget, int& exit_code) {
  CLI::App* command = budget.add_subcommand(
      "diff", "Compare two measurements: which node or kernel became slower beyond noise");
  auto arguments = std::make_shared<DiffArguments>();
  command->footer(
      "Examples: glint budget diff before.json after.json\n"
      "  glint budget diff out_before out_after --tolerance 5\n"
      "Exit 1: a row is significantly slower by more than the tolerance.");
  command->add_option("before", arguments->before, "measurement, run folder or trace.spans")
      ->required();
  command->add_option("after", arguments->after, "second measurement, of the same kind")
      ->required();
  command->add_option("--tolerance", arguments->settings.tolerance_percent, "accepted slowdown, %")
      ->capture_default_str()
      ->check(in_range(0.0, 1000.0));
  command
      ->add_option("--confidence", arguments->settings.confidence,
                   "probability of no false \"slower\" in any row")
      ->capture_default_str()
      ->check(in_range(0.5, 0.9999));
  command->add_option("--json", arguments->json, "file of the table's figures");
  command->callback([arguments, &exit_code] { exit_code = print_diff(*arguments); });
}

}  // namespace glint

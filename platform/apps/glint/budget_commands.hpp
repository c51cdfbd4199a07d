// Subcommands of `glint budget`. Each adds itself to `budget` and stores its exit code.
#pragma once

#include <CLI/CLI.hpp>

#include "platform/shards/sharded_work.hpp"

namespace glint {

void add_budget_measure(CLI::App& budget, int& exit_code, ShardedWork& work);
void add_budget_curve(CLI::App& budget, int& exit_code);
void add_budget_prove(CLI::App& budget, int& exit_code);
void add_budget_schedule(CLI::App& budget, int& exit_code);
void add_budget_check(CLI::App& budget, int& exit_code);
void add_budget_report(CLI::App& budget, int& exit_code);
void add_budget_diff(CLI::App& budget, int& exit_code);
void add_budget_export(CLI::App& budget, int& exit_code);

}  // namespace glint

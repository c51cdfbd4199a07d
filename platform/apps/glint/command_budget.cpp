#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/commands.hpp"

namespace glint {

void add_budget(CLI::App& app, int& exit_code, ShardedWork& work) {
  CLI::App* budget =
      app.add_subcommand("budget", "Measure costs; compute, check and report latency bounds");
  budget->require_subcommand(1);
  budget->footer("Example: glint budget schedule --board x86-64-emulated --out plan.toml");
  add_budget_measure(*budget, exit_code, work);
  add_budget_curve(*budget, exit_code);
  add_budget_prove(*budget, exit_code);
  add_budget_schedule(*budget, exit_code);
  add_budget_check(*budget, exit_code);
  add_budget_report(*budget, exit_code);
  add_budget_diff(*budget, exit_code);
  add_budget_export(*budget, exit_code);
}

}  // namespace glint

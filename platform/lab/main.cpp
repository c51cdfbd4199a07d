// glint_lab COMMAND: the experiments, and runs of the baseline method. `glint` starts it.
#include <memory>
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/run_commands.hpp"
#include "platform/apps/glint/shard_option.hpp"
#include "platform/apps/version/version.hpp"
#include "platform/exit_code.hpp"
#include "platform/lab/baseline/baseline_method.hpp"
#include "platform/lab/command_experiment.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Glint's lab: experiments, and the published method instead of the tracker"};
  app.require_subcommand(1);
  app.set_version_flag("--version", glint::version_text(), "version and commit");
  app.footer("Example: glint experiment static --json static.json");
  int exit_code = 0;
  glint::ShardedWork work({argv + 1, argv + argc});
  std::vector<std::string> merged;
  const auto baseline = [](const glint::Cell& cell) {
    return std::make_unique<glint::BaselineMethod>(cell);
  };
  glint::add_run(app, exit_code, baseline);
  glint::add_track(app, exit_code, work, baseline);
  glint::add_experiment(app, exit_code, work);
  glint::add_merge(app, work, merged);
  glint::add_cell_check(app);
  return glint::exit_code_of(app, "glint", [&] {
    glint::parse_command(app, argc, argv, merged);
    return exit_code;
  });
}

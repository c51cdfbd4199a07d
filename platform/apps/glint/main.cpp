// glint COMMAND: main program of the tracker and its tools.
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/lab_program.hpp"
#include "platform/apps/glint/run_commands.hpp"
#include "platform/apps/glint/shard_option.hpp"
#include "platform/apps/version/version.hpp"
#include "platform/exit_code.hpp"

namespace {

// The words after `experiment` are glint_lab's, --help among them.
void add_experiment(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "experiment",
      "Run an experiment: errors of the estimates, beside the published method and others");
  command->prefix_command();
  command->set_help_flag();
  command->callback([] { glint::start_lab(); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Glint: the pose of a pen with reflective markers, from a headset's camera"};
  app.require_subcommand(1);
  app.set_version_flag("--version", glint::version_text(), "version and commit");
  app.footer("Example: glint run --out out --json out/summary.json");
  int exit_code = 0;
  glint::ShardedWork work({argv + 1, argv + argc});
  std::vector<std::string> merged;
  glint::add_run(app, exit_code);
  glint::add_track(app, exit_code, work);
  glint::add_replay(app, exit_code);
  glint::add_simulate(app, exit_code);
  add_experiment(app);
  glint::add_calibrate(app, exit_code);
  glint::add_verify(app, exit_code);
  glint::add_map(app, exit_code);
  glint::add_reference(app, exit_code);
  glint::add_path(app, exit_code);
  glint::add_inspect(app, exit_code);
  glint::add_can(app, exit_code);
  glint::add_dds(app, exit_code);
  glint::add_export(app, exit_code);
  glint::add_budget(app, exit_code, work);
  glint::add_merge(app, work, merged);
  glint::add_cell_check(app);
  return glint::exit_code_of(app, "glint", [&] {
    glint::parse_command(app, argc, argv, merged);
    return exit_code;
  });
}

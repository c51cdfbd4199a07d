// glint experiment: the published method's experiments, with its figures beside Glint's.
#include <cstdio>
#include <memory>
#include <string>

#include "platform/cli/commands.hpp"
#include "platform/cli/output_file.hpp"
#include "platform/cli/progress.hpp"
#include "platform/experiments/experiment.hpp"
#include "platform/experiments/experiment_report.hpp"

namespace glint {
namespace {

struct ExperimentArguments {
  std::string json, out = "out";
  bool quick = false;
  std::uint64_t seed = 1;
};

int run_one(ExperimentKind kind, const ExperimentArguments& arguments) {
  Progress progress("experiment " + name_of(kind));
  ExperimentOptions options;
  options.quick = arguments.quick;
  options.seed = arguments.seed;
  options.progress = [&](int done, int all) { progress.show(done, all); };
  const ExperimentResult result =
      kind == ExperimentKind::still ? run_static(options) : run_dynamic(options);
  std::fputs(experiment_table(result).c_str(), stdout);
  if (!arguments.json.empty()) write_text(arguments.json, experiment_json(result));
  make_folder(arguments.out);
  for (const std::string& file : write_experiment_plots(result, arguments.out)) {
    std::printf("written  %s\n", file.c_str());
  }
  return 0;
}

void add_kind(CLI::App& command, const char* name, const char* what, ExperimentKind kind,
              const std::shared_ptr<ExperimentArguments>& arguments, int& exit_code) {
  CLI::App* sub = command.add_subcommand(name, what);
  sub->add_flag("--quick", arguments->quick, "a tenth of the frames: to see that it works");
  sub->add_option("--seed", arguments->seed, "of the simulator")->capture_default_str();
  sub->add_option("--json", arguments->json, "write the figures here");
  sub->add_option("--out", arguments->out, "folder of the plots")->capture_default_str();
  sub->footer(std::string("Example: glint experiment ") + name + " --json " + name + ".json");
  sub->callback([kind, arguments, &exit_code] { exit_code = run_one(kind, *arguments); });
}

}  // namespace

void add_experiment(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "experiment", "The published method and Glint on the same simulated frames");
  command->require_subcommand(1);
  command->footer("Example: glint experiment static --json static.json");
  auto arguments = std::make_shared<ExperimentArguments>();
  add_kind(*command, "static", "headset and pen still, an arm's length apart",
           ExperimentKind::still, arguments, exit_code);
  add_kind(*command, "dynamic", "headset and pen both moving", ExperimentKind::moving, arguments,
           exit_code);
}

}  // namespace glint

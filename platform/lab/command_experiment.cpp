// glint experiment: accuracy of the estimates, case by case, compared with the baseline.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/apps/glint/shard_option.hpp"
#include "platform/in_range.hpp"
#include "platform/lab/command_experiment.hpp"
#include "platform/lab/experiments/case_experiments.hpp"
#include "platform/lab/experiments/experiment.hpp"
#include "platform/lab/experiments/experiment_report.hpp"
#include "platform/printable.hpp"
#include "platform/shards/sharded_work.hpp"

namespace glint {
namespace {

struct ExperimentArguments {
  std::string json, out = "out", data;
  bool quick = false;
  std::uint64_t seed = 1;
  int tries = 0;
};
using Arguments = std::shared_ptr<ExperimentArguments>;

int run_published(ExperimentKind kind, const ExperimentArguments& arguments, ShardedWork& work) {
  Progress progress("experiment " + name_of(kind));
  ExperimentOptions options;
  options.quick = arguments.quick;
  options.seed = arguments.seed;
  options.piece = {&work};
  options.progress = [&](int done, int all) { progress.show(done, all); };
  const ExperimentResult result =
      kind == ExperimentKind::still ? run_static(options) : run_dynamic(options);
  progress.clear();
  if (work.finish()) return 0;
  std::fputs(printable_lines(experiment_table(result)).c_str(), stdout);
  if (!arguments.json.empty()) write_text(arguments.json, experiment_json(result));
  make_folder(arguments.out);
  for (const std::string& file : write_experiment_plots(result, arguments.out)) {
    std::printf("written  %s\n", file.c_str());
  }
  // A tenth of the frames is a smoke test.
  return options.quick || missed_bars(result) == 0 ? 0 : 1;
}

int run_cases(const CaseExperiment& experiment, const ExperimentArguments& arguments,
              ShardedWork& work) {
  Progress progress(std::string("experiment ") + experiment.name);
  CaseOptions options{arguments.quick,
                      arguments.seed,
                      arguments.out,
                      arguments.data,
                      [&](int done, int all) { progress.show(done, all); },
                      arguments.tries,
                      {&work}};
  make_folder(options.out);
  const CaseList list = experiment.run(options);
  progress.clear();
  if (work.finish()) return 0;
  std::fputs(printable_lines(case_table(list)).c_str(), stdout);
  if (!arguments.json.empty()) write_text(arguments.json, case_json(list, options));
  for (const PlotFile& plot : list.plots) {
    write_text(plot.path, plot.svg);
    std::printf("written  %s\n", plot.path.c_str());
  }
  return missed_bars(list) == 0 ? 0 : 1;
}

CLI::App& add_one(CLI::App& command, const std::string& name, const char* what,
                  const Arguments& arguments, ShardedWork& work) {
  CLI::App* sub = command.add_subcommand(name, what);
  sub->add_flag("--quick", arguments->quick, "few samples, as a short test");
  sub->add_option("--random-seed,--seed", arguments->seed, "start of the random numbers")
      ->capture_default_str();
  sub->add_option("--json", arguments->json, "file of the figures");
  sub->add_option("--out", arguments->out, "folder of the plots")->capture_default_str();
  add_shard_option(*sub, work);
  sub->footer("Example: glint experiment " + name + " --json " + name + ".json");
  return *sub;
}

void add_published(CLI::App& command, const char* name, const char* what, ExperimentKind kind,
                   const Arguments& arguments, int& exit_code, ShardedWork& work) {
  add_one(command, name, what, arguments, work).callback([kind, arguments, &exit_code, &work] {
    exit_code = run_published(kind, *arguments, work);
  });
}

}  // namespace

void add_experiment(CLI::App& app, int& exit_code, ShardedWork& work) {
  CLI::App* command = app.add_subcommand(
      "experiment",
      "Run an experiment: errors of the estimates, beside the published method and others");
  command->require_subcommand(1);
  command->footer(
      "Example: glint experiment static --json static.json\n"
      "Exit: 0 all bars met (or none defined), 1 a bar missed, 2 bad use.");
  auto arguments = std::make_shared<ExperimentArguments>();
  add_published(*command, "static", "headset and pen still, an arm's length apart",
                ExperimentKind::still, arguments, exit_code, work);
  add_published(*command, "dynamic", "headset and pen both moving", ExperimentKind::moving,
                arguments, exit_code, work);
  for (const CaseExperiment& experiment : case_experiments()) {
    CLI::App& sub = add_one(*command, experiment.name, experiment.what, arguments, work);
    if (experiment.data == DataFolder::optional) {
      sub.add_option("--data", arguments->data,
                     "folder of the recordings; adds a real frame as background");
    }
    if (experiment.data == DataFolder::required) {
      sub.add_option("--data", arguments->data, "folder of the recordings")->required();
      sub.footer(std::string("Example: glint experiment ") + experiment.name + " --data DIR");
    }
    if (experiment.accepts_tries) {
      sub.add_option("--tries", arguments->tries,
                     "total tries of all classes (field: devices) instead of the other cases; "
                     "--out stores finished tries")
          ->check(in_range(1, 1'000'000));
    }
    sub.callback([&experiment, arguments, &exit_code, &work] {
      exit_code = run_cases(experiment, *arguments, work);
    });
  }
}

}  // namespace glint

// glint budget report: timing report with bounds, estimates and observations, as HTML and Markdown.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/report/budget_report.hpp"
#include "platform/in_range.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

struct ReportArguments {
  ReportPaths paths;
  std::string out = "report";
  ReportOptions options;
};

int write_report(const ReportArguments& arguments) {
  const ReportSources sources = read_sources(arguments.paths);
  const Document document = budget_report(sources, arguments.options);
  const std::filesystem::path folder(arguments.out);
  write_text((folder / "budget.html").string(), html_of(document));
  write_text((folder / "budget.md").string(), markdown_of(document));
  for (const Illustration& figure : figures_of(document)) {
    write_text((folder / "figures" / (figure.name + ".svg")).string(), standalone_svg(figure));
  }
  std::printf("%s: %s\n", name_of(document.verdict).c_str(),
              printable(document.verdict_text).c_str());
  for (const Headline& headline : document.headlines) {
    std::printf("  %-10s %-16s %s\n", name_of(headline.kind).c_str(),
                printable(headline.value).c_str(), printable(headline.what).c_str());
  }
  for (const Sentence& reason : document.reasons)
    std::printf("  %s\n", printable(reason.text).c_str());
  std::printf("written    %s\n", (folder / "budget.html").string().c_str());
  return document.verdict == Verdict::fails || document.verdict == Verdict::invalid_bound ? 1 : 0;
}

}  // namespace

void add_budget_report(CLI::App& budget, int& exit_code) {
  CLI::App* command =
      budget.add_subcommand("report", "Write bounds, estimates and observations to one page");
  auto arguments = std::make_shared<ReportArguments>();
  command->footer(
      "Example: glint budget report --measure costs.json --check check.json --run out --out "
      "report\n"
      "Exit 1: a bound above its deadline, or an observation above its bound.");
  command->add_option("--measure", arguments->paths.measures,
                      "files of `glint budget measure --json`");
  command->add_option("--check", arguments->paths.check, "file of `glint budget check --json`");
  command->add_option("--run", arguments->paths.run_folder,
                      "folder of `glint run --out`: summary.json and trace.spans");
  command->add_option("--footprint", arguments->paths.footprint, "memory, stack and code by node");
  command
      ->add_option("--worst", arguments->options.worst_frames, "number of worst frames in the list")
      ->capture_default_str()
      ->check(in_range(1, 1000));
  command->add_option("--out", arguments->out, "folder of budget.html, budget.md and figures/")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = write_report(*arguments); });
}

}  // namespace glint

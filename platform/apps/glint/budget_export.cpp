// glint budget export: conversion of a run's trace for other programs.
#include <cstdio>
#include <memory>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/export/trace_export.hpp"

namespace glint {
namespace {

struct ExportArguments {
  std::string trace, format = "perfetto", out;
  std::uint32_t frame = 0;  // 0: all frames
};

int export_trace(const ExportArguments& arguments) {
  TraceFile trace = read_trace(arguments.trace);
  if (arguments.frame > 0) trace = around_frame(trace, arguments.frame);
  write_text(arguments.out, exported(trace, trace_format_of(arguments.format)));
  std::printf("%zu spans of %zu groups as %s: %s\n", trace.spans.size(), trace.groups.size(),
              arguments.format.c_str(), arguments.out.c_str());
  return 0;
}

}  // namespace

void add_budget_export(CLI::App& budget, int& exit_code) {
  CLI::App* command =
      budget.add_subcommand("export", "Export a run's trace as Perfetto, Chrome JSON, BTF or CSV");
  auto arguments = std::make_shared<ExportArguments>();
  command->footer(
      "Example: glint budget export --trace out/trace.spans --format perfetto --out run.pftrace\n"
      "perfetto: ui.perfetto.dev; chrome: chrome://tracing; btf: Trace Compass, APP4MC.");
  command->add_option("--trace", arguments->trace, "trace.spans of `glint run --trace`")
      ->required();
  command->add_option("--format", arguments->format, "perfetto, chrome, btf or csv")
      ->capture_default_str();
  command->add_option("--frame", arguments->frame, "only the spans near this frame");
  command->add_option("--out", arguments->out, "output file")->required();
  command->callback([arguments, &exit_code] { exit_code = export_trace(*arguments); });
}

}  // namespace glint

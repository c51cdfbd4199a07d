// glint verify: test of the stated uncertainty by touches of two points and a rest.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "kernels/angles.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/in_range.hpp"
#include "platform/printable.hpp"
#include "platform/tools/calibrate/calibration_report.hpp"
#include "platform/tools/verify/verification.hpp"

namespace glint {
namespace {

struct VerifyArguments {
  std::string recording, config, tool, json;
  double distance_mm = 0, distance_sigma_mm = 0.1;
};

Figures figures_for(const Check& check) {
  return {{"measured_mm", 1e3 * check.measured_m},
          {"stated_sigma_mm", 1e3 * check.stated_m},
          {"probability", check.probability},
          {"agrees", check.agrees}};
}

Figures figures_for(const CalibrationFinding& finding) {
  const ErrorUnit unit = unit_of(finding.source);
  return {{"estimate", unit.per_base * finding.estimate},
          {"sigma", unit.per_base * finding.sigma},
          {"unit", unit.text},
          {"shown", finding.axes > 0},
          {"stated_sigmas", finding.size_in_stated_sigmas},
          {"agrees", !finding.exceeds_stated}};
}

Figures figures_for(const TipSeries& series, const Verification& found,
                    const VerifyArguments& arguments) {
  Figures figures = {{"source", series.what},
                     {"frame", series.in_world ? "world" : "camera"},
                     {"frames", series.frames},
                     {"frames_with_tool", series.observations.size()},
                     {"frames_refused", series.rejected},
                     {"touches_of_first_point", found.first_touches},
                     {"touches_of_second_point", found.second_touches},
                     {"other_holds", found.other_holds},
                     {"lean_rms_deg", figures_of(found.spread_rad, k_degrees_per_radian)},
                     {"rest_s", found.rest_s}};
  if (found.missing.empty()) {
    figures["range_mm"] = 1e3 * found.range_m;
    figures["distance_mm"] = 1e3 * found.distance_m;
    figures["known_distance_mm"] = arguments.distance_mm;
    figures["repeatability"] = figures_for(found.repeatability);
    figures["scale"] = figures_for(found.scale);
    figures["rest"] = figures_for(found.rest);
  } else {
    figures["not_judged"] = found.missing;
  }
  for (const CalibrationFinding& finding : found.calibration)
    figures[std::string(name_of(finding.source))] = figures_for(finding);
  figures["verdict"] = {{"agrees", found.agrees},
                        {"confidence", k_confidence},
                        {"probability_min", found.level},
                        {"not_shown", not_covered(found)}};
  return figures;
}

void row(const char* name, const std::string& value) {
  std::printf("  %-26s %s\n", name, printable(value).c_str());
}

std::string check_text(const Check& check) {
  char text[96];
  std::snprintf(text, sizeof text, "%.2f mm, stated sigma %.2f mm, probability %.4f%s",
                1e3 * check.measured_m, 1e3 * check.stated_m, check.probability,
                check.agrees ? "" : "  DOES NOT AGREE");
  return text;
}

void print(const Figures& figures, const Verification& found) {
  Figures above = figures;
  for (auto it = above.begin(); it != above.end();)
    it = it->is_object() ? above.erase(it) : std::next(it);
  std::fputs(printable_lines(figures_table(above)).c_str(), stdout);
  if (found.missing.empty()) {
    row("repeatability, rms", check_text(found.repeatability));
    row("scale, distance error", check_text(found.scale));
    row("rest, rms", check_text(found.rest));
  }
  for (const CalibrationFinding& finding : found.calibration) {
    if (finding.axes == 0) continue;
    row(finding.exceeds_stated ? "CALIBRATION" : "calibration", text_of(finding));
  }
  row("verdict", found.agrees ? "agrees with the stated uncertainty (95 %)"
                              : "DOES NOT AGREE with the stated uncertainty (95 %)");
  for (const std::string& line : not_covered(found)) row("not shown", line);
}

int run_verify(const VerifyArguments& arguments) {
  RecordedFrames recorded = open_recorded(arguments.recording, arguments.config);
  const std::size_t tool = select_tool(recorded.cell, arguments.tool);
  const TipSeries series = observe_tips(recorded, tool);
  const Verification found =
      verify_touches(series, {1e-3 * arguments.distance_mm, 1e-3 * arguments.distance_sigma_mm});
  const Figures figures = figures_for(series, found, arguments);
  print(figures, found);
  write_json(arguments.json, figures);
  return std::max(report_losses(series.failures), found.agrees ? 0 : 1);
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify", "Check the stated uncertainty without a reference: touch two known points");
  auto arguments = std::make_shared<VerifyArguments>();
  command->footer(
      "Example: glint verify --recording out/run.mcap --distance-mm 200 --json verify.json\n"
      "Record: touch one point ten times or more, a second one at the known distance five times,\n"
      "three seconds each. Lean the tool to another side at each touch, and look from another\n"
      "place, near and far. Then hold the tool still for 20 s. `verify` detects touches and rest.\n"
      "It tests repeatability, scale, rest, and each observable calibration error against the\n"
      "cell's stated values, all together at 95 %. `not shown`: not observable.\n"
      "Exit: 0 agreement, 1 no agreement, 2 bad use, or no touches or rest in the recording.");
  command
      ->add_option("--recording", arguments->recording,
                   "recorded frames (any kind that `glint track` reads)")
      ->required();
  add_cell_option(*command, arguments->config,
                  "cell file of the camera; default: the recording's own, else the built-in cell");
  command->add_option("--tool", arguments->tool, "tool of the cell; default: the first");
  command->add_option("--distance-mm", arguments->distance_mm, "known distance of the two points")
      ->required()
      ->check(in_range(50.0, 1000.0));
  command
      ->add_option("--distance-sigma-mm", arguments->distance_sigma_mm,
                   "standard deviation of that distance")
      ->capture_default_str()
      ->check(in_range(0.0, 10.0));
  command->add_option("--json", arguments->json, "file of the figures");
  command->callback([arguments, &exit_code] { exit_code = run_verify(*arguments); });
}

}  // namespace glint

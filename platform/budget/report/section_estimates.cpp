// Report section of extreme-value estimates, or of the reasons why they do not apply.
#include <cstdio>

#include "platform/budget/report/figures.hpp"
#include "platform/budget/report/sections.hpp"

namespace glint {
namespace {

std::string p_text(double p) {
  char text[32];
  std::snprintf(text, sizeof text, p == 0 ? "0" : p < 1e-3 ? "%.1e" : "%.3f", p);
  return text;
}

void add_series(const std::string& what, const std::vector<double>& series,
                const ExtremeSettings& settings, Table& levels, Table& tests, FigureGrid& grid) {
  const ExtremeEstimate estimates[] = {estimate_by_maxima(series, settings),
                                       estimate_by_exceedances(series, settings)};
  int number = 0;
  for (const ExtremeEstimate& estimate : estimates) {
    ++number;
    const std::string name = number == 1 ? "block maxima" : "peaks over threshold";
    levels.rows.push_back(
        {{what},
         {name},
         {count_text(static_cast<double>(estimate.values))},
         {estimate.applicable ? us_text(estimate.level) : "not applicable"},
         {estimate.applicable ? us_text(estimate.low) + " to " + us_text(estimate.high) : "-"},
         {estimate.applicable ? "fitted on " + std::to_string(estimate.fitted) + ", verified on " +
                                    std::to_string(estimate.verified) + " extremes; shape " +
                                    us_text(estimate.distribution.shape)
                              : "not applicable: " + estimate.reason}});
    // Tests of the assumptions are of the series, and therefore the same for both methods.
    const std::size_t first = number == 1 ? 0 : std::min<std::size_t>(4, estimate.tests.size());
    for (std::size_t i = first; i < estimate.tests.size(); ++i) {
      const TestResult& test = estimate.tests[i];
      tests.rows.push_back(
          {{what},
           {i < 4 ? "both" : name},
           {test.name},
           {test.assumption},
           {p_text(test.p)},
           {test.passed ? "passes" : "refused", test.passed ? Tone::good : Tone::bad}});
    }
    if (estimate.applicable) {
      grid.figures.push_back(quantile_figure("quantiles-" + std::to_string(grid.figures.size()),
                                             what + ", " + name, estimate));
    }
  }
}

}  // namespace

Section estimates_section(const ReportSources& sources) {
  Section section{"estimates", "Estimates beyond the observed values", {}};
  if (!sources.trace) {
    section.blocks.push_back(
        missing_input("--run DIR", "glint run --out DIR --json DIR/summary.json"));
    return section;
  }
  const ExtremeSettings settings;
  char exceedance[32];
  std::snprintf(exceedance, sizeof exceedance, "%g", settings.exceedance);
  Table levels{"In \u00b5s: the time that an activation exceeds with probability " +
                   std::string(exceedance) +
                   ", extrapolated under the assumption that future values have the distribution "
                   "of the observed ones.",
               {{"Series"},
                {"Method"},
                {"n", NumberKind::none, true},
                {"Level", NumberKind::estimate, true},
                {"95 % interval", NumberKind::estimate, true},
                {"Grounds"}},
               {}};
  Table tests{
      "Each assumption is tested twice at level " + p_text(settings.significance) +
          "; one rejection suffices. The fit uses the first half of the run and is validated on "
          "the second.",
      {{"Series"}, {"Method"}, {"Test"}, {"Assumption"}, {"p", NumberKind::none, true}, {"Result"}},
      {}};
  FigureGrid grid;
  for (std::size_t g = 0; g < sources.trace->groups.size(); ++g) {
    std::vector<double> series;
    for (const Activation& a : sources.run.groups[g]) series.push_back(a.response_us());
    if (series.empty()) continue;
    add_series(sources.trace->groups[g].name + " response", series, settings, levels, tests, grid);
  }
  std::vector<double> to_can;
  for (const FrameLatency& frame : sources.run.frames) to_can.push_back(frame.us);
  if (!to_can.empty()) add_series("frame to CAN", to_can, settings, levels, tests, grid);
  section.blocks.push_back(levels);
  if (!grid.figures.empty()) {
    section.blocks.push_back(
        Sentence{"The validation half over the fit's quantiles. Points on the line: both agree."});
    section.blocks.push_back(grid);
  }
  if (!tests.rows.empty()) section.blocks.push_back(tests);
  return section;
}

}  // namespace glint

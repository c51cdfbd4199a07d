// Report sections from measurements: loop counts against declared maxima, cost envelopes,
// interference, and memory of the nodes.
#include <algorithm>

#include "platform/budget/report/sections.hpp"

namespace glint {
namespace {

const char* k_measure_command = "glint budget measure --json F";

std::string conditions_of(const JsonView& measure) {
  return measure.text_or("arch", "?") + ", " + measure.text_or("count", "?") + ", " +
         measure.text_or("cache", "?") + " cache, board " + measure.text_or("board", "none");
}

std::string unit_of(const JsonView& measure) { return measure.text_or("unit", "?"); }

std::string worst_input_of(const JsonView& kernel) {
  if (!kernel.has("worst_input")) return "-";
  const JsonView input = kernel.at("worst_input");
  return input.text_or("kind", "?") + " " + count_text(input.number_or("number", 0));
}

std::string half_text(const JsonView& kernel, const char* half) {
  if (!kernel.has(half)) return "-";
  const JsonView part = kernel.at(half);
  return count_text(part.number_or("above", 0)) + " of " + count_text(part.number_or("inputs", 0));
}

}  // namespace

Section loops_section(const ReportSources& sources) {
  Section section{"loops", "Loop-count ledger", {}};
  if (sources.measures.empty()) {
    section.blocks.push_back(missing_input("--measure F", k_measure_command));
    return section;
  }
  // Counts depend on the code, not on the computer: the first file is shown; all must agree.
  const JsonView& measure = sources.measures.front();
  Table table{
      "Declared: the loop's maximum in one call, from the code. Observed: its maximum over all "
      "inputs. A loop that reached its maximum stopped and returned a reason.",
      {{"Kernel"},
       {"Loop"},
       {"Declared", NumberKind::bound, true},
       {"Observed", NumberKind::observed, true},
       {"Used", NumberKind::none, true},
       {"Cost a count, " + unit_of(measure), NumberKind::none, true}},
      {}};
  std::size_t reached = 0, loops = 0;
  for (const JsonView& kernel : measure.list("kernels")) {
    bool first = true;
    for (const JsonView& loop : kernel.list("loops")) {
      const double declared = loop.number("declared"), observed = loop.number("observed");
      ++loops;
      if (observed >= declared) ++reached;
      table.rows.push_back({{first ? kernel.text("name") : ""},
                            {loop.text("name")},
                            {count_text(declared)},
                            {count_text(observed), observed > declared ? Tone::bad : Tone::plain},
                            {declared > 0 ? percent_text(100 * observed / declared) : "-"},
                            {us_text(loop.number_or("cost", 0))}});
      first = false;
    }
  }
  section.blocks.push_back(Sentence{std::to_string(reached) + " of " + std::to_string(loops) +
                                    " loops reached their declared maximum (" +
                                    conditions_of(measure) + ")."});
  section.blocks.push_back(table);
  return section;
}

Section costs_section(const ReportSources& sources) {
  Section section{"costs", "Kernel costs and their envelope", {}};
  if (sources.measures.empty()) {
    section.blocks.push_back(missing_input("--measure F", k_measure_command));
    return section;
  }
  for (const JsonView& measure : sources.measures) {
    Table table{
        "In " + unit_of(measure) + " a call: " + conditions_of(measure) +
            ". The envelope is fitted on one half of the inputs and validated on the other.",
        {{"Kernel"},
         {"Bound", NumberKind::bound, true},
         {"Largest", NumberKind::observed, true},
         {"Bound / largest", NumberKind::none, true},
         {"Inputs", NumberKind::none, true},
         {"Largest on input"},
         {"Fitted: above", NumberKind::observed, true},
         {"Validated: above", NumberKind::observed, true},
         {"p50", NumberKind::observed, true},
         {"p99.9", NumberKind::observed, true}},
        {}};
    for (const JsonView& kernel : measure.list("kernels")) {
      const double bound = kernel.number("bound"), most = kernel.number("observed_max");
      const bool has_parts = kernel.has("percentiles");
      const auto part = [&](const char* name) {
        return TableCell{has_parts ? count_text(kernel.at("percentiles").number_or(name, 0)) : "-"};
      };
      table.rows.push_back({{kernel.text("name")},
                            {count_text(bound)},
                            {count_text(most), most > bound ? Tone::bad : Tone::plain},
                            {most > 0 ? us_text(bound / most) : "-"},
                            {count_text(kernel.number("inputs"))},
                            {worst_input_of(kernel)},
                            {half_text(kernel, "fit_half")},
                            {half_text(kernel, "judge_half")},
                            part("p50"),
                            part("p99_9")});
    }
    section.blocks.push_back(table);
  }
  return section;
}

Section interference_section(const ReportSources& sources) {
  Section section{"interference", "Interference", {}};
  Table table{
      "Ratio of a kernel's largest cost beside a named interference to its largest cost alone. "
      "Bounds exclude it unless the board file includes it.",
      {{"Kernel"}, {"Load"}, {"Factor", NumberKind::observed, true}, {"Measured on"}},
      {}};
  for (const JsonView& measure : sources.measures) {
    for (const JsonView& item : measure.list("interference")) {
      const char* load = item.has("load") ? "load" : "enemy";  // in older files
      table.rows.push_back({{item.text("kernel")},
                            {item.text(load)},
                            {us_text(item.number("factor"))},
                            {conditions_of(measure)}});
    }
  }
  if (table.rows.empty()) {
    section.blocks.push_back(missing_input("--measure F", "glint budget measure --interference"));
  } else {
    section.blocks.push_back(table);
  }
  return section;
}

Section footprint_section(const ReportSources& sources) {
  Section section{"footprint", "Footprint", {}};
  if (!sources.footprint) {
    section.blocks.push_back(missing_input("--footprint F", "the footprint check of the tests"));
    return section;
  }
  Table table{
      "In bytes. Stack: from the compiler's frames along the deepest call path; and the deepest "
      "overwritten byte of a painted stack.",
      {{"Node"},
       {"State", NumberKind::bound, true},
       {"Tokens", NumberKind::bound, true},
       {"Stack", NumberKind::bound, true},
       {"Stack", NumberKind::observed, true},
       {"Code", NumberKind::none, true}},
      {}};
  double state = 0, tokens = 0, code = 0;
  for (const JsonView& node : sources.footprint->list("nodes")) {
    const double bound = node.number_or("stack_bound_bytes", 0);
    const double observed = node.number_or("stack_observed_bytes", 0);
    table.rows.push_back({{node.text("name")},
                          {count_text(node.number_or("state_bytes", 0))},
                          {count_text(node.number_or("token_bytes", 0))},
                          {bound > 0 ? count_text(bound) : "-"},
                          {observed > 0 ? count_text(observed) : "-",
                           bound > 0 && observed > bound ? Tone::bad : Tone::plain},
                          {count_text(node.number_or("code_bytes", 0))}});
    state += node.number_or("state_bytes", 0);
    tokens += node.number_or("token_bytes", 0);
    code += node.number_or("code_bytes", 0);
  }
  table.rows.push_back(
      {{"all"}, {count_text(state)}, {count_text(tokens)}, {""}, {""}, {count_text(code)}});
  section.blocks.push_back(table);
  return section;
}

}  // namespace glint

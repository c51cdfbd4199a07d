#include <algorithm>

#include "platform/budget/report/sections.hpp"

namespace glint {
namespace {

std::string short_hash(const std::string& hash) { return hash.substr(0, 12); }

std::string board_of(const ReportSources& sources) {
  if (!sources.check) return "";
  const std::string hash = sources.check->text_or("board_sha256", "");
  return "board " + sources.check->text_or("board", "unnamed") +
         (hash.empty() ? "" : ", table " + short_hash(hash));
}

// Nodes that took longer than the bound in their spans.
std::vector<std::string> nodes_above(const RunObservations& run) {
  std::vector<std::string> above;
  for (const NodeTimes& node : run.nodes) {
    if (node.above == 0) continue;
    const double most = *std::max_element(node.us.begin(), node.us.end());
    above.push_back(node.node + ": " + std::to_string(node.above) + " of " +
                    std::to_string(node.us.size()) + " calls above their bound of " +
                    us_text(node.bound_us) + " \u00b5s, longest " + us_text(most) + " \u00b5s");
  }
  return above;
}

// Parts of the chain's sum by kind, since not all of it is computed.
std::string shares_text(const ReportSources& sources) {
  if (!sources.check) return "";
  for (const JsonView& chain : sources.check->list("chains")) {
    if (chain.text("name") != "frame_to_can") continue;
    double computed = 0, declared = 0, measured = 0;
    for (const JsonView& stage : chain.list("stages")) {
      const std::string kind = stage.text("kind");
      (kind == "bound" ? computed : kind == "estimate" ? measured : declared) += stage.number("us");
    }
    return "; " + us_text(computed) + " computed + " + us_text(declared) + " declared + " +
           us_text(measured) + " estimate";
  }
  return "";
}

Headline bound_headline(const ReportSources& sources) {
  const double bound = sources.bound_frame_to_can_us();
  Headline headline{NumberKind::bound, "not given", "Frame to CAN at worst", board_of(sources)};
  if (bound > 0) headline.value = us_text(bound) + " \u00b5s";
  headline.provenance += shares_text(sources);
  if (sources.summary && sources.summary->has("budget") && headline.provenance.empty()) {
    headline.provenance = "board " + sources.summary->at("budget").text_or("board", "unnamed");
  }
  return headline;
}

Headline observed_headline(const ReportSources& sources) {
  Headline headline{NumberKind::observed, "not given", "Frame to CAN, high-water mark", ""};
  const double most = sources.observed_frame_to_can_us();
  if (sources.summary && !sources.run_was_live()) {
    headline.provenance = "the run in " + sources.run_folder + " was not live";
  }
  if (most < 0) return headline;
  headline.value = us_text(most) + " \u00b5s";
  const JsonView times = sources.summary->at("frame_to_can_us");
  headline.provenance = "n " + count_text(times.number_or("n", 0)) + ", p50 " +
                        us_text(times.number("p50")) + ", p99.9 " + us_text(times.number("p99_9")) +
                        " \u00b5s, run in " + sources.run_folder +
                        (sources.best_effort().empty() ? "" : ", best effort");
  return headline;
}

// Part of the main chain that was measured, not computed.
Headline estimate_headline(const ReportSources& sources) {
  Headline headline{NumberKind::estimate, "not given", "Measured share within the chain", ""};
  if (!sources.check) return headline;
  for (const JsonView& chain : sources.check->list("chains")) {
    if (chain.text("name") != "frame_to_can") continue;
    double sum = 0;
    std::string parts;
    for (const JsonView& stage : chain.list("stages")) {
      if (stage.text("kind") != "estimate") continue;
      sum += stage.number("us");
      parts += (parts.empty() ? "" : ", ") + stage.text("name") + " " + us_text(stage.number("us"));
    }
    headline.value = parts.empty() ? "none" : us_text(sum) + " \u00b5s";
    headline.provenance =
        parts.empty() ? "every stage is computed or declared" : parts + "; " + board_of(sources);
  }
  return headline;
}

}  // namespace

void judge(const ReportSources& sources, Document& document) {
  document.headlines = {bound_headline(sources), estimate_headline(sources),
                        observed_headline(sources)};
  const double bound = sources.bound_frame_to_can_us();
  const double observed = sources.observed_frame_to_can_us();
  std::vector<Sentence>& reasons = document.reasons;

  std::size_t voids = 0;
  if (sources.check) {
    for (const JsonView& reason : sources.check->list("void")) {
      reasons.push_back({"The bound does not hold: " + reason.as_text(), Tone::bad});
      ++voids;
    }
  }
  if (bound > 0 && observed > bound) {
    reasons.push_back({"Observed above bound: frame to CAN took " + us_text(observed) +
                           " \u00b5s, the bound is " + us_text(bound) + " \u00b5s",
                       Tone::bad});
    ++voids;
  }
  for (const std::string& node : nodes_above(sources.run)) {
    reasons.push_back({"Observed above bound: " + node, Tone::bad});
    ++voids;
  }
  if (voids > 0 && sources.check && sources.check->text_or("counter", "time") == "instructions") {
    reasons.push_back(
        {"The table counts instructions at a declared time each; the run's clock also includes "
         "caches, interrupts and preemption",
         Tone::plain});
  }
  const bool not_live = sources.summary && !sources.run_was_live();
  if (not_live) {
    reasons.push_back({"The run in " + sources.run_folder +
                           " was not live: its latencies are nominal, not measured; expected a run "
                           "in real time (realtime = true, no --fast)",
                       Tone::bad});
  }
  const std::vector<std::string> best_effort = sources.best_effort();
  if (!best_effort.empty()) {
    reasons.push_back(
        {"The run was best effort: the machine does not meet the bound's assumptions (" +
             std::to_string(best_effort.size()) + " reasons below)",
         Tone::plain});
  }
  if (!sources.check) {
    document.verdict_text = "No checked plan was given: this report has no latency bound.";
    return;
  }
  const std::vector<JsonView> fails = sources.check->list("fails");
  for (const JsonView& fail : fails) reasons.push_back({fail.as_text(), Tone::bad});
  if (!fails.empty() || sources.check->text_or("verdict", "holds") != "holds") {
    document.verdict = Verdict::fails;
    document.verdict_text = "At least one bound does not meet its deadline or its margin.";
  } else if (voids > 0) {
    document.verdict = Verdict::invalid_bound;
    document.verdict_text =
        "The computed bounds meet their deadlines, but observations contradict their assumptions. "
        "They do not hold until this is explained.";
  } else {
    document.verdict = Verdict::holds;
    document.verdict_text = "Every chain's bound meets its deadline with the required margin (" +
                            percent_text(sources.check->number_or("margin_percent", 0)) + ")" +
                            (observed > 0 ? ", and no observation lies above its bound."
                             : not_live   ? ". The given run was not live: no observations."
                                          : ". No run was given.");
  }
}

Section reading_section(const ReportSources& sources) {
  Section section{"reading", "How to read the numbers", {}};
  section.blocks.push_back(Table{
      "Three kinds of number have their own columns. A sum of two kinds is marked.",
      {{"Kind"}, {"What it is"}, {"What it is not"}},
      {{{"\u25a0 bound"},
        {"Loop counts of the code at their declared maximum, times the cost table of the named "
         "board, through the analysis of the plan. Holds before a run."},
        {"Not stronger than its table: does not hold if a node costs more than its table entry."}},
       {{"\u25c6 estimate"},
        {"A statistical prediction of future values, or a measured share of the operating system "
         "that cannot be computed."},
        {"Not a guarantee; omitted if its assumptions fail."}},
       {{"\u25cf observed"},
        {"Readings of a clock or a counter: percentiles and the high-water mark of n values."},
        {"Never a worst case: the next value may be larger."}}}});
  Table from{"Sources.", {{"Figures"}, {"Board"}, {"Build"}, {"Conditions"}}, {}};
  for (const JsonView& measure : sources.measures) {
    from.rows.push_back(
        {{"costs, in " + measure.text_or("unit", measure.text_or("count", "?"))},
         {measure.text_or("board", "none") + " (" + measure.text_or("arch", "?") + ")"},
         {measure.text_or("compiler", "?") + ", " + measure.text_or("build", "?") + ", " +
          measure.text_or("commit_or_version", "?")},
         {measure.text_or("cache", "?") + " cache"}});
  }
  if (sources.check) {
    from.rows.push_back({{"bounds"},
                         {sources.check->text_or("board", "none")},
                         {"table " + sources.check->text_or("board_sha256", "?")},
                         {"plan " + sources.check->text_or("plan", "?") + ", " +
                          count_text(sources.check->number_or("cores", 1)) + " cores"}});
  }
  if (sources.trace) {
    from.rows.push_back({{"observed times"},
                         {"the run's machine; bounds of " +
                          (sources.trace->board.empty() ? "none" : sources.trace->board)},
                         {"cell " + sources.trace->cell},
                         {us_text(sources.run.duration_s) + " s, " +
                          count_text(static_cast<double>(sources.trace->spans.size())) + " spans" +
                          (sources.best_effort().empty() ? "" : ", best effort")}});
  }
  section.blocks.push_back(from);
  return section;
}

Section timing_faults_section(const ReportSources& sources) {
  Section section{"spoiled", "Best effort, and bounds that do not hold", {}};
  if (sources.summary) {
    const std::vector<std::string> reasons = sources.best_effort();
    if (reasons.empty()) {
      section.blocks.push_back(Sentence{"The run's machine has no timing faults.", Tone::good});
    } else {
      Table table{
          "Timing faults of the run's machine. Its observed times include them; the bound does "
          "not.",
          {{"Best effort because"}},
          {}};
      for (const std::string& reason : reasons) table.rows.push_back({{reason}});
      section.blocks.push_back(table);
    }
  } else {
    section.blocks.push_back(
        missing_input("--run DIR", "glint run --out DIR --json DIR/summary.json"));
  }
  Table table{"", {{"Bound"}, {"Why"}}, {}};
  if (sources.check) {
    for (const JsonView& reason : sources.check->list("void")) {
      table.rows.push_back({{"all bounds"}, {reason.as_text(), Tone::bad}});
    }
  }
  for (const std::string& node : nodes_above(sources.run)) {
    table.rows.push_back({{"bounds of chains through this node"}, {node, Tone::bad}});
  }
  if (table.rows.empty()) {
    section.blocks.push_back(Sentence{"No input of this report contradicts a bound.", Tone::plain});
  } else {
    section.blocks.push_back(table);
  }
  return section;
}

Section inputs_section(const ReportSources& sources) {
  Section section{"inputs", "The files behind this report", {}};
  Table table{"", {{"File"}, {"What"}, {"SHA-256"}}, {}};
  for (const ReportInput& input : sources.inputs) {
    table.rows.push_back({{"`" + input.path + "`"}, {input.what}, {"`" + input.sha256 + "`"}});
  }
  section.blocks.push_back(table);
  return section;
}

}  // namespace glint

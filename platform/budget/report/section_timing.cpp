// What the analysis says: chains, slack, response times, the bus; beside each what was observed.
#include <algorithm>

#include "platform/budget/report/figures.hpp"
#include "platform/budget/report/sections.hpp"
#include "platform/report/statistics.hpp"

namespace glint {
namespace {

const char* k_check_command = "glint budget check --json F";

// Sums of a chain's stages by what they are.
struct Shares {
  double bound = 0, estimate = 0, declared = 0;
};

Shares shares_of(const JsonView& chain) {
  Shares shares;
  for (const JsonView& stage : chain.list("stages")) {
    const std::string kind = stage.text("kind");
    (kind == "bound"      ? shares.bound
     : kind == "estimate" ? shares.estimate
                          : shares.declared) += stage.number("us");
  }
  return shares;
}

Table frame_to_can_observed(const JsonView& times) {
  Table table{
      "Frame to CAN as the run saw it, in \u00b5s: the frame's last byte in memory to the "
      "return of the CAN write that first carries its estimate.",
      {{"Part"},
       {"n", NumberKind::none, true},
       {"p50", NumberKind::observed, true},
       {"p99", NumberKind::observed, true},
       {"p99.9", NumberKind::observed, true},
       {"max", NumberKind::observed, true}},
      {}};
  const auto add = [&](const std::string& name, const JsonView& part) {
    table.rows.push_back({{name},
                          {count_text(part.number_or("n", 0))},
                          {us_text(part.number("p50"))},
                          {us_text(part.number("p99"))},
                          {us_text(part.number("p99_9"))},
                          {us_text(part.number("max"))}});
  };
  add("whole", times);
  for (const char* part : {"computing", "sampling", "sending"}) {
    if (times.has(part)) add(part, times.at(part));
  }
  return table;
}

}  // namespace

Section chains_section(const ReportSources& sources) {
  Section section{"chains", "Chains, stage by stage", {}};
  if (!sources.check) {
    section.blocks.push_back(not_given("--check F", k_check_command));
  } else {
    const double wanted = sources.check->number_or("margin_percent", 0);
    Table table{
        "In \u00b5s. A chain's figure is the sum of its stages; what of it is computed, "
        "declared by a data sheet or measured stands beside it.",
        {{"Chain"},
         {"Deadline", NumberKind::none, true},
         {"Whole", NumberKind::bound, true},
         {"of it computed", NumberKind::bound, true},
         {"declared", NumberKind::none, true},
         {"measured", NumberKind::estimate, true},
         {"Slack", NumberKind::none, true},
         {"Max. reaction", NumberKind::bound, true},
         {"Max. data age", NumberKind::bound, true},
         {"Jitter", NumberKind::bound, true}},
        {}};
    std::vector<Block> figures;
    for (const JsonView& chain : sources.check->list("chains")) {
      const std::string name = chain.text("name");
      const Shares shares = shares_of(chain);
      const double slack = chain.number("slack_percent"), deadline = chain.number("deadline_us");
      table.rows.push_back({{name},
                            {us_text(deadline)},
                            {us_text(chain.number("bound_us")), tone_of_slack(slack, wanted)},
                            {us_text(shares.bound)},
                            {us_text(shares.declared)},
                            {us_text(shares.estimate)},
                            {percent_text(slack), tone_of_slack(slack, wanted)},
                            {us_text(chain.number_or("maximum_reaction_time_us", 0 / 0.0))},
                            {us_text(chain.number_or("maximum_data_age_us", 0 / 0.0))},
                            {us_text(chain.number_or("jitter_us", 0 / 0.0))}});
      std::vector<StageBar> stages;
      for (const JsonView& stage : chain.list("stages")) {
        stages.push_back({stage.text("name"), stage.text("kind"), stage.number("us")});
      }
      if (stages.empty()) continue;
      figures.push_back(stages_figure("chain-" + name,
                                      "Chain `" + name + "`: " + us_text(chain.number("bound_us")) +
                                          " \u00b5s of " + us_text(deadline) +
                                          " \u00b5s. Each bar begins where the one before it ends.",
                                      stages, deadline));
    }
    section.blocks.push_back(table);
    section.blocks.insert(section.blocks.end(), figures.begin(), figures.end());
  }
  if (sources.summary && sources.summary->has("frame_to_can_us")) {
    section.blocks.push_back(frame_to_can_observed(sources.summary->at("frame_to_can_us")));
  }
  return section;
}

Section slack_section(const ReportSources& sources) {
  Section section{"slack", "Slack, and what may grow", {}};
  if (!sources.check) {
    section.blocks.push_back(not_given("--check F", k_check_command));
    return section;
  }
  const JsonView& check = *sources.check;
  const double wanted = check.number_or("margin_percent", 0);
  std::vector<SlackBar> bars;
  for (const JsonView& chain : check.list("chains")) {
    bars.push_back({"chain " + chain.text("name"), chain.number("slack_percent")});
  }
  for (const JsonView& group : check.list("groups")) {
    bars.push_back({"group " + group.text("name"), group.number("slack_percent")});
  }
  if (check.has("system_slack_percent")) {
    bars.push_back({"system", check.number("system_slack_percent")});
  }
  section.blocks.push_back(slack_figure(
      "slack",
      "Slack of every chain and group" +
          (wanted > 0 ? "; the dashed line is the margin asked for, " + percent_text(wanted) : "") +
          ".",
      bars, wanted));
  Table table{
      "How much each node may grow, all others at their bounds, before a deadline is missed.",
      {{"Group"},
       {"Node"},
       {"Core", NumberKind::none, true},
       {"Bound, \u00b5s", NumberKind::bound, true},
       {"Slack", NumberKind::none, true},
       {"May grow by", NumberKind::none, true}},
      {}};
  const std::vector<JsonView> nodes = check.list("nodes");
  for (const JsonView& node : nodes) {
    const double slack = node.number_or("slack_percent", 0);
    table.rows.push_back({{node.text("group")},
                          {node_label(node, nodes)},
                          {count_text(node.number_or("core", 0))},
                          {us_text(node.number("bound_us"))},
                          {percent_text(slack), tone_of_slack(slack, 0)},
                          {percent_text(node.number_or("may_grow_percent", 0))}});
  }
  section.blocks.push_back(table);
  std::string words;
  if (check.has("break_even_clock")) {
    words += "Break-even clock: " + us_text(check.number("break_even_clock")) +
             " of the clock that the table was made at. ";
  }
  if (check.has("largest")) {
    const JsonView largest = check.at("largest");
    words += "Still fits: an ROI of " + count_text(largest.number_or("roi_pixels", 0)) +
             " pixels, or " + count_text(largest.number_or("tools", 0)) + " tools.";
  }
  if (!words.empty()) section.blocks.push_back(Sentence{words});
  return section;
}

Section groups_section(const ReportSources& sources) {
  Section section{"groups", "Response times", {}};
  if (!sources.check) {
    section.blocks.push_back(not_given("--check F", k_check_command));
    return section;
  }
  Table table{
      "In \u00b5s, from a group's release to its last node's end, preemption and blocking "
      "included. Observed: of each group's activations in the run.",
      {{"Group"},
       {"Priority", NumberKind::none, true},
       {"Makespan", NumberKind::bound, true},
       {"Blocking", NumberKind::bound, true},
       {"Response", NumberKind::bound, true},
       {"Deadline", NumberKind::none, true},
       {"Slack", NumberKind::none, true},
       {"n", NumberKind::none, true},
       {"p50", NumberKind::observed, true},
       {"p99.9", NumberKind::observed, true},
       {"max", NumberKind::observed, true}},
      {}};
  const double wanted = sources.check->number_or("margin_percent", 0);
  for (const JsonView& group : sources.check->list("groups")) {
    const std::string name = group.text("name");
    const double slack = group.number("slack_percent"), bound = group.number("response_us");
    std::vector<double> seen;
    for (std::size_t g = 0; sources.trace && g < sources.trace->groups.size(); ++g) {
      if (sources.trace->groups[g].name != name) continue;
      for (const Activation& a : sources.run.groups[g]) seen.push_back(a.response_us());
    }
    const double most = seen.empty() ? 0 : *std::max_element(seen.begin(), seen.end());
    const auto part = [&](double p) {
      return TableCell{seen.empty() ? "-" : us_text(percentile(seen, p))};
    };
    table.rows.push_back(
        {{name},
         {count_text(group.number_or("priority", 0))},
         {us_text(group.number("makespan_us"))},
         {us_text(group.number_or("blocking_us", 0))},
         {us_text(bound)},
         {us_text(group.number("deadline_us"))},
         {percent_text(slack), tone_of_slack(slack, wanted)},
         {count_text(static_cast<double>(seen.size()))},
         part(0.5),
         part(0.999),
         {seen.empty() ? "-" : us_text(most), most > bound ? Tone::bad : Tone::plain}});
  }
  section.blocks.push_back(table);
  return section;
}

Section can_section(const ReportSources& sources) {
  Section section{"can", "The bus", {}};
  if (!sources.check) {
    section.blocks.push_back(not_given("--check F", k_check_command));
    return section;
  }
  Table table{"Queueing to the end of transmission, in \u00b5s, with the bus's foreign frames.",
              {{"Message"},
               {"Identifier"},
               {"Response", NumberKind::bound, true},
               {"Deadline", NumberKind::none, true},
               {"Slack", NumberKind::none, true}},
              {}};
  for (const JsonView& message : sources.check->list("can")) {
    const double response = message.number("response_us"), deadline = message.number("deadline_us");
    const double slack = deadline > 0 ? 100 * (1 - response / deadline) : 0;
    const JsonView identifier = message.at("identifier");
    char hex[16];
    std::snprintf(hex, sizeof hex, "0x%03X",
                  identifier.is_number() ? static_cast<unsigned>(identifier.as_number()) : 0U);
    table.rows.push_back({{message.text("name")},
                          {identifier.is_number() ? hex : identifier.as_text()},
                          {us_text(response), tone_of_slack(slack, 0)},
                          {us_text(deadline)},
                          {percent_text(slack), tone_of_slack(slack, 0)}});
  }
  section.blocks.push_back(table);
  section.blocks.push_back(Sentence{
      "Bus load, computed: " + percent_text(100 * sources.check->number_or("bus_load", 0)) + "."});
  return section;
}

}  // namespace glint

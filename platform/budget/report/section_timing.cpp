// Report sections of the analysis: chains, slack, response times, CAN bus, with observations
// beside.
#include <algorithm>
#include <cstdio>

#include "platform/budget/report/figures.hpp"
#include "platform/budget/report/sections.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {
namespace {

const char* k_check_command = "glint budget check --json F";

// Sums of a chain's stages by kind.
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
      "Observed frame to CAN, in \u00b5s: from the frame's last byte in memory to the return of "
      "the CAN write that first carries its estimate.",
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
    section.blocks.push_back(missing_input("--check F", k_check_command));
  } else {
    Table table{
        "In \u00b5s. Computed, declared and measured parts have their own columns. The deadline "
        "applies to their sum.",
        {{"Chain"},
         {"Computed", NumberKind::bound, true},
         {"Declared", NumberKind::none, true},
         {"Measured", NumberKind::estimate, true},
         {"Sum", NumberKind::none, true},
         {"Deadline", NumberKind::none, true},
         {"Slack", NumberKind::none, true},
         {"May grow by", NumberKind::none, true},
         {"Max. reaction", NumberKind::bound, true},
         {"Max. data age", NumberKind::bound, true},
         {"Jitter", NumberKind::bound, true}},
        {}};
    std::vector<Block> figures;
    for (const JsonView& chain : sources.check->list("chains")) {
      const std::string name = chain.text("name");
      const Shares shares = shares_of(chain);
      const double sum = chain.number_or_none("bound_us"), deadline = chain.number("deadline_us");
      const double left = left_percent(sum, deadline);
      table.rows.push_back({{name},
                            {us_text(shares.bound)},
                            {us_text(shares.declared)},
                            {us_text(shares.estimate)},
                            {us_text(sum), tone_of_left(left)},
                            {us_text(deadline)},
                            {percent_text(left), tone_of_left(left)},
                            {percent_text(chain.number_or_none("slack_percent"))},
                            {us_text(chain.number_or_none("maximum_reaction_time_us"))},
                            {us_text(chain.number_or_none("maximum_data_age_us"))},
                            {us_text(chain.number_or_none("jitter_us"))}});
      std::vector<StageBar> stages;
      for (const JsonView& stage : chain.list("stages")) {
        stages.push_back({stage.text("name"), stage.text("kind"), stage.number("us")});
      }
      if (stages.empty()) continue;
      figures.push_back(stages_figure("chain-" + name,
                                      "Chain `" + name + "`: " + us_text(sum) + " \u00b5s of " +
                                          us_text(deadline) +
                                          " \u00b5s. Each bar begins where the one before it ends.",
                                      stages, deadline));
    }
    section.blocks.push_back(table);
    section.blocks.insert(section.blocks.end(), figures.begin(), figures.end());
  }
  if (sources.observed_frame_to_can_us() >= 0) {
    section.blocks.push_back(frame_to_can_observed(sources.summary->at("frame_to_can_us")));
  }
  return section;
}

Section slack_section(const ReportSources& sources) {
  Section section{"slack", "Slack", {}};
  if (!sources.check) {
    section.blocks.push_back(missing_input("--check F", k_check_command));
    return section;
  }
  const JsonView& check = *sources.check;
  std::vector<SlackBar> bars;
  const auto add = [&](const std::string& name, const JsonView& item, const char* bound) {
    const double left = left_percent(item.number_or_none(bound), item.number("deadline_us"));
    if (left == left) bars.push_back({name, left});
  };
  for (const JsonView& chain : check.list("chains")) {
    add("chain " + chain.text("name"), chain, "bound_us");
  }
  for (const JsonView& group : check.list("groups")) {
    add("group " + group.text("name"), group, "response_us");
  }
  section.blocks.push_back(
      slack_figure("slack", "Slack of every chain and group to its deadline.", bars));
  std::string words = "All bounds together may grow by " +
                      percent_text(check.number_or_none("system_slack_percent")) +
                      " before a deadline is missed; required: " +
                      percent_text(check.number_or("margin_percent", 0)) + ". ";
  if (check.has("break_even_clock")) {
    words += "Break-even clock: " + us_text(check.number("break_even_clock")) +
             " of the table's clock. ";
  }
  if (check.has("largest")) {
    const JsonView largest = check.at("largest");
    words += "Still fits: " + count_text(largest.number_or_none("roi_pixels")) +
             " searched pixels, or " + count_text(largest.number_or_none("tools")) + " tools.";
  }
  section.blocks.push_back(Sentence{words});
  Table table{"Growth of each node before a deadline is missed, all others at their bounds.",
              {{"Group"},
               {"Node"},
               {"Core", NumberKind::none, true},
               {"Bound, \u00b5s", NumberKind::bound, true},
               {"This copy may grow by", NumberKind::none, true},
               {"All its copies by", NumberKind::none, true}},
              {}};
  const std::vector<JsonView> nodes = check.list("nodes");
  for (const JsonView& node : nodes) {
    table.rows.push_back({{node.text("group")},
                          {node_label(node, nodes)},
                          {count_text(node.number_or_none("core"))},
                          {us_text(node.number_or_none("bound_us"))},
                          {percent_text(node.number_or_none("slack_percent"))},
                          {percent_text(node.number_or_none("may_grow_percent"))}});
  }
  section.blocks.push_back(table);
  return section;
}

Section groups_section(const ReportSources& sources) {
  Section section{"groups", "Response times", {}};
  if (!sources.check) {
    section.blocks.push_back(missing_input("--check F", k_check_command));
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
  for (const JsonView& group : sources.check->list("groups")) {
    const std::string name = group.text("name");
    const double bound = group.number_or_none("response_us"),
                 deadline = group.number("deadline_us");
    const double left = left_percent(bound, deadline);
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
         {count_text(group.number_or_none("priority"))},
         {us_text(group.number_or_none("makespan_us"))},
         {us_text(group.number_or("blocking_us", 0))},
         {us_text(bound)},
         {us_text(deadline)},
         {percent_text(left), tone_of_left(left)},
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
    section.blocks.push_back(missing_input("--check F", k_check_command));
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
    const double response = message.number_or_none("response_us");
    const double deadline = message.number("deadline_us");
    const double left = left_percent(response, deadline);
    const JsonView identifier = message.at("identifier");
    char hex[16];
    std::snprintf(hex, sizeof hex, "0x%03X",
                  identifier.is_number() ? static_cast<unsigned>(identifier.as_number()) : 0U);
    table.rows.push_back({{message.text("name")},
                          {identifier.is_number() ? hex : identifier.as_text()},
                          {us_text(response), tone_of_left(left)},
                          {us_text(deadline)},
                          {percent_text(left), tone_of_left(left)}});
  }
  section.blocks.push_back(table);
  section.blocks.push_back(Sentence{
      "Bus load, computed: " + percent_text(100 * sources.check->number_or("bus_load", 0)) + "."});
  return section;
}

}  // namespace glint

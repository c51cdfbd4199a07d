// Report sections of a run: its schedule beside the planned one, node times, worst frames.
#include <algorithm>

#include "platform/budget/report/figures.hpp"
#include "platform/budget/report/sections.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {
namespace {

const char* k_run_command = "glint run --out DIR --json DIR/summary.json";

GanttStrip plan_strip(const JsonView& check, const std::string& group) {
  GanttStrip strip{"Plan of " + group + ": every node at its bound", NumberKind::bound, {}};
  const std::vector<JsonView> nodes = check.list("nodes");
  for (const JsonView& node : nodes) {
    if (node.text("group") != group) continue;
    const double from = node.number_or("start_us", 0);
    strip.bars.push_back({node_label(node, nodes), static_cast<int>(node.number_or("core", 0)),
                          from, from + node.number("bound_us")});
  }
  return strip;
}

// One activation, with other groups' nodes on its cores during it.
GanttStrip run_strip(const TraceFile& trace, std::size_t group, const Activation& activation,
                     const std::string& which) {
  GanttStrip strip{which + ": activation " + std::to_string(activation.number) + ", frame " +
                       std::to_string(activation.frame) + ", " + us_text(activation.response_us()) +
                       " \u00b5s",
                   NumberKind::observed,
                   {}};
  const auto after = [&](std::int64_t ns) {
    return static_cast<double>(ns - activation.release_ns) * 1e-3;
  };
  const auto core_of = [&](const TraceSpan& span) {
    return trace.groups[span.group].cores[span.node];
  };
  std::vector<int> cores;
  for (const TraceSpan& span : activation.nodes) {
    cores.push_back(core_of(span));
    strip.bars.push_back({std::string(trace.node_name(span)), core_of(span), after(span.begin_ns),
                          after(span.end_ns),
                          (span.flags & (k_span_overran | k_span_injected)) != 0, false});
  }
  for (const TraceSpan& span : trace.spans) {
    if (span.group == group || !is_node(span)) continue;
    if (span.end_ns < activation.release_ns || span.begin_ns > activation.end_ns) continue;
    if (std::find(cores.begin(), cores.end(), core_of(span)) == cores.end()) continue;
    strip.bars.push_back(
        {std::string(trace.group_name(span)) + ": " + std::string(trace.node_name(span)),
         core_of(span), std::max(0.0, after(span.begin_ns)),
         after(std::min(span.end_ns, activation.end_ns)), false, true});
  }
  return strip;
}

}  // namespace

Section schedule_section(const ReportSources& sources) {
  Section section{"schedule", "The plan and its run", {}};
  if (!sources.check)
    section.blocks.push_back(missing_input("--check F", "glint budget check --json F"));
  if (!sources.trace) section.blocks.push_back(missing_input("--run DIR", k_run_command));
  std::vector<std::string> groups;
  if (sources.trace) {
    for (const TraceGroup& group : sources.trace->groups) groups.push_back(group.name);
  } else if (sources.check) {
    for (const JsonView& group : sources.check->list("groups"))
      groups.push_back(group.text("name"));
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<GanttStrip> strips;
    double deadline = 0;
    if (sources.check) {
      strips.push_back(plan_strip(*sources.check, groups[g]));
      if (strips.back().bars.empty()) strips.pop_back();
      for (const JsonView& group : sources.check->list("groups")) {
        if (group.text("name") == groups[g]) deadline = group.number("deadline_us");
      }
    }
    if (sources.trace) {
      const std::vector<Activation>& seen = sources.run.groups[g];
      if (const Activation* worst = worst_of(seen)) {
        strips.push_back(run_strip(*sources.trace, g, *worst, "Worst observed"));
        strips.push_back(run_strip(*sources.trace, g, *median_of(seen), "Median observed"));
      }
    }
    if (strips.empty()) continue;
    section.blocks.push_back(gantt_figure(
        "gantt-" + groups[g],
        "Group `" + groups[g] +
            "`. Copies of a node share a shade. Outlined blocks overran or were delayed by "
            "injection. Thin frames are other groups' nodes on the same core.",
        strips, deadline));
  }
  return section;
}

Section nodes_section(const ReportSources& sources) {
  Section section{"nodes", "Each node's times", {}};
  if (!sources.trace) {
    section.blocks.push_back(missing_input("--run DIR", k_run_command));
    return section;
  }
  Table table{"In \u00b5s, of the run. Observed times include preemption by other threads.",
              {{"Group"},
               {"Node"},
               {"Bound", NumberKind::bound, true},
               {"n", NumberKind::none, true},
               {"p50", NumberKind::observed, true},
               {"p99", NumberKind::observed, true},
               {"p99.9", NumberKind::observed, true},
               {"max", NumberKind::observed, true},
               {"Above bound", NumberKind::observed, true}},
              {}};
  FigureGrid grid;
  for (const NodeTimes& node : sources.run.nodes) {
    if (node.us.empty()) continue;
    const double most = *std::max_element(node.us.begin(), node.us.end());
    table.rows.push_back({{node.group},
                          {node.node},
                          {node.bound_us > 0 ? us_text(node.bound_us) : "-"},
                          {count_text(static_cast<double>(node.us.size()))},
                          {us_text(percentile(node.us, 0.5))},
                          {us_text(percentile(node.us, 0.99))},
                          {us_text(percentile(node.us, 0.999))},
                          {us_text(most)},
                          {node.bound_us > 0 ? count_text(static_cast<double>(node.above)) : "-",
                           node.above > 0 ? Tone::bad : Tone::plain}});
    grid.figures.push_back(histogram_figure(node));
  }
  section.blocks.push_back(
      Sentence{"Counts have a logarithmic scale, so a single slow call among thousands is visible. "
               "The line is the node's bound."});
  section.blocks.push_back(grid);
  section.blocks.push_back(table);
  return section;
}

Section worst_frames_section(const ReportSources& sources, std::size_t frames) {
  Section section{"worst-frames", "The worst frames, and their commands", {}};
  if (!sources.trace || sources.run.groups.empty()) {
    section.blocks.push_back(missing_input("--run DIR", k_run_command));
    return section;
  }
  std::vector<const Activation*> order;
  for (const Activation& a : sources.run.groups[k_frame_group_of_trace]) order.push_back(&a);
  std::sort(order.begin(), order.end(), [](const Activation* a, const Activation* b) {
    return a->response_us() > b->response_us();
  });
  order.resize(std::min(order.size(), frames));
  Table table{"By the frame group's response, in \u00b5s.",
              {{"Frame"},
               {"Activation", NumberKind::none, true},
               {"Response", NumberKind::observed, true},
               {"Frame to CAN", NumberKind::observed, true},
               {"Longest node"},
               {"its time", NumberKind::observed, true},
               {"Noticed"},
               {"Again"}},
              {}};
  const std::string trace = sources.run_folder + "/trace.spans";
  for (const Activation* a : order) {
    const auto longest = std::max_element(a->nodes.begin(), a->nodes.end(),
                                          [](const TraceSpan& x, const TraceSpan& y) {
                                            return x.end_ns - x.begin_ns < y.end_ns - y.begin_ns;
                                          });
    const auto sent =
        std::find_if(sources.run.frames.begin(), sources.run.frames.end(),
                     [&](const FrameLatency& f) { return f.activation == a->number; });
    std::string noticed;
    if ((a->flags & k_span_overran) != 0) noticed += "overran ";
    if ((a->flags & k_span_will_miss) != 0) noticed += "will_miss ";
    if ((a->flags & k_span_injected) != 0) noticed += "injected ";
    table.rows.push_back(
        {{std::to_string(a->frame)},
         {count_text(static_cast<double>(a->number))},
         {us_text(a->response_us())},
         {sent == sources.run.frames.end() ? "-" : us_text(sent->us)},
         {std::string(sources.trace->node_name(*longest))},
         {us_text(static_cast<double>(longest->end_ns - longest->begin_ns) * 1e-3)},
         {noticed.empty() ? "-" : noticed.substr(0, noticed.size() - 1)},
         {"`glint budget export --trace " + trace + " --frame " + std::to_string(a->frame) +
          " --out frame-" + std::to_string(a->frame) + ".pftrace`"}});
  }
  section.blocks.push_back(table);
  section.blocks.push_back(
      Sentence{"Each command exports the spans near that frame for ui.perfetto.dev. To replay "
               "every frame, byte for byte:"});
  section.blocks.push_back(Command{"glint replay " + sources.run_folder + "/run.mcap"});
  return section;
}

}  // namespace glint

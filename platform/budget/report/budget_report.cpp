#include "platform/budget/report/budget_report.hpp"

#include "platform/budget/report/sections.hpp"

namespace glint {

Document budget_report(const ReportSources& sources, const ReportOptions& options) {
  Document document;
  document.title = "Glint timing report";
  std::string& subtitle = document.subtitle;
  const auto add = [&](const std::string& words) {
    subtitle += (subtitle.empty() ? "" : " \u00b7 ") + words;
  };
  if (sources.check) {
    add("board " + sources.check->text_or("board", "none"));
    add("plan " + sources.check->text_or("plan", "unnamed"));
  }
  if (sources.trace && !sources.trace->cell.empty()) add("cell " + sources.trace->cell);
  if (!sources.run_folder.empty()) add("run " + sources.run_folder);
  judge(sources, document);
  document.sections = {
      reading_section(sources),      chains_section(sources),
      slack_section(sources),        groups_section(sources),
      schedule_section(sources),     nodes_section(sources),
      loops_section(sources),        costs_section(sources),
      interference_section(sources), can_section(sources),
      estimates_section(sources),    worst_frames_section(sources, options.worst_frames),
      footprint_section(sources),    timing_faults_section(sources),
      inputs_section(sources)};
  return document;
}

}  // namespace glint

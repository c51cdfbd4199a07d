// Sections of the report, each from its input files. For a missing file, a sentence names the
// command that makes it.
#pragma once

#include "platform/budget/report/document.hpp"
#include "platform/budget/report/report_sources.hpp"

namespace glint {

// Fills the top of the page: the verdict with its reasons, and three figures.
void judge(const ReportSources& sources, Document& document);

[[nodiscard]] Section reading_section(const ReportSources& sources);
[[nodiscard]] Section chains_section(const ReportSources& sources);
[[nodiscard]] Section slack_section(const ReportSources& sources);
[[nodiscard]] Section groups_section(const ReportSources& sources);
[[nodiscard]] Section schedule_section(const ReportSources& sources);
[[nodiscard]] Section nodes_section(const ReportSources& sources);
[[nodiscard]] Section loops_section(const ReportSources& sources);
[[nodiscard]] Section costs_section(const ReportSources& sources);
[[nodiscard]] Section interference_section(const ReportSources& sources);
[[nodiscard]] Section can_section(const ReportSources& sources);
[[nodiscard]] Section estimates_section(const ReportSources& sources);
[[nodiscard]] Section footprint_section(const ReportSources& sources);
[[nodiscard]] Section worst_frames_section(const ReportSources& sources, std::size_t frames);
[[nodiscard]] Section timing_faults_section(const ReportSources& sources);
[[nodiscard]] Section inputs_section(const ReportSources& sources);

// Text shared by the sections.
[[nodiscard]] std::string us_text(double us);    // "12.34"; "none" if not finite
[[nodiscard]] std::string count_text(double n);  // "12 345", with thin spaces
[[nodiscard]] std::string percent_text(double percent);
// Remaining part of a deadline in percent; NaN if there is no deadline.
[[nodiscard]] double left_percent(double bound_us, double deadline_us);
[[nodiscard]] Tone tone_of_left(double percent);
// Name of a node of check.json, with its copy number if its group has several copies.
[[nodiscard]] std::string node_label(const JsonView& node, const std::vector<JsonView>& all);
[[nodiscard]] Sentence missing_input(const std::string& option, const std::string& command);

}  // namespace glint

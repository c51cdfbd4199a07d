// Timing report: one document, written as HTML and as Markdown.
#pragma once

#include "platform/budget/report/document.hpp"
#include "platform/budget/report/report_sources.hpp"

namespace glint {

struct ReportOptions {
  std::size_t worst_frames = 10;
};

[[nodiscard]] Document budget_report(const ReportSources& sources, const ReportOptions& options);

}  // namespace glint

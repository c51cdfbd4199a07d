// Conversion of a trace to the formats of other programs.
#pragma once

#include <string>
#include <string_view>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

enum class TraceFormat { perfetto, chrome, btf, csv };

// Throws InputError for a name other than perfetto, chrome, btf, csv.
[[nodiscard]] TraceFormat trace_format_of(std::string_view name);

// For ui.perfetto.dev and trace_processor: one track per worker, one slice per node call.
[[nodiscard]] std::string perfetto_trace(const TraceFile& trace);

// For chrome://tracing, Perfetto, Speedscope: complete events, microseconds.
[[nodiscard]] std::string chrome_trace(const TraceFile& trace);

// Best Trace Format, for Eclipse APP4MC and Trace Compass: one task per group and worker, one
// runnable per node.
[[nodiscard]] std::string btf_trace(const TraceFile& trace);

// One row per span, for a spreadsheet or a notebook.
[[nodiscard]] std::string csv_trace(const TraceFile& trace);

[[nodiscard]] std::string exported(const TraceFile& trace, TraceFormat format);

}  // namespace glint

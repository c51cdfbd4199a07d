// A trace in the formats that other programs open.
#pragma once

#include <string>
#include <string_view>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

enum class TraceFormat { perfetto, chrome, btf, csv };

// Throws InputError for a name that is none of perfetto, chrome, btf, csv.
[[nodiscard]] TraceFormat trace_format_of(std::string_view name);

// ui.perfetto.dev and trace_processor: a track a worker, a slice a node's call.
[[nodiscard]] std::string perfetto_trace(const TraceFile& trace);

// chrome://tracing, Perfetto, Speedscope: complete events, microseconds.
[[nodiscard]] std::string chrome_trace(const TraceFile& trace);

// Best Trace Format, as Eclipse APP4MC and Trace Compass read it: a task a group and worker, a
// runnable a node.
[[nodiscard]] std::string btf_trace(const TraceFile& trace);

// A row a span, for a spreadsheet or a notebook.
[[nodiscard]] std::string csv_trace(const TraceFile& trace);

[[nodiscard]] std::string exported(const TraceFile& trace, TraceFormat format);

}  // namespace glint

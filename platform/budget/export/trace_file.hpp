// A trace file in memory: who ran on which core, and every span of the run.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/rt/trace_span.hpp"

namespace glint {

struct TraceGroup {
  std::string name;
  std::vector<std::string> nodes;  // in the order of execution; copies as Name#i
  std::vector<int> cores;          // of each node
};

struct TraceFile {
  std::vector<TraceGroup> groups;
  std::int64_t epoch_unix_ns = 0;
  std::string board;  // empty: none
  std::string cell;
  std::vector<TraceSpan> spans;

  [[nodiscard]] std::string_view group_name(const TraceSpan& span) const;
  // The node's name; "release" or "send" for the spans that are of no node.
  [[nodiscard]] std::string_view node_name(const TraceSpan& span) const;
};

// Whether the span is a node's call, and neither a release nor a sending.
[[nodiscard]] constexpr bool is_node(const TraceSpan& span) {
  return (span.flags & (k_span_release | k_span_sent)) == 0;
}

// Throws InputError for a file that is no trace: where it stops being one, and what was expected.
// A cut last span is left out: a run that was ended early leaves one.
[[nodiscard]] TraceFile read_trace(const std::string& path);

// What ran from the release of the activation that decided this frame until it left: spans of all
// groups in that time. Throws InputError where no span is of that frame.
[[nodiscard]] TraceFile around_frame(const TraceFile& trace, std::uint32_t frame);

void write_trace(const std::string& path, const TraceFile& trace);

}  // namespace glint

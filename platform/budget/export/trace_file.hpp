// A trace file in memory: allocation of nodes to cores, and every span of the run.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/runtime/rt/trace_span.hpp"

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
  // Name of the node; "release" or "send" for spans without a node.
  [[nodiscard]] std::string_view node_name(const TraceSpan& span) const;
};

// Whether the span is a node's call; false: a release or a sending.
[[nodiscard]] constexpr bool is_node(const TraceSpan& span) {
  return (span.flags & (k_span_release | k_span_sent)) == 0;
}

// Throws InputError for a file that is no trace, with the position of the fault and what was
// expected. Skips a truncated last span, as an aborted run leaves one.
[[nodiscard]] TraceFile read_trace(const std::string& path);

// All groups' spans from the start of the activation that processed this frame until the frame was
// sent. Throws InputError if the frame has no span.
[[nodiscard]] TraceFile around_frame(const TraceFile& trace, std::uint32_t frame);

void write_trace(const std::string& path, const TraceFile& trace);

}  // namespace glint

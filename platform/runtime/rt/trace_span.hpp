// Record of one node execution in a trace, 40 bytes.
//
// A trace file (`trace.spans`) starts with a line of JSON that names groups, nodes and cores. Then
// these structs follow as in memory, little endian, in the order of their ends.
#pragma once

#include <cstdint>

namespace glint {

enum TraceFlag : std::uint8_t {
  k_span_overran = 1,    // the deadline had passed at this node's end
  k_span_will_miss = 2,  // the remaining nodes no longer fit before the deadline
  k_span_injected = 4,   // a delay was injected into this node
  k_span_release = 8,    // not a node: nominal release (begin) and wake-up (end) of the group
  k_span_sent = 16,      // not a node: the CAN writes of a tick
};

struct TraceSpan {
  std::uint64_t activation = 0;  // counts from 1
  std::int64_t begin_ns = 0;     // monotonic since the session's epoch
  std::int64_t end_ns = 0;
  std::uint32_t frame_sequence = 0;  // the low 32 bits
  std::uint8_t group = 0;            // 0 frame, 1 tick, 2 background
  std::uint8_t node = 0;  // index in the graph's order of execution, each copy separately
  std::uint8_t worker = 0;
  std::uint8_t flags = 0;     // TraceFlag
  std::int64_t bound_ns = 0;  // of this node on the board file in use; 0: no board file
};
static_assert(sizeof(TraceSpan) == 40);

}  // namespace glint

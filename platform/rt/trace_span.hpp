// When one node ran: what tracing an activation leaves, 40 bytes each.
//
// A trace file (`trace.spans`) is a line of JSON that names groups, nodes and cores, then these
// structs as they are in memory, little endian, in the order in which they ended.
#pragma once

#include <cstdint>

namespace glint {

enum TraceFlag : std::uint8_t {
  k_span_overran = 1,    // the deadline had passed at this node's end
  k_span_will_miss = 2,  // what remains no longer fits before the deadline
  k_span_injected = 4,   // a delay was injected into this node
  k_span_release = 8,    // no node: nominal release (begin) and wake-up (end) of the group
  k_span_sent = 16,      // no node: the CAN writes of a tick
};

struct TraceSpan {
  std::uint64_t activation = 0;  // counts from 1
  std::int64_t begin_ns = 0;     // monotonic since the session's epoch
  std::int64_t end_ns = 0;
  std::uint32_t frame_sequence = 0;  // the low 32 bits
  std::uint8_t group = 0;            // 0 frame, 1 tick, 2 background
  std::uint8_t node = 0;             // in the graph's order of execution, each copy by itself
  std::uint8_t worker = 0;
  std::uint8_t flags = 0;     // TraceFlag
  std::int64_t bound_ns = 0;  // of this node on the board in use; 0: no board
};
static_assert(sizeof(TraceSpan) == 40);

}  // namespace glint

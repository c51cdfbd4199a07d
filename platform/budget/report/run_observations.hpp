// What a trace shows: each activation from its release to its last node's end, each node's times,
// and each frame's way to the bus. Observed, every one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

inline constexpr std::size_t k_frames_of_trace = 0;  // of a trace's groups

struct Activation {
  std::uint64_t number = 0;
  std::uint32_t frame = 0;
  std::int64_t release_ns = 0;  // nominal; without a release span, its first node's begin
  std::int64_t end_ns = 0;      // of its last node
  std::uint8_t flags = 0;       // of all its spans
  std::vector<TraceSpan> nodes;

  [[nodiscard]] double response_us() const {
    return static_cast<double>(end_ns - release_ns) * 1e-3;
  }
};

struct NodeTimes {
  std::string group, node;
  std::vector<double> us;  // in the order in which they ended
  double bound_us = 0;     // the largest that its spans name; 0: none
  std::size_t above = 0;   // spans longer than the bound they name
};

struct FrameLatency {
  std::uint32_t frame = 0;
  double us = 0;            // release of the frame group to the return of the CAN write
  double computing_us = 0;  // of which until the last node's end
  std::uint64_t activation = 0;
};

struct RunObservations {
  std::vector<std::vector<Activation>> groups;  // by the trace's groups, in time
  std::vector<NodeTimes> nodes;                 // copies apart
  std::vector<FrameLatency> frames;             // those that reached the bus
  double duration_s = 0;
};

[[nodiscard]] RunObservations observe(const TraceFile& trace);

// Of activations by their response: the greatest and the median one. Null for none.
[[nodiscard]] const Activation* worst_of(const std::vector<Activation>& activations);
[[nodiscard]] const Activation* median_of(const std::vector<Activation>& activations);

}  // namespace glint

// Observations from a trace: each activation from release to the end of its last node, each node's
// times, and each frame's latency to the bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

inline constexpr std::size_t k_frame_group_of_trace = 0;  // index in a trace's groups

struct Activation {
  std::uint64_t number = 0;
  std::uint32_t frame = 0;
  std::int64_t release_ns = 0;  // nominal; without a release span: start of its first node
  std::int64_t end_ns = 0;      // of its last node
  std::uint8_t flags = 0;       // of all its spans
  std::vector<TraceSpan> nodes;

  [[nodiscard]] double response_us() const {
    return static_cast<double>(end_ns - release_ns) * 1e-3;
  }
};

struct NodeTimes {
  std::string group, node;
  std::vector<double> us;  // in order of their ends
  double bound_us = 0;     // largest bound in its spans; 0: none
  std::size_t above = 0;   // number of spans longer than their bound
};

struct FrameLatency {
  std::uint32_t frame = 0;
  double us = 0;            // release of the frame group to the return of the CAN write
  double computing_us = 0;  // part until the last node's end
  std::uint64_t activation = 0;
};

struct RunObservations {
  std::vector<std::vector<Activation>> groups;  // by the trace's groups, in order of time
  std::vector<NodeTimes> nodes;                 // each copy separately
  std::vector<FrameLatency> frames;             // that reached the bus
  double duration_s = 0;
};

[[nodiscard]] RunObservations observe(const TraceFile& trace);

// Activations with the maximum and the median response time; null if there is none.
[[nodiscard]] const Activation* worst_of(const std::vector<Activation>& activations);
[[nodiscard]] const Activation* median_of(const std::vector<Activation>& activations);

}  // namespace glint

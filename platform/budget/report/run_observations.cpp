#include "platform/budget/report/run_observations.hpp"

#include <algorithm>
#include <map>

namespace glint {
namespace {

double microseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

std::vector<Activation> activations_of(const TraceFile& trace, std::size_t group) {
  std::map<std::uint64_t, Activation> all;
  std::map<std::uint64_t, bool> released;
  for (const TraceSpan& span : trace.spans) {
    if (span.group != group || (span.flags & k_span_sent) != 0) continue;
    Activation& activation = all[span.activation];
    activation.number = span.activation;
    activation.frame = std::max(activation.frame, span.frame_sequence);
    activation.flags |= span.flags;
    if ((span.flags & k_span_release) != 0) {
      activation.release_ns = span.begin_ns;
      released[span.activation] = true;
      continue;
    }
    activation.nodes.push_back(span);
    activation.end_ns = std::max(activation.end_ns, span.end_ns);
  }
  std::vector<Activation> list;
  for (auto& [number, activation] : all) {
    if (activation.nodes.empty()) continue;
    std::sort(activation.nodes.begin(), activation.nodes.end(),
              [](const TraceSpan& a, const TraceSpan& b) { return a.begin_ns < b.begin_ns; });
    if (!released[number]) activation.release_ns = activation.nodes.front().begin_ns;
    list.push_back(std::move(activation));
  }
  return list;
}

// The latency of a frame ends with the first sending that carries it.
std::vector<FrameLatency> latencies_of(const TraceFile& trace,
                                       const std::vector<Activation>& activations) {
  std::map<std::uint32_t, std::int64_t> sent;
  for (const TraceSpan& span : trace.spans) {
    if ((span.flags & k_span_sent) == 0 || span.frame_sequence == 0) continue;
    const auto [place, is_new] = sent.try_emplace(span.frame_sequence, span.end_ns);
    if (!is_new) place->second = std::min(place->second, span.end_ns);
  }
  std::vector<FrameLatency> frames;
  for (const Activation& activation : activations) {
    const auto found = sent.find(activation.frame);
    if (found == sent.end() || found->second < activation.end_ns) continue;
    frames.push_back({activation.frame, microseconds(found->second - activation.release_ns),
                      activation.response_us(), activation.number});
  }
  return frames;
}

}  // namespace

RunObservations observe(const TraceFile& trace) {
  RunObservations seen;
  std::vector<std::size_t> first;  // each group's first node among seen.nodes
  for (const TraceGroup& group : trace.groups) {
    first.push_back(seen.nodes.size());
    for (const std::string& node : group.nodes) seen.nodes.push_back({group.name, node, {}, 0, 0});
  }
  for (const TraceSpan& span : trace.spans) {
    seen.duration_s = std::max(seen.duration_s, static_cast<double>(span.end_ns) * 1e-9);
    if (!is_node(span)) continue;
    NodeTimes& node = seen.nodes[first[span.group] + span.node];
    const double us = microseconds(span.end_ns - span.begin_ns);
    const double bound = microseconds(span.bound_ns);
    node.us.push_back(us);
    node.bound_us = std::max(node.bound_us, bound);
    if (bound > 0 && us > bound) ++node.above;
  }
  for (std::size_t group = 0; group < trace.groups.size(); ++group) {
    seen.groups.push_back(activations_of(trace, group));
  }
  if (!seen.groups.empty()) seen.frames = latencies_of(trace, seen.groups[k_frame_group_of_trace]);
  return seen;
}

const Activation* worst_of(const std::vector<Activation>& activations) {
  const auto found = std::max_element(
      activations.begin(), activations.end(),
      [](const Activation& a, const Activation& b) { return a.response_us() < b.response_us(); });
  return found == activations.end() ? nullptr : &*found;
}

const Activation* median_of(const std::vector<Activation>& activations) {
  if (activations.empty()) return nullptr;
  std::vector<const Activation*> order;
  for (const Activation& activation : activations) order.push_back(&activation);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  std::nth_element(
      order.begin(), middle, order.end(),
      [](const Activation* a, const Activation* b) { return a->response_us() < b->response_us(); });
  return *middle;
}

}  // namespace glint

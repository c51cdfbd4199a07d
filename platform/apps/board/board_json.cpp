#include "platform/apps/board/board_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "platform/runtime/session/background_json.hpp"
#include "platform/runtime/session/losses.hpp"
#include "platform/runtime/session/source_json.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const LatencyFigures& figures) {
  return {{"n", figures.n},
          {"p50", figures.p50_us},
          {"p99", figures.p99_us},
          {"p99_9", figures.p99_9_us},
          {"max", figures.max_us}};
}

// Percentiles of plain nanoseconds, by nearest rank.
Json spread_us(const std::vector<std::int64_t>& nanoseconds) {
  std::vector<FrameToCan> entries;
  entries.reserve(nanoseconds.size());
  for (const std::int64_t ns : nanoseconds) entries.push_back({{ns}, {}, {}});
  return as_json(figures_of_totals(entries));
}

std::int64_t largest(const std::vector<std::int64_t>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}
std::int64_t smallest(const std::vector<std::int64_t>& values) {
  return values.empty() ? 0 : *std::min_element(values.begin(), values.end());
}

Json recording_of(const SinkOutcome& sinks) {
  return {{"file", sinks.recording_file},       {"complete", sinks.recording.complete()},
          {"dropped", sinks.recording.dropped}, {"lost", sinks.recording.lost},
          {"reason", sinks.recording.reason},   {"messages", sinks.recording.messages},
          {"bytes", sinks.recording.bytes}};
}

// Output of the first tool, as in the decoded CAN log.
Json output_of(const SentTicksSummary& left) {
  const ToolTicks& tool = left.tools[0];
  return {{"ticks_sent", left.ticks},
          {"measured", tool.measured},
          {"predicted", tool.predicted},
          {"lost", tool.lost},
          {"none_yet", tool.none},
          {"longest_gap_ms", left.longest_gap.seconds() * 1e3},
          {"longest_without_measurement_ms", tool.longest_without_measurement.seconds() * 1e3}};
}

Json as_json(const CanErrorCounts& bus) {
  return {{"bus_off", bus.bus_off}, {"restarted", bus.restarted},
          {"passive", bus.passive}, {"overflow", bus.overflow},
          {"other", bus.other},     {"no_acknowledge", bus.no_acknowledge}};
}

Json losses_json(const SinkOutcome& result) {
  Json losses = Json::array();
  for (const Loss& loss : losses_of(result)) {
    losses.push_back({{"kind", loss.kind}, {"count", loss.count}, {"text", loss.text}});
  }
  return losses;
}

}  // namespace

Json as_json(const CompanionResult& result) {
  Json json{
      {"frames", result.frames},
      {"frames_worst", result.frames_worst},
      {"frames_tracked", result.frames_tracked},
      {"source", as_json(result.source)},
      {"ticks", result.ticks},
      {"ticks_late", result.ticks_late},
      {"ticks_skipped", result.ticks_skipped},
      {"frame_overruns", result.frame_overruns.total()},
      {"frame_overruns_noticed_ahead", result.frame_overruns.will_miss},
      {"tick_overruns", result.tick_overruns.total()},
      {"tick_overruns_noticed_ahead", result.tick_overruns.will_miss},
      {"ticks_not_enabled", result.tick_overruns.not_enabled},
      {"frame_to_can_us", as_json(figures_of_totals(result.latencies))},
      {"computing_us", as_json(figures_of(result.latencies, &FrameToCan::computing))},
      {"sampling_us", as_json(figures_of(result.latencies, &FrameToCan::sampling))},
      {"sending_us", as_json(figures_of(result.latencies, &FrameToCan::sending))},
      {"output", output_of(result.sent)},
      {"losses", losses_json(result)},
      {"latencies_left_out", result.latencies_overwritten},
      {"frame_wake_up_us", spread_us(result.frame_wake_up_ns)},
      {"tick_wake_up_us", spread_us(result.tick_wake_up_ns)},
      {"can",
       {{"frames", result.can_frames},
        {"sent", result.can.sent},
        {"dropped", result.can.dropped},
        {"failed", result.can.failed},
        {"sets_replaced", result.can.sets_replaced},
        {"bus_errors", as_json(result.can.bus)}}},
      {"can_input",
       {{"buttons", result.can_received.received},
        {"refused", result.can_received.refused},
        {"why_not", result.can_receive_error}}},
      {"dds",
       {{"offered", result.dds.offered},
        {"written", result.dds.written},
        {"ring_dropped", result.dds.ring_dropped},
        {"others_lost", result.dds.poses_and_transforms_lost},
        {"process_restarts", result.dds.process_restarts}}},
      {"heap_counted", result.heap_counted},
      {"heap_allocations", result.heap_allocations_after_start},
      {"page_faults", result.page_faults_after_start},
      {"output_sha256", result.output_sha256},
      {"decision_sha256", result.decision_sha256},
      {"best_effort", result.refused},
  };
  if (result.background) json["background"] = as_json(*result.background);
  if (!result.recording_file.empty()) json["recording"] = recording_of(result);
  return json;
}

Json as_json(const SystemShareFigures& figures) {
  return {
      {"kind", "estimate"},
      {"tick_wake_up_us", spread_us(figures.tick_wake_up_ns)},
      {"frame_wake_up_us", spread_us(figures.frame_wake_up_ns)},
      {"interrupt_us", spread_us(figures.interrupt_ns)},
      {"interrupt_gap_us", spread_us(figures.interrupt_gap_ns)},
      {"can_write_us", spread_us(figures.can_write_ns)},
      {"clock_read_ns", figures.clock_read_ns},
      {"system",
       {{"wake_up_ns",
         std::max(largest(figures.tick_wake_up_ns), largest(figures.frame_wake_up_ns))},
        {"interrupt_ns", largest(figures.interrupt_ns)},
        {"interrupt_gap_ns", smallest(figures.interrupt_gap_ns)},
        {"can_write_ns", largest(figures.can_write_ns)}}},
  };
}

}  // namespace glint

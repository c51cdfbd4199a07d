#include "platform/apps/glint/run_summary.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "kernels/angles.hpp"
#include "platform/apps/glint/run_output.hpp"
#include "platform/cells/correction_text.hpp"
#include "platform/runtime/session/background_json.hpp"
#include "platform/runtime/session/source_json.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const LatencyFigures& figures) {
  return {{"n", figures.n},
          {"p50", figures.p50_us},
          {"p99", figures.p99_us},
          {"p99_9", figures.p99_9_us},
          {"max", figures.max_us}};
}

// Null without poses.
ordered_json of_poses(const Accuracy& accuracy, double figure) {
  return accuracy.poses > 0 ? ordered_json(figure) : ordered_json(nullptr);
}

bool best_effort(const SessionResult& result) {
  return !result.refused.empty() || !result.machine.timing_faults.empty();
}

// Number of frames whose latency to the bus exceeded its bound.
std::int64_t above_bound(const RunSchedule& plan, const SessionResult& result) {
  if (plan.frame_to_can_bound_us <= 0) return 0;
  return std::count_if(
      result.latencies.begin(), result.latencies.end(), [&](const FrameToCan& entry) {
        return static_cast<double>(entry.total().nanoseconds) > plan.frame_to_can_bound_us * 1e3;
      });
}

ordered_json budget_of(const RunSchedule& plan, const SessionResult& result) {
  const OverrunCounts &frame = result.frame_overruns, &tick = result.tick_overruns;
  ordered_json by_policy;
  for (std::size_t p = 0; p < frame.by_policy.size(); ++p) {
    by_policy[std::string(name_of(static_cast<graph::OverrunPolicy>(p)))] =
        frame.by_policy[p] + tick.by_policy[p];
  }
  ordered_json bound;
  const auto add_bound = [&](const char* name, double us) {
    if (us > 0) bound[name] = us;
  };
  add_bound("frame", plan.frame_bound_us);
  add_bound("tick", plan.tick_bound_us);
  add_bound("background", plan.background_bound_us);
  add_bound("frame_to_can", plan.frame_to_can_bound_us);
  return {{"board", plan.board},
          {"plan", plan.plan_file},
          {"bound_us", bound.is_null() ? ordered_json::object() : bound},
          {"caveats", plan.caveats},
          {"frames_above_bound", above_bound(plan, result)},
          {"overruns",
           {{"frame", frame.total()},
            {"tick", tick.total()},
            {"will_miss", frame.will_miss + tick.will_miss},
            {"missed", frame.missed + tick.missed},
            {"by_policy", by_policy}}},
          {"page_faults_after_start", result.page_faults_after_start},
          {"trace_spans", result.trace_spans},
          {"trace_dropped", result.trace_dropped},
          {"preempt_rt", result.machine.preempt_rt},
          {"best_effort", result.machine.timing_faults}};
}

ordered_json tool_orders(const Cell& cell, const SessionResult& result) {
  ordered_json list = ordered_json::array();
  for (std::size_t t = 0; t < result.tool_change_counts.size(); ++t) {
    const auto [added, removed] = result.tool_change_counts[t];
    const std::string tool = cell.tools.items[t].name.data();
    if (added + removed > 0)
      list.push_back({{"tool", tool}, {"added", added}, {"removed", removed}});
  }
  return {{"allowed", cell.dds.allow[DdsInput::tools]}, {"by_tool", list}};
}

ordered_json refusals_json(const InputRefusals& refusals) {
  ordered_json list = ordered_json::object();
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    list[k_dds_input_names[i]] = {{"not_allowed", refusals.not_allowed[i]},
                                  {"too_fast", refusals.too_fast[i]}};
  }
  return list;
}

// Noise beyond that of a marker's own pixels, 1 sigma.
ordered_json noise_json(const Cell& cell, const SessionResult& result) {
  const MarkerNoise declared{cell.camera.range_sigma_m, cell.camera.pixel_sigma_px};
  const MarkerNoise noise = noise_now(result.noise, declared);
  return {{"estimated", result.noise.has_residuals},
          {"range_sigma_mm", 1e3 * noise.range_sigma_m},
          {"pixel_sigma_px", noise.pixel_sigma_px}};
}

ordered_json calibration_json(const SessionResult& result) {
  ordered_json list = ordered_json::array();
  for (const CalibrationFinding& finding : result.calibration) {
    const ErrorUnit unit = unit_of(finding.source);
    list.push_back({{"tool", finding.tool},
                    {"source", name_of(finding.source)},
                    {"unit", unit.text},
                    {"estimate", unit.per_base * finding.estimate},
                    {"sigma", unit.per_base * finding.sigma},
                    {"range_mm", 1e3 * finding.range_m},
                    {"stated_sigmas", finding.size_in_stated_sigmas},
                    {"named", finding.exceeds_stated}});
  }
  return list;
}

}  // namespace

ordered_json summary_of(const Cell& cell, const RunSchedule& plan, const SessionResult& result) {
  const Accuracy& accuracy = result.accuracy;
  ordered_json frame_to_can = as_json(figures_of_totals(result.latencies));
  frame_to_can["computing"] = as_json(figures_of(result.latencies, &FrameToCan::computing));
  frame_to_can["sampling"] = as_json(figures_of(result.latencies, &FrameToCan::sampling));
  frame_to_can["sending"] = as_json(figures_of(result.latencies, &FrameToCan::sending));
  ordered_json summary{
      {"cell", cell.file},
      {"camera", cell.camera.name},
      {"duration_s", result.duration_s},
      {"realtime", cell.realtime},
      {"workers", cell.workers},
      {"frames", result.frames},
      {"frames_tracked", result.frames_tracked},
      {"source", as_json(result.source)},
      {"marker_noise", noise_json(cell, result)},
      {"calibration", calibration_json(result)},
      {"frames_refused", accuracy.refused},
      {"frames_late_rendered", result.frames_late},
      {"ticks_source_late", result.ticks_source_late},
      {"output", output_of(cell, result)},
      {"frames_trackable", accuracy.trackable},
      {"tracked_fraction", accuracy.tracked_fraction()},
      {"poses", accuracy.poses},
      {"poses_gross", accuracy.gross},
      {"tip_rms_mm", of_poses(accuracy, accuracy.tip_rms_m * 1e3)},
      {"tip_max_mm", of_poses(accuracy, accuracy.tip_max_m * 1e3)},
      {"angle_rms_deg", of_poses(accuracy, accuracy.angle_rms_rad * k_degrees_per_radian)},
      {"ticks", result.ticks},
      {"ticks_late", result.ticks_late},
      {"ticks_skipped", result.ticks_skipped},
      {"worker_overruns", result.worker_overruns},
      {"frame_to_can_us", frame_to_can},
      {"frame_to_can_kind", cell.realtime ? "observed" : "nominal"},
      {"heap_allocations_after_start", result.heap_allocations_after_start},
      {"heap_allocations_counted", result.heap_counted},
      {"can_frames", result.can_frames},
      {"can_sent", result.can.sent},
      {"can_dropped", result.can.dropped},
      {"can_failed", result.can.failed},
      {"can_sets_replaced", result.can.sets_replaced},
      {"can_bus_off", result.can.bus.bus_off},
      {"can_bus_load", result.can_bus_load},
      {"key_events", result.key_events},
      {"can_input",
       {{"buttons", result.can_received.received},
        {"refused", result.can_received.refused},
        {"why_not", result.can_receive_error}}},
      {"dds_offered", result.dds.offered},
      {"dds_written", result.dds.written},
      {"ring_dropped", result.dds.ring_dropped},
      {"dds_others_lost", result.dds.poses_and_transforms_lost},
      {"dds_process_lost", result.dds.process_lost},
      {"dds_process_restarts", result.dds.process_restarts},
      {"dds_process_end", result.dds_process_end},
      {"dds_received", result.dds_reader.received},
      {"dds_missed", result.dds_reader.missed},
      {"dds_poses_written", result.dds.poses_written},
      {"dds_poses_received", result.dds_reader.poses_received},
      {"dds_input",
       {{"joint_states", result.dds_received.joints},
        {"robot_descriptions", result.dds_received.descriptions},
        {"initial_poses", result.dds_received.guesses},
        {"buttons", result.dds_received.buttons},
        {"tools", result.dds_received.tools},
        {"refused", result.dds_received.refused},
        {"lost", result.dds_received.lost},
        {"refused_by_name", refusals_json(result.dds_received.refusals)}}},
      {"recording", result.recording_file},
      {"recording_complete", result.recording.complete()},
      {"recording_ended_early", result.recording.ended_early},
      {"recording_reason", result.recording.reason},
      {"recording_bytes", result.recording.bytes},
      {"recording_dropped", result.recording.dropped},
      {"recording_lost", result.recording.lost},
      {"files_lost", result.files_lost},
      {"losses", losses_json(result)},
      {"failures", failures_of(result)},
      {"output_sha256", result.output_sha256},
      {"notices", cell.warnings},
      {"corrected", correction_text(cell.correction)},
      {"best_effort", best_effort(result)},
      {"refused", result.refused},
      {"budget", budget_of(plan, result)}};
  summary["can_input"]["released"] = result.can_received.released;
  summary["dds_input"]["released"] = result.dds_received.released;
  if (const auto& server = result.openigtlink) {
    summary["openigtlink"] = {{"offered", server->offered},
                              {"messages", server->messages},
                              {"sent", server->sent},
                              {"missed", server->missed},
                              {"ring_dropped", server->ring_dropped},
                              {"clients", server->clients},
                              {"refused", server->refused}};
  }
  summary["dds_tool_changes"] = tool_orders(cell, result);
  if (result.background) summary["background"] = as_json(*result.background);
  return summary;
}

}  // namespace glint

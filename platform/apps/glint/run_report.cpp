#include "platform/apps/glint/run_report.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "kernels/angles.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/run_output.hpp"
#include "platform/cells/correction_text.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/session/background_json.hpp"
#include "platform/runtime/session/source_json.hpp"
#include "platform/tools/report/plots.hpp"

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

void row(const char* name, const std::string& value) {
  std::printf("  %-30s %s\n", name, printable(value).c_str());
}

std::string fixed(double value, int digits, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f %s", digits, value, unit);
  return text;
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

void latency_row(const char* name, const ordered_json& item) {
  if (item.at("n") == 0) return row(name, "-");
  char text[128];
  std::snprintf(text, sizeof text, "p50 %.0f  p99 %.0f  p99.9 %.0f  max %.0f us",
                item.at("p50").get<double>(), item.at("p99").get<double>(),
                item.at("p99_9").get<double>(), item.at("max").get<double>());
  row(name, text);
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

void tool_order_rows(const ordered_json& orders) {
  for (const auto& one : orders.at("by_tool")) {
    row("tool changes over DDS", one.at("tool").get<std::string>() + ": added " +
                                     one.at("added").dump() + " times, removed " +
                                     one.at("removed").dump());
  }
}

ordered_json refusals_json(const InputRefusals& refusals) {
  ordered_json list = ordered_json::object();
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    list[k_dds_input_names[i]] = {{"not_allowed", refusals.not_allowed[i]},
                                  {"too_fast", refusals.too_fast[i]}};
  }
  return list;
}

std::string released_text(std::uint64_t released) {
  return released == 0 ? ""
                       : "; " + std::to_string(released) + " released after their sender's loss";
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
  summary["dds_tool_changes"] = tool_orders(cell, result);
  if (result.background) summary["background"] = as_json(*result.background);
  return summary;
}

void print_table(const ordered_json& summary, const SessionResult& result) {
  const Accuracy& accuracy = result.accuracy;
  std::printf("\n%s, %.1f s%s\n", summary.at("camera").get<std::string>().c_str(),
              result.duration_s, best_effort(result) ? "  (best effort: see `this machine`)" : "");
  for (const auto& [name, value] : output_rows(summary, result)) row(name.c_str(), value);
  row("frames",
      std::to_string(result.frames) + " (" + std::to_string(accuracy.refused) + " refused)");
  row("tracked", (accuracy.trackable > 0 ? fixed(100 * accuracy.tracked_fraction(), 2, "%") : "-") +
                     " of " + std::to_string(accuracy.trackable) + " trackable");
  if (accuracy.poses > 0) {
    row("gross poses", std::to_string(accuracy.gross) + " of " + std::to_string(accuracy.poses));
    row("tip error, rms", fixed(accuracy.tip_rms_m * 1e3, 2, "mm") + "  (largest " +
                              fixed(accuracy.tip_max_m * 1e3, 1, "mm)"));
    row("angle error, rms", fixed(accuracy.angle_rms_rad * k_degrees_per_radian, 2, "deg"));
  } else {
    for (const char* name : {"gross poses", "tip error, rms", "angle error, rms"}) row(name, "-");
  }
  const ordered_json& latency = summary.at("frame_to_can_us");
  const std::string kind = summary.at("frame_to_can_kind").get<std::string>();
  latency_row(("frame to CAN (" + kind + ")").c_str(), latency);
  latency_row("  computing", latency.at("computing"));
  latency_row("  sampling", latency.at("sampling"));
  latency_row("  sending", latency.at("sending"));
  const ordered_json& budget = summary.at("budget");
  for (const auto& [name, us] : budget.at("bound_us").items()) {
    row(name == "frame_to_can" ? "  bound, frame to CAN" : "  bound, group",
        fixed(us.get<double>(), 0, "us") + " (" + name + ")");
  }
  if (const auto above = budget.at("frames_above_bound").get<std::int64_t>(); above > 0) {
    row("  ABOVE THE BOUND", std::to_string(above) + " of " +
                                 std::to_string(result.latencies.size()) +
                                 " frames: the bound does not hold");
  }
  for (const auto& caveat : budget.at("caveats")) row("  caveat", caveat.get<std::string>());
  const auto overruns = [](const OverrunCounts& counts) {
    return std::to_string(counts.missed) + " missed, " + std::to_string(counts.will_miss) +
           " predicted";
  };
  row("overruns, frame", overruns(result.frame_overruns));
  row("overruns, tick", overruns(result.tick_overruns));
  row("ticks", std::to_string(result.ticks) + " (" + std::to_string(result.ticks_late) + " late, " +
                   std::to_string(result.ticks_skipped) + " skipped)");
  if (const auto& background = result.background) {
    row("background slices", std::to_string(background->slices) + " (" +
                                 std::to_string(background->late) + " late, " +
                                 std::to_string(background->skipped) + " skipped), longest " +
                                 fixed(background->longest_response.seconds() * 1e6, 0, "us"));
    row("map", std::to_string(background->map.smoothed) + " points on " +
                   std::to_string(background->map.planes) + " planes, of " +
                   std::to_string(background->map.voxels) + " voxels in " +
                   std::to_string(background->map.pictures) + " images (" +
                   std::to_string(background->images_missed) + " missed)");
    const RobotProgress& robot = background->robot;
    if (robot.last != FollowOutcome::no_reference) {
      row("robot", "followed in " + std::to_string(robot.followed) + " images, " +
                       std::to_string(robot.jumps) + " jumps rejected, " +
                       std::to_string(robot.inconclusive) + " inconclusive");
      if (background->joints_used + background->joints_skipped > 0) {
        row("robot's joints", "from " + std::to_string(background->joints_used) + " states, " +
                                  std::to_string(background->joints_skipped) + " skipped; " +
                                  std::to_string(background->images_without_joints) +
                                  " images without current joints");
      }
    }
  }
  row("heap allocations after start", result.heap_counted
                                          ? std::to_string(result.heap_allocations_after_start)
                                          : "not counted (live runs only)");
  row("page faults after start", std::to_string(result.page_faults_after_start));
  row("CAN frames", std::to_string(result.can.sent) + " sent, " +
                        std::to_string(result.can.failed) + " refused, " +
                        std::to_string(result.can.dropped) + " dropped, " +
                        std::to_string(result.can.bus.bus_off) + " times off the bus (bus load " +
                        fixed(100 * result.can_bus_load, 1, "%, computed)"));
  if (const ButtonFrameCounts& received = result.can_received; received.any()) {
    row("received over CAN", std::to_string(received.received) + " frames of buttons; " +
                                 std::to_string(received.refused) + " refused" +
                                 released_text(received.released));
  }
  if (!result.can_receive_error.empty()) row("no input over CAN", result.can_receive_error);
  if (result.key_events > 0) row("buttons by key", std::to_string(result.key_events) + " changes");
  const auto of_reader = [&](std::uint64_t count) {
    return result.dds_reader_error.empty() ? std::to_string(count) : "-";
  };
  row("DDS",
      std::to_string(result.dds.written) + " written, " + of_reader(result.dds_reader.received) +
          " received, " + of_reader(result.dds_reader.missed) + " missed, " +
          std::to_string(result.dds.ring_dropped) + " dropped" +
          (result.dds.process_restarts == 0
               ? ""
               : "; process restarted " + std::to_string(result.dds.process_restarts) + " times"));
  if (const ReceivedCounts& received = result.dds_received; received.any()) {
    row("received over DDS", std::to_string(received.joints) + " joint states, " +
                                 std::to_string(received.descriptions) + " descriptions, " +
                                 std::to_string(received.guesses) + " initial poses, " +
                                 std::to_string(received.buttons) + " buttons, " +
                                 std::to_string(received.tools) + " tools; " +
                                 std::to_string(received.refused) + " refused" +
                                 released_text(received.released));
  }
  if (const std::string text = text_of(result.dds_received.refusals); !text.empty()) {
    row("REFUSED over DDS", text);
  }
  tool_order_rows(summary.at("dds_tool_changes"));
  row("output_sha256", result.output_sha256);
  print_files(result, 0);
  for (const auto& notice : summary.at("notices")) row("this cell", notice.get<std::string>());
  if (const auto text = summary.at("corrected").get<std::string>(); !text.empty())
    row("corrected by", text);
  for (const CalibrationFinding& finding : result.calibration) {
    if (finding.exceeds_stated) row("CALIBRATION", text_of(finding));
  }
  for (const std::string& refused : result.refused) row("refused", refused);
  for (const std::string& line : result.machine.timing_faults) row("this machine", line);
}

void print_files(const SessionResult& result, std::size_t first) {
  for (std::size_t f = first; f < result.files.size(); ++f) {
    if (std::filesystem::is_regular_file(result.files[f])) row("written", result.files[f]);
  }
}

void draw_plots(const std::string& folder, SessionResult& result) {
  const Accuracy& accuracy = result.accuracy;
  if (!accuracy.tip_errors_m.empty()) {
    std::vector<double> mm;
    for (const double error : accuracy.tip_errors_m) mm.push_back(error * 1e3);
    const HistogramSeries series{
        "tip", make_histogram(mm, 0, std::max(1.0, percentile(mm, 0.999)), 60), {}};
    const std::string path = (std::filesystem::path(folder) / "tip_error.svg").string();
    write_text(path, histogram_plot({"Tip error against truth, camera frame", "mm", "share"},
                                    {&series, 1}));
    result.files.push_back(path);
  }
  if (!accuracy.path_seen_m.empty()) {
    const TrajectorySeries series[] = {{"truth", accuracy.path_truth_m},
                                       {"tracked", accuracy.path_seen_m}};
    const std::string path = (std::filesystem::path(folder) / "tip_path.svg").string();
    write_text(path, trajectory_plot("The pen's tip, world", series));
    result.files.push_back(path);
  }
  if (!result.latencies.empty()) {
    std::vector<double> us;
    for (const FrameToCan& entry : result.latencies) {
      us.push_back(static_cast<double>(entry.total().nanoseconds) * 1e-3);
    }
    const std::string path = (std::filesystem::path(folder) / "frame_to_can.svg").string();
    write_text(path, latency_plot("Frame to CAN, observed", us));
    result.files.push_back(path);
  }
}

}  // namespace glint

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
#include "platform/printable.hpp"
#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

void row(const char* name, const std::string& value) {
  std::printf("  %-30s %s\n", name, printable(value).c_str());
}

std::string fixed(double value, int digits, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f %s", digits, value, unit);
  return text;
}

void latency_row(const char* name, const ordered_json& item) {
  if (item.at("n") == 0) return row(name, "-");
  char text[128];
  std::snprintf(text, sizeof text, "p50 %.0f  p99 %.0f  p99.9 %.0f  max %.0f us",
                item.at("p50").get<double>(), item.at("p99").get<double>(),
                item.at("p99_9").get<double>(), item.at("max").get<double>());
  row(name, text);
}

void tool_order_rows(const ordered_json& orders) {
  for (const auto& one : orders.at("by_tool")) {
    row("tool changes over DDS", one.at("tool").get<std::string>() + ": added " +
                                     one.at("added").dump() + " times, removed " +
                                     one.at("removed").dump());
  }
}

std::string released_text(std::uint64_t released) {
  return released == 0 ? ""
                       : "; " + std::to_string(released) + " released after their sender's loss";
}

}  // namespace

void print_table(const ordered_json& summary, const SessionResult& result) {
  const Accuracy& accuracy = result.accuracy;
  std::printf("\n%s, %.1f s%s\n", summary.at("camera").get<std::string>().c_str(),
              result.duration_s,
              summary.at("best_effort").get<bool>() ? "  (best effort: see `this machine`)" : "");
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
  if (const auto& server = result.openigtlink) {
    row("OpenIGTLink", std::to_string(server->sent) + " messages to " +
                           std::to_string(server->clients) + " clients, " +
                           std::to_string(server->lost()) + " lost; " +
                           std::to_string(server->refused) + " clients refused");
  }
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

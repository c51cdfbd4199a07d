// glint replay: recomputes a recording and compares its output, or tracks a tool in marker points.
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/losses_json.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/apps/glint/replay_view.hpp"
#include "platform/apps/glint/view_option.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/session/replay.hpp"
#include "platform/tools/inspect/label_path.hpp"
#include "platform/tools/inspect/replay_points.hpp"

namespace glint {
namespace {

struct ReplayArguments {
  std::string recording, points, tool, json;
  int workers = 1;
  ReadTolerance tolerance;
  ViewArguments view;
  double speed = 1;
};

int replay_recording(const ReplayArguments& arguments) {
  Progress progress("replaying");
  ReplayOptions options;
  options.workers = arguments.workers;
  options.tolerance = arguments.tolerance;
  options.progress = [&](double seconds) { progress.show(seconds, 0); };
  const ReplayResult result = replay(arguments.recording, options);
  progress.clear();
  std::printf("level            %s\nframes           %lld\nticks            %lld\n",
              printable(result.level).c_str(), static_cast<long long>(result.frames),
              static_cast<long long>(result.ticks));
  std::printf(
      "records          %lld (recorded %lld, compared %lld, differing %lld)\n",
      static_cast<long long>(result.records), static_cast<long long>(result.records_recorded),
      static_cast<long long>(result.records_compared), static_cast<long long>(result.mismatches));
  const bool lost = result.losses.any();
  if (lost) std::printf("missing          %s\n", text_of(result.losses).c_str());
  std::printf(
      "output_sha256    %s\n"
      "recorded sha256  %s  %s%s\n",
      result.output_sha256.c_str(),
      result.recorded_sha256.empty() ? "(none)" : printable(result.recorded_sha256).c_str(),
      result.agrees() ? "equal" : "DIFFERENT",
      lost && result.agrees() ? " for the compared records" : "");
  if (result.first_mismatch >= 0) {
    std::printf("first difference at record %lld\n", static_cast<long long>(result.first_mismatch));
  }
  write_json(arguments.json, {{"level", result.level},
                              {"frames", result.frames},
                              {"ticks", result.ticks},
                              {"workers", arguments.workers},
                              {"overruns", result.overruns},
                              {"records", result.records},
                              {"records_recorded", result.records_recorded},
                              {"records_compared", result.records_compared},
                              {"records_differing", result.mismatches},
                              {"first_difference", result.first_mismatch},
                              {"versions_missing", result.versions_missing},
                              {"missing", losses_json(result.losses)},
                              {"output_sha256", result.output_sha256},
                              {"recorded_sha256", result.recorded_sha256},
                              {"agrees", result.agrees()}});
  return result.agrees() && !lost ? 0 : 1;
}

int replay_to_view(const ReplayArguments& arguments) {
  const ViewedRecording result = view_recording(arguments.recording, arguments.tolerance,
                                                arguments.view.settings, arguments.speed);
  std::printf("messages   %llu of %.1f s%s\n", static_cast<unsigned long long>(result.messages),
              result.seconds, result.stopped ? ", stopped by a signal" : "");
  if (result.skipped > 0) {
    std::printf("skipped    %llu messages that are not CDR\n",
                static_cast<unsigned long long>(result.skipped));
  }
  if (result.lost) std::printf("missing    messages of a damaged or truncated file\n");
  print_view(result.view);
  write_json(arguments.json, {{"messages", result.messages},
                              {"skipped", result.skipped},
                              {"seconds", result.seconds},
                              {"stopped", result.stopped},
                              {"missing", result.lost},
                              {"view", view_json(result.view)}});
  return result.lost || result.skipped > 0 ? 1 : 0;
}

int replay_marker_points(const ReplayArguments& arguments) {
  if (arguments.tool.empty()) {
    throw InputError("--points " + arguments.points + ": no --tool; expected a tool file");
  }
  const PointsResult result = replay_points(arguments.points, arguments.tool);
  const auto frames = static_cast<std::int64_t>(result.frames.size());
  std::printf(
      "frames     %lld\nsolved     %lld\nambiguous  %lld\nrms        mean %.3f mm, largest %.3f "
      "mm\n",
      static_cast<long long>(frames), static_cast<long long>(result.solved),
      static_cast<long long>(result.ambiguous), result.rms_mean_m * 1e3, result.rms_max_m * 1e3);
  if (result.solved > 0)
    std::printf("margin     chi-square to the next pose: least %.1f; ambiguous below %.1f\n",
                result.margin_min, k_margin_min);
  nlohmann::ordered_json poses = nlohmann::ordered_json::array();
  for (const PointPose& pose : result.frames) {
    nlohmann::ordered_json item{{"time_s", static_cast<double>(pose.time.nanoseconds) * 1e-9},
                                {"solved", pose.solved}};
    if (pose.solved) {
      const Vector3& t = pose.pose.translation;
      const Quaternion& q = pose.pose.rotation;
      item["rms_mm"] = pose.rms_m * 1e3;
      item["margin"] = pose.margin;  // null: no alternative pose
      item["marker_mask"] = pose.marker_mask;
      item["position_m"] = {t.x(), t.y(), t.z()};
      item["rotation_xyzw"] = {q.x(), q.y(), q.z(), q.w()};
      item["tip_m"] = {pose.tip_m.x(), pose.tip_m.y(), pose.tip_m.z()};
    } else {
      item["reason"] = std::string(name_of(pose.reason));
      if (pose.reason == Reason::ambiguous) item["margin"] = pose.margin;
    }
    poses.push_back(std::move(item));
  }
  write_json(arguments.json, {{"frames", frames},
                              {"solved", result.solved},
                              {"ambiguous", result.ambiguous},
                              {"margin_min", result.margin_min},
                              {"margin_limit", k_margin_min},
                              {"rms_mean_mm", result.rms_mean_m * 1e3},
                              {"rms_max_mm", result.rms_max_m * 1e3},
                              {"poses", std::move(poses)}});
  return result.solved == frames ? 0 : 1;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "replay", "Track a recording again and compare every output record, byte for byte");
  auto arguments = std::make_shared<ReplayArguments>();
  command->footer(
      "Examples:\n"
      "  glint replay out/run.mcap --workers 2 --json replay.json\n"
      "  glint replay out/run.mcap --view --speed 0.5\n"
      "  glint replay --points markers.csv --tool probe.toml --json poses.json\n"
      "markers.csv: time_s,x_m,y_m,z_m, one unlabelled marker a row. Frames less than 0.16 s apart "
      "are solved\n"
      "together. A frame with a second pose that is nearly as likely is `ambiguous`: exit code 1.");
  command->add_option("recording", arguments->recording, "recording of `glint run`");
  command->add_option("--points", arguments->points, "marker positions without images (CSV)");
  command->add_option("--tool", arguments->tool,
                      "tool in --points: file (.toml, .rom, .ini) or pen (built in)");
  command->add_option("--workers", arguments->workers, "threads, 1 or 2: equal records")
      ->check(in_range(1, 2));
  command->add_flag("--allow-truncated", arguments->tolerance.truncated,
                    "read the undamaged records of a truncated or damaged file, count the missing "
                    "ones; exit code 1");
  command->add_flag("--allow-incomplete", arguments->tolerance.incomplete,
                    "read a recording with dropped messages or an early end");
  command->add_option("--json", arguments->json, "file of the figures");
  auto* const view = add_view_option(*command, arguments->view);
  view->excludes("--points")->excludes("--workers");
  view->description(
      "shows the recorded messages in real time instead of tracking: port of the live view's page "
      "and WebSocket; default 8765");
  command
      ->add_option("--speed", arguments->speed, "of --view: 2 shows a recording in half its time")
      ->needs(view)
      ->check(in_range(0.01, 100.0))
      ->capture_default_str();
  command->callback([arguments, &exit_code] {
    if (arguments->recording.empty() == arguments->points.empty()) {
      throw InputError("replay: expected either a recording or --points FILE");
    }
    if (arguments->view.wanted) {
      exit_code = replay_to_view(*arguments);
      return;
    }
    exit_code =
        arguments->points.empty() ? replay_recording(*arguments) : replay_marker_points(*arguments);
  });
}

}  // namespace glint

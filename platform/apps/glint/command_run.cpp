// glint run: frames in, poses out over DDS and CAN, everything recorded. glint track: the same for
// recorded frames, as fast as possible.
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/headset_option.hpp"
#include "platform/apps/glint/lab_program.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/planned_run.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/apps/glint/run_commands.hpp"
#include "platform/apps/glint/run_output.hpp"
#include "platform/apps/glint/run_report.hpp"
#include "platform/apps/glint/run_summary.hpp"
#include "platform/apps/glint/shard_option.hpp"
#include "platform/apps/glint/track_folder.hpp"
#include "platform/apps/glint/view_option.hpp"
#include "platform/cells/cell.hpp"
#include "platform/folder_lock.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/node_probe.hpp"
#include "platform/runtime/session/simulated_run.hpp"
#include "platform/sinks/view/foxglove_server.hpp"
#include "platform/sources/open_live_source.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/stop_signals.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"
#include "platform/tools/programming/key_buttons.hpp"
#include "platform/tools/programming/key_terminal.hpp"
#include "platform/tools/viewer/viewer_messages.hpp"

namespace glint {
namespace {

struct RunArguments {
  std::string config, json, out = "out", can, level;
  double duration_s = 0;
  int workers = 0;
  bool as_fast_as_can_be = false;
  bool no_dds = false;
  std::string name;
  std::string method = "glint";
  std::string board, plan;
  std::vector<std::string> inject;
  bool trace = false;
  bool keys = false;
  ViewArguments view;
  HeadsetArguments headset;
  double source_frame_ms = 0;
  bool recorded = false;  // glint track
  std::string source, kind;
  ReadTolerance tolerance;
  BaselineFactory baseline;
  bool one_of_many = false;  // a recording of a folder: its table is not printed
};

Cell cell_of(const RunArguments& arguments) {
  Cell cell = arguments.recorded ? recorded_source_cell(arguments.source, arguments.config,
                                                        arguments.kind, arguments.tolerance)
                                 : cell_or_default(arguments.config);
  if (!arguments.can.empty()) cell.can.sink = arguments.can;
  if (!arguments.level.empty()) cell.record.level = arguments.level;
  if (arguments.duration_s > 0) cell.simulator.duration_s = arguments.duration_s;
  if (arguments.workers > 0) cell.workers = arguments.workers;
  if (arguments.as_fast_as_can_be) cell.realtime = false;
  if (arguments.no_dds) cell.dds.on = false;
  if (!arguments.name.empty()) cell.dds.name = arguments.name;
  if (arguments.method != "glint") {
    cell.method = Method::baseline;
    cell.record.level = "outputs";  // a run of the baseline cannot be replayed
  }
  return cell;
}

// Reads keys and prints their functions; does nothing without --keys.
void open_key_terminal(const RunArguments& arguments, const Cell& cell,
                       std::optional<KeyTerminal>& terminal) {
  if (!arguments.keys) return;
  if (!cell.realtime)
    throw InputError("--keys: the run is not in real time; expected realtime = true and no --fast");
  terminal.emplace(STDIN_FILENO, "--keys: standard input");
  std::printf("keys: %s\n", k_keys_text);
  std::fflush(stdout);
}

// The live view of a run's recorded messages; null without --view.
std::unique_ptr<FoxgloveServer> open_view(const RunArguments& arguments, const Cell& cell) {
  if (!arguments.view.wanted) return nullptr;
  if (cell.record.file.empty()) {
    throw InputError(cell.file +
                     ": --view shows the messages of the run's recording; expected "
                     "record.file");
  }
  return start_view(arguments.view.settings);
}

PicturesTo pictures_to(const Cell& cell, bool is_viewed) {
  if (cell.record.pictures) return PicturesTo::file_and_observer;
  return is_viewed ? PicturesTo::observer : PicturesTo::none;
}

// A write that fails, as on a full disk, loses only its own file.
bool written(const std::function<void()>& write, SessionResult& result) {
  try {
    write();
  } catch (const InputError& error) {
    result.not_written.push_back(error.what());
    return false;
  }
  return true;
}

// Writes the figures first, the plots last.
int report(const Cell& cell, const SessionOptions& options, const RunArguments& arguments,
           const FoxgloveServer* view, SessionResult& result) {
  const auto write_summary = [&] {
    nlohmann::ordered_json summary = summary_of(cell, options.plan, result);
    if (view != nullptr) summary["view"] = view_json(view->counts());
    if (result.headset) summary["headset"] = headset_json(*result.headset);
    write_json(arguments.json, summary);
  };
  (void)written(write_summary, result);
  if (!arguments.one_of_many) print_table(summary_of(cell, options.plan, result), result);
  if (view != nullptr) print_view(view->counts());
  if (result.headset) print_headset(*result.headset);
  const std::size_t printed = result.files.size();
  const bool plotted = written([&] { draw_plots(options.out, result); }, result);
  if (!arguments.one_of_many) print_files(result, printed);
  if (!plotted) (void)written(write_summary, result);
  const std::vector<std::string> failures = failures_of(result);
  std::fflush(stdout);
  for (const std::string& line : failures) std::fprintf(stderr, "glint: %s\n", line.c_str());
  return failures.empty() ? 0 : 1;
}

int run(const RunArguments& arguments) {
  Cell cell = cell_of(arguments);
  if (cell.method == Method::baseline && !arguments.baseline) start_lab();
  const std::atomic<bool>& stop = stop_on_signals();
  const auto duration_ns = static_cast<std::int64_t>(std::llround(arguments.duration_s * 1e9));
  const std::unique_ptr<FrameSource> source =
      open_source(cell, arguments.tolerance, {Duration{duration_ns}, &stop});
  SessionOptions options;
  options.plan = planned_run(cell, arguments.board, arguments.plan);
  for (const std::string& text : arguments.inject) {
    options.injections.push_back(injection_of(text));
  }
  options.trace = arguments.trace;
  options.method = arguments.baseline;
  options.stop = &stop;
  std::optional<KeyTerminal> terminal;
  open_key_terminal(arguments, cell, terminal);
  if (terminal) options.key_terminal = terminal->descriptor();
  make_folder(arguments.out);
  make_folder_of(arguments.json);
  ReservedDiskSpace room(arguments.json);
  const FolderLock lock(arguments.out);
  const std::unique_ptr<FoxgloveServer> view = open_view(arguments, cell);
  options.observer = view.get();
  const std::unique_ptr<HeadsetServer> headset = open_headset(arguments.headset, cell);
  options.headset = headset.get();
  ViewerMessages viewer_messages(cell, pictures_to(cell, view != nullptr));
  options.derived = &viewer_messages;
  Progress progress("tracking");
  options.out = arguments.out;
  options.progress = [&](double done_s, double all_s) { progress.show(done_s, all_s); };
  options.preparing = [&](int rendered, int wanted) {
    progress.show(0, 1,
                  "rendered in advance: " + std::to_string(rendered) + " of " +
                      std::to_string(wanted) + " frames");
  };
  const Duration frame_time{static_cast<std::int64_t>(arguments.source_frame_ms * 1e6)};
  SessionResult result = run_source(cell, source.get(), options, frame_time);
  progress.clear();
  room.release();
  if (view != nullptr) view->close();
  if (headset != nullptr) {
    headset->close();
    result.headset = headset->counts();
  }
  return report(cell, options, arguments, view.get(), result);
}

int track(const RunArguments& arguments, ShardedWork& work) {
  if (arguments.method != "glint" && !arguments.baseline) start_lab();
  const std::vector<std::string> names = recordings_below(arguments.source, arguments.kind);
  if (names.empty()) {
    if (work.is_shard())
      throw InputError("--shard: " + arguments.source +
                       " is one recording; expected a folder of them");
    return run(arguments);
  }
  const auto track_one = [&](const std::string& name, const std::string& out) {
    RunArguments one = arguments;
    one.source = arguments.source + "/" + name;
    one.out = out;
    one.json = out + "/" + k_summary_file;
    one.one_of_many = true;
    return run(one);
  };
  return track_folder({names, arguments.out, arguments.json}, track_one, work);
}

// Adds the options of both commands.
void add_common(CLI::App& command, RunArguments& arguments) {
  add_cell_option(command, arguments.config);
  command
      .add_option("--duration", arguments.duration_s,
                  "seconds; default: the cell's, or all recorded frames")
      ->check(in_range(0.1, 3600.0));
  command.add_option("--out", arguments.out, "output folder")->capture_default_str();
  command.add_option("--json", arguments.json, "file of the table's figures");
  command.add_option("--can", arguments.can,
                     "CAN output, log:FILE or socketcan:IF; default: the cell's");
  command.add_option("--record-level", arguments.level, "full, roi, blobs or outputs");
  command.add_option("--workers", arguments.workers, "threads of the frame group: 1 or 2")
      ->check(in_range(1, 2));
  add_view_option(command, arguments.view);
  add_headset_option(command, arguments.headset);
  command
      .add_option("--method", arguments.method, "glint or baseline (Puljiz et al.; formerly seed)")
      ->check(CLI::IsMember({"glint", "baseline", "seed"}));
}

}  // namespace

void add_run(CLI::App& app, int& exit_code, const BaselineFactory& baseline) {
  CLI::App* command =
      app.add_subcommand("run", "Track frames; send poses over CAN and DDS; record");
  auto arguments = std::make_shared<RunArguments>();
  arguments->baseline = baseline;
  command->footer(
      "Examples:\n"
      "  glint run --out out --json out/summary.json\n"
      "  glint run --config my_cell.toml --can socketcan:can0\n"
      "  glint run --keys && glint path out/run.mcap --csv path.csv\n"
      "The cell's [source] delivers the frames: the simulator, live frames (" +
      live_kinds() +
      ")\n"
      "or recorded frames (platform/sources/README.md).\n"
      "A cell with tools that this sensor cannot distinguish is refused. The rows `this cell` of "
      "the\n"
      "table warn of tools, and of markers of one tool, that it may confuse.");
  add_common(*command, *arguments);
  command->add_option("--board", arguments->board,
                      "built-in board or board file: costs for the bounds");
  command->add_option("--plan", arguments->plan, "schedule written by `glint budget schedule`");
  command
      ->add_option(
          "--inject", arguments->inject,
          "delay of a node: node=FindBlobs,delay_us=200,frame=512 or node=..,tick=N; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--source-frame-ms", arguments->source_frame_ms,
                   "simulated delay of each frame by its source, ms; default: 0")
      ->check(in_range(0.0, 10'000.0));
  command->add_flag("--trace", arguments->trace,
                    "trace of every node's execution: trace.spans in --out");
  command->add_option("--name", arguments->name,
                      "namespace of all DDS topics and of the node; default: the cell's");
  command->add_flag("--no-dds", arguments->no_dds, "no output over DDS");
  command->add_flag("--keys", arguments->keys,
                    std::string("keys of this terminal as the pen's buttons: ") + k_keys_text);
  command->add_flag("--fast", arguments->as_fast_as_can_be,
                    "as fast as possible, not in real time: no DDS, reproducible output");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_track(CLI::App& app, int& exit_code, ShardedWork& work, const BaselineFactory& baseline) {
  CLI::App* command = app.add_subcommand(
      "track", "Track recorded frames as fast as possible: poses, CAN log, plots");
  auto arguments = std::make_shared<RunArguments>();
  arguments->recorded = arguments->as_fast_as_can_be = true;
  arguments->baseline = baseline;
  command->footer(
      "Examples:\n"
      "  glint track sim/frames.mcap --out again\n"
      "  glint track frames --config my_cell.toml --json poses.json\n"
      "  glint track bag --config my_cell.toml\n"
      "SOURCE: a recording of `glint run` or `glint simulate` (default cell: the recording's\n"
      "own), a ROS 2 bag (MCAP), a folder with frames.csv, a capture of StreamRecorder or a file "
      "of\n"
      "hl2ss (platform/sources/README.md). A folder of these: each is tracked into a folder of\n"
      "its own in --out, by the same options.");
  command->add_option("SOURCE", arguments->source, "recorded frames; default: the cell's [source]");
  command->add_option("--kind", arguments->kind,
                      "kind of SOURCE: " + recorded_kinds() + "; default: detected");
  add_common(*command, *arguments);
  command->add_flag("--allow-truncated", arguments->tolerance.truncated,
                    "read a truncated or damaged recording; exit code 1");
  add_shard_option(*command, work);
  command->callback([arguments, &exit_code, &work] {
    arguments->tolerance.incomplete = arguments->tolerance.truncated;
    exit_code = track(*arguments, work);
  });
}

}  // namespace glint

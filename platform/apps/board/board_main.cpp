// glint_board: Glint on a companion computer. Frames from memory or a live source; poses to CAN and
// DDS; mapping and robot following in the background.
#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/apps/board/board_json.hpp"
#include "platform/apps/board/board_run.hpp"
#include "platform/apps/board/stop_safe_file.hpp"
#include "platform/apps/board/system_share.hpp"
#include "platform/apps/version/version.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/exit_code.hpp"
#include "platform/folder_lock.hpp"
#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/runtime/rt/service_notifier.hpp"
#include "platform/runtime/session/losses.hpp"
#include "platform/sources/open_live_source.hpp"
#include "platform/stop_signals.hpp"
#include "schedules/node_bounds.hpp"

namespace glint {
namespace {

struct Arguments {
  std::string cell_file, frames_file, can, json_file, board;
  bool with_dds = false, measure_system = false, stop_safe_after_crash = false;
  CompanionOptions options;
};

// Node bounds, by node, for the cell's limits.
NodeWcets bounds_on(const std::string& name, const Cell& cell) {
  if (name.empty()) return {};
  const Board board = load_board(name, expected_board(), BoardUse::run_here);
  const auto by_node = [](const auto& bounds) {
    return std::vector<std::int64_t>(bounds.begin(), bounds.end());
  };
  const Limits limits = limits_of(cell);
  return {by_node(node_bounds<Tracker>(board.table(), limits)),
          by_node(node_bounds<Output>(board.table(), limits))};
}

void write(const std::string& file, const nlohmann::ordered_json& figures) {
  if (file.empty()) {
    std::printf("%s\n", figures.dump(2).c_str());
    return;
  }
  if (const std::string reason = write_file_atomically(file, figures.dump(2) + "\n");
      !reason.empty()) {
    throw InputError(file + ": cannot be written: " + reason + "; expected a writable path");
  }
}

// Replaces the first '*' by the time in UTC: a service keeps the recordings of its earlier runs.
std::string with_start_time(std::string file) {
  const std::size_t star = file.find('*');
  if (star == std::string::npos) return file;
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::array<char, 32> text{};
  ::gmtime_r(&now, &utc);
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &utc);
  return file.replace(star, 1, text.data(), length);
}

// Reasons for exit code 1, one per line.
std::vector<std::string> failures_of(const CompanionResult& result,
                                     const CompanionOptions& options) {
  std::vector<std::string> lines = lines_of(losses_of(result));
  if (!result.fault.empty()) lines.push_back(result.fault);
  for (const std::string& line : result.source.failures) lines.push_back("source: " + line);
  if (options.frames > 0 && result.frames != options.frames && !*options.stop) {
    lines.push_back(std::to_string(result.frames) + " frames processed; expected " +
                    std::to_string(options.frames));
  }
  return lines;
}

// Runs on the loop, or on the cell's live source.
CompanionResult run_on_frames(const std::string& loop_file, Cell cell,
                              const CompanionOptions& options) {
  if (!loop_file.empty()) return run_companion(std::move(cell), FrameLoop(loop_file), options);
  cell.realtime = true;
  const std::unique_ptr<LiveSource> source =
      open_live_source(cell, {Duration{}, options.stop, options.frames});
  if (source == nullptr) {
    throw InputError("no frames: expected --frames, or a cell whose [source] is live: " +
                     live_kinds());
  }
  return run_companion(std::move(cell), *source, options);
}

int run(const Arguments& arguments) {
  Cell cell = arguments.cell_file.empty() ? default_cell() : load_cell(arguments.cell_file);
  if (!arguments.can.empty()) cell.can.sink = arguments.can;
  cell.dds.on = arguments.with_dds;
  const FolderLock lock(arguments.options.out);
  if (arguments.measure_system) {
    CanSinkOptions can;
    can.directory = arguments.options.out;
    can.format = cell.can.format;
    SystemShareOptions options;
    options.core = arguments.options.core;
    const auto sink = open_can_sink(cell.can.sink, can);
    write(arguments.json_file, as_json(measure_system_share(*sink, options)));
    sink->flush();
    if (sink->counts().all_sent()) return 0;
    std::fprintf(stderr, "glint_board: %llu CAN frames were not sent\n",
                 static_cast<unsigned long long>(sink->counts().lost()));
    return 1;
  }
  CompanionOptions options = arguments.options;
  options.stop = &stop_on_signals();
  options.record = with_start_time(options.record);
  ServiceNotifier service;
  options.service = &service;
  if (arguments.stop_safe_after_crash) {
    const StopSafeFile file(options.out, lock.after_crash());
    if (!file.removed()) {
      std::fprintf(stderr, "stop_safe after a crash: remove %s to send poses\n",
                   file.path().c_str());
    }
    options.enabled = [file] { return file.removed(); };
  }
  options.bounds = bounds_on(arguments.board, cell);
  const CompanionResult result = run_on_frames(arguments.frames_file, std::move(cell), options);
  std::vector<std::string> failures = failures_of(result, options);
  try {
    write(arguments.json_file, as_json(result));
  } catch (const InputError& error) {  // print the figures if the file fails
    write("", as_json(result));
    failures.emplace_back(error.what());
  }
  if (!service.refused().empty()) {
    std::fprintf(stderr, "best effort: %s\n", service.refused().c_str());
  }
  for (const std::string& refused : result.refused) {
    std::fprintf(stderr, "best effort: %s\n", refused.c_str());
  }
  for (const std::string& line : failures) std::fprintf(stderr, "glint_board: %s\n", line.c_str());
  return failures.empty() ? 0 : 1;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  glint::Arguments arguments;
  CLI::App app{"Glint on a board: frames from memory or a live source, poses to CAN and DDS"};
  app.add_option("--config,--cell", arguments.cell_file, "cell file; default: the built-in cell");
  app.add_option("--board", arguments.board,
                 "built-in board or board file: its costs predict overruns");
  app.add_option("--can", arguments.can,
                 "CAN output, socketcan:IF or log:FILE; default: the cell's");
  app.add_option("--json", arguments.json_file, "file of the figures; default: standard output");
  app.add_option("--record", arguments.options.record,
                 "recording of the run, at the cell's [record] level; * in its name: the start "
                 "time; default: none");
  app.add_option("--out", arguments.options.out, "folder of the CAN log and the recording");
  app.add_option("--core", arguments.options.core, "core of all threads");
  app.add_flag("--dds", arguments.with_dds, "publish over DDS by the cell's [dds]");
  app.add_flag("--stop-safe-after-crash", arguments.stop_safe_after_crash,
               "after a crash in --out, send no pose until a person removes its file stop_safe");
  app.set_version_flag("--version", glint::version_text(), "version and commit");
  auto* const frames = app.add_option("--frames", arguments.frames_file,
                                      "loop of frames made by glint_board_frames; default: the "
                                      "cell's [source], " +
                                          glint::live_kinds());
  app.add_option("--count", arguments.options.frames,
                 "number of frames; 0: until SIGTERM or SIGINT, in constant memory")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  auto* const system = app.add_flag("--measure-system", arguments.measure_system,
                                    "measure the operating system's share instead");
  frames->excludes(system);
  app.footer(
      "Examples:\n  glint_board --frames loop.frames --count 10000 --can socketcan:can0\n"
      "  glint_board --cell live.toml --count 0");
  return glint::exit_code_of(app, "glint_board", [&] {
    app.parse(argc, argv);
    return glint::run(arguments);
  });
}

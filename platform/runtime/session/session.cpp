#include "platform/runtime/session/session.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/machine_check.hpp"
#include "platform/runtime/rt/memory_lock.hpp"
#include "platform/runtime/session/session_groups.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/programming/key_reader.hpp"

namespace glint {
namespace {

// Time from the choice of the epoch to the first frame. By then the memory of a map and of a
// recording is touched, other DDS participants are discovered, and all other parts have started.
Duration lead_of(const Cell& cell) {
  const bool much = cell.background || !cell.record.file.empty();
  return milliseconds(much ? 1000 : 300) + (cell.dds.on ? milliseconds(1200) : Duration{});
}

std::vector<int> cores_of(const RunSchedule& plan) {
  std::vector<int> cores = plan.frame.cores;
  cores.insert(cores.end(), plan.tick.cores.begin(), plan.tick.cores.end());
  if (plan.background) cores.push_back(plan.background->cores[0]);
  return cores;
}

// Writes the last map. Call when no group runs any more.
void write_map(BackgroundGroup& background, const std::string& folder, SessionResult& result) {
  background.finish();
  if (background.map().count == 0) return;
  const std::string file = (std::filesystem::path(folder) / "map.ply").string();
  try {
    write_cloud(file, host_cloud_of(background.map()));
    result.files.push_back(file);
  } catch (const InputError& error) {  // a full disk costs the map, not the figures
    result.not_written.push_back(error.what());
  }
}

}  // namespace

SessionResult run_session(const Cell& cell, FrameSource& source, const SessionOptions& given) {
  BackgroundScene scene = read_background_scene(cell, given.read_png);
  SessionOptions options = given;
  if (!options.plan.planned) options.plan = schedule_by_rule(cell);
  SessionResult result;
  // Frames prepared before the session's clock starts cannot be late.
  source.prepare([&options](int ready, int wanted) {
    if (options.preparing) options.preparing(ready, wanted);
    return options.stop == nullptr || !*options.stop;
  });
  if (cell.realtime) {
    if (const MemoryLock lock = lock_memory(); !lock.locked) {
      result.refused.push_back("memory: " + lock.refused);
    }
    result.machine = check_machine(cores_of(options.plan));
    options.timing_faults = result.machine.timing_faults;
  }

  // Sinks need the offset from session time to Unix time. The epoch is therefore chosen before they
  // are opened, far enough ahead that they are ready by then.
  Time nominal_now;
  const Time epoch = monotonic_now() + lead_of(cell);
  std::int64_t unix_offset_ns = unix_offset().nanoseconds + epoch.nanoseconds;
  if (const auto of_stamps = source.unix_offset(); of_stamps && !cell.realtime) {
    unix_offset_ns = of_stamps->nanoseconds;
  }
  Clock now = [&nominal_now] { return nominal_now; };
  if (cell.realtime) now = [epoch] { return Time{} + (monotonic_now() - epoch); };

  options.truth = [&source](int tool, Time time) {
    return source.ground_truth_of_tool(tool, time);
  };
  options.faults = source.faults();
  Sinks sinks(cell, options, unix_offset_ns);
  std::optional<KeyReader> keys;
  if (options.key_terminal) {
    keys.emplace(*options.key_terminal, now, [&sinks, &result](const ButtonEvent& event) {
      ++result.key_events;
      sinks.offer_button(event);
    });
  }
  std::unique_ptr<TraceWriter> trace;
  if (options.trace) {
    const std::string file = (std::filesystem::path(options.out) / "trace.spans").string();
    trace = std::make_unique<TraceWriter>(file, trace_header(cell, options.plan, unix_offset_ns));
    result.files.push_back(file);
  }
  const KeptFrames kept{source.frame_count(), source.ground_truths().size()};
  auto groups = std::make_unique<SessionGroups>(cell, options, kept, sinks, trace.get(), now,
                                                unix_offset_ns, std::move(scene));
  if (options.service != nullptr && sinks.recorder() != nullptr) {
    options.service->watch(sinks.recorder()->passes());
  }
  if (trace != nullptr) trace->start();
  groups->watch(source);
  source.start({cell.realtime, epoch, now});
  if (cell.realtime) {
    run_live(cell, epoch, source, *groups, options, result);
  } else {
    run_in_order(cell, nominal_now, source, *groups, options, result);
  }

  if (groups->background() != nullptr && options.write_map) {
    write_map(*groups->background(), options.out, result);
  }
  groups->report(result);
  if (!source.ground_truths().empty()) {
    result.accuracy = evaluate(result.outcomes, source.ground_truths(), cell.tools);
  }
  result.frames_late = source.late_frames();
  result.source = source.report();
  if (trace != nullptr) {
    if (const std::string wrong = trace->close(); !wrong.empty()) {
      result.not_written.push_back(wrong);
    }
    result.trace_spans = trace->written();
    result.trace_dropped = trace->dropped();
  }
  keys.reset();
  sinks.close(result);
  return result;
}

}  // namespace glint

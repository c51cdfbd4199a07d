#include "platform/runtime/session/replay.hpp"

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/runtime/session/frame_group.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/runtime/session/recorded_order.hpp"
#include "platform/runtime/session/tick_group.hpp"
#include "platform/runtime/session/tool_roster.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint {
namespace {

// Queues of recorded and of recomputed output records, each in its order.
struct RecordComparison {
  std::deque<std::vector<std::uint8_t>> recorded, decided;

  void compare(ReplayResult& result) {
    for (; !decided.empty() && !recorded.empty(); decided.pop_front(), recorded.pop_front()) {
      if (decided.front() != recorded.front() && result.mismatches++ == 0) {
        result.first_mismatch = result.records_compared;
      }
      ++result.records_compared;
    }
  }
};

template <class G>
RunnerSettings<G> runner_settings(int workers) {
  RunnerSettings<G> settings;
  settings.live = false;
  settings.plan = graph::default_schedule<G>(workers);
  settings.worker_threads.assign(static_cast<std::size_t>(settings.plan.workers - 1),
                                 {"glint-worker"});
  return settings;
}

// Runs the groups of a run, released as recorded. G: see FrameGroupOf.
template <class G>
void recompute(const Cell& cell, RecordingReader& reader, const ReplayOptions& options,
               ReplayResult& result) {
  RecordComparison comparison;
  // After a gap no record is compared, since the tracker lacks frames from there on.
  RecordedOrder order(cell, reader, [&](OutputMessage& output) {
    ++result.records_recorded;
    if (output.tick > options.until) return;
    if (!order.has_gap()) comparison.recorded.push_back(std::move(output.record));
    comparison.compare(result);
  });
  order.robot.add(1, declared_robot_frame(cell));
  Time nominal;
  const Clock now = [&nominal] { return nominal; };
  GroupRunner<G> frame_runner(runner_settings<G>(options.workers));
  GroupRunner<Output> tick_runner(runner_settings<Output>(1));
  graph::TripleBuffer<ToolSet> tools;
  const auto frames = std::make_unique<FrameGroupOf<G>>(cell, tools, now, frame_runner, nullptr);
  TickSinks sinks;
  sinks.record = [&](std::span<const std::uint8_t> record) {
    if (order.has_gap() && comparison.recorded.empty()) return;
    comparison.decided.emplace_back(record.begin(), record.end());
    comparison.compare(result);
  };
  const auto ticks = std::make_unique<TickGroup>(cell, frames->estimates(), order.robot.buffer(),
                                                 order.buttons.buffer(), now, sinks, 0, 1,
                                                 tick_runner, frames->overrun_notes());

  std::uint64_t tools_published = 0;
  const auto on_frame = [&](const NextRelease& release) {
    if (release.nominal > options.until) return;
    nominal = release.nominal;
    const std::uint64_t version = release.recorded->versions[0];
    if (version != tools_published) {
      tools.write_slot() = tools_present(cell.tools, tools_in(version));
      tools.publish(tools_published = version, 0);
    }
    frames->process(*release.frame, release.recorded);
    ++result.frames;
    if (options.on_frame && frames->tracker() != nullptr)
      options.on_frame(tracked_frame(*frames->tracker()), order.robot.published());
  };
  // After a gap a tick uses the older versions.
  const auto on_tick = [&](const NextRelease& release) {
    if (release.nominal > options.until) return;
    nominal = release.nominal;
    if (options.progress) options.progress((nominal - Time{}).seconds());
    if (!ticks->release_as(*release.recorded)) {
      if (!order.has_gap()) {
        ++result.versions_missing;
        return;
      }
      comparison.recorded.clear();
    }
    ticks->tick_as(release.tick, *release.recorded);
    ++result.ticks;
  };
  run_releases(order, on_frame, on_tick);

  result.records = static_cast<std::int64_t>(ticks->records());
  result.overruns =
      static_cast<std::int64_t>(frame_runner.overruns().total() + tick_runner.overruns().total());
  result.output_sha256 = ticks->output_sha256();
  result.losses = reader.losses();
  result.losses.frames += order.frames_without_inputs();
}

// At level outputs there are no inputs to replay: only reads the records back.
void read_back(RecordingReader& reader, ReplayResult& result) {
  Sha256 hash;
  while (const auto message = reader.next()) {
    const auto* output = std::get_if<OutputMessage>(&*message);
    if (output == nullptr) continue;
    hash.add(output->record);
    ++result.records;
  }
  result.records_recorded = result.records_compared = result.records;
  result.output_sha256 = hash.hex();
  result.losses = reader.losses();
}

}  // namespace

ReplayResult replay(const std::string& file, const ReplayOptions& options) {
  RecordingReader reader(file, options.tolerance);
  const Cell cell = recorded_cell(reader, file);
  ReplayResult result;
  result.level = std::string(name_of(reader.level()));
  if (const auto it = reader.facts().find("output_sha256"); it != reader.facts().end())
    result.recorded_sha256 = it->second;
  if (reader.level() == RecordingLevel::outputs) {
    read_back(reader, result);
  } else if (reader.level() == RecordingLevel::blobs) {
    recompute<MarkerTracker>(cell, reader, options, result);
  } else {
    recompute<Tracker>(cell, reader, options, result);
  }
  if (result.records == 0 && result.records_recorded == 0)
    throw InputError(file + ": no output to replay: " + std::to_string(result.frames) +
                     " frames and " + std::to_string(result.ticks) +
                     " ticks without output records; expected a recording of a run with ticks");
  return result;
}

}  // namespace glint

#include "platform/session/replay.hpp"

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/record/sha256.hpp"
#include "platform/session/frame_group.hpp"
#include "platform/session/pipeline.hpp"
#include "platform/session/recorded_cell.hpp"
#include "platform/session/recorded_order.hpp"
#include "platform/session/tick_group.hpp"
#include "platform/session/tool_roster.hpp"

namespace glint {
namespace {

// Compares output records as they are recorded and as they are decided here, each in its order.
class RecordComparison {
 public:
  explicit RecordComparison(ReplayResult& result) : result_(result) {}

  void on_recorded(std::vector<std::uint8_t> record) {
    recorded_.push_back(std::move(record));
    compare();
  }
  // `goes_on`: more records may be recorded that are to be compared.
  void on_decided(std::span<const std::uint8_t> record, bool goes_on) {
    if (recorded_.empty() && !goes_on) return;
    decided_.emplace_back(record.begin(), record.end());
    compare();
  }
  // What is decided from here on is compared with nothing.
  void end() { recorded_.clear(); }

 private:
  void compare() {
    while (!decided_.empty() && !recorded_.empty()) {
      if (decided_.front() != recorded_.front() && result_.mismatches++ == 0) {
        result_.first_mismatch = result_.records_compared;
      }
      ++result_.records_compared;
      decided_.pop_front();
      recorded_.pop_front();
    }
  }

  ReplayResult& result_;
  std::deque<std::vector<std::uint8_t>> decided_, recorded_;
};

template <class G>
RunnerSettings<G> runner_settings(int workers) {
  RunnerSettings<G> settings;
  settings.live = false;
  settings.plan = graph::plan_by_rule<G>(workers);
  settings.others.assign(static_cast<std::size_t>(settings.plan.workers - 1), {"glint-worker"});
  return settings;
}

// A run's groups, released as recorded. G: see FrameGroupOf.
template <class G>
void decide_again(const Cell& cell, RecordingReader& reader, const ReplayOptions& options,
                  ReplayResult& result) {
  RecordComparison comparison(result);
  RecordedOrder order(
      reader, declared_robot_frame(cell),
      [&](OutputMessage& output) {
        ++result.records_recorded;
        if (!order.has_gap()) comparison.on_recorded(std::move(output.record));
      },
      options.progress);
  Time nominal;
  const Clock now = [&nominal] { return nominal; };
  GroupRunner<G> frame_runner(runner_settings<G>(options.workers));
  GroupRunner<Output> tick_runner(runner_settings<Output>(1));
  graph::TripleBuffer<ToolSet> tools;
  const auto frames = std::make_unique<FrameGroupOf<G>>(cell, tools, now, frame_runner, nullptr);
  TickSinks sinks;
  sinks.record = [&](std::span<const std::uint8_t> record) {
    comparison.on_decided(record, !order.has_gap());
  };
  const auto ticks = std::make_unique<TickGroup>(cell, frames->estimates(), order.robot().buffer(),
                                                 order.buttons().buffer(), now, sinks, 0, 1,
                                                 tick_runner, frames->overrun_notes());

  std::uint64_t tools_published = 0;
  const auto on_frame = [&](const NextRelease& release) {
    nominal = release.nominal;
    const std::uint64_t version = release.recorded->versions[0];
    if (version != tools_published) {
      tools.write_slot() = tools_present(cell.tools, tools_in(version));
      tools.publish(tools_published = version, 0);
    }
    frames->process_as(*release.frame, *release.recorded);
    ++result.frames;
  };
  // Behind a gap a tick goes on with what was there before.
  const auto on_tick = [&](const NextRelease& release) {
    nominal = release.nominal;
    if (!ticks->release_as(*release.recorded)) {
      if (!order.has_gap()) {
        ++result.versions_missing;
        return;
      }
      comparison.end();
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

// At level outputs nothing can be decided again: the records are only read back.
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
    decide_again<MarkerTracker>(cell, reader, options, result);
  } else {
    decide_again<Tracker>(cell, reader, options, result);
  }
  if (result.records == 0 && result.records_recorded == 0)
    throw InputError(file + ": nothing to replay: " + std::to_string(result.frames) +
                     " frames and " + std::to_string(result.ticks) +
                     " ticks, but no output record; expected a recording of a run with ticks");
  return result;
}

}  // namespace glint

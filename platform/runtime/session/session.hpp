// One run of Glint, from frames to CAN, DDS and a recording; in real time or as fast as possible.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/pose/noise_estimate.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/rt/machine_check.hpp"
#include "platform/runtime/rt/service_notifier.hpp"
#include "platform/runtime/session/accuracy.hpp"
#include "platform/runtime/session/background_group.hpp"
#include "platform/runtime/session/frame_group.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/group_runner.hpp"
#include "platform/runtime/session/latency.hpp"
#include "platform/runtime/session/run_schedule.hpp"
#include "platform/runtime/session/sent_ticks.hpp"
#include "platform/runtime/session/sink_outcome.hpp"
#include "platform/tools/report/calibration_findings.hpp"

namespace glint {

struct SessionOptions : SinkOptions {
  std::function<void(double done_s, double all_s)> progress;
  std::function<void(int ready, int wanted)> preparing;  // frames, before the start
  const std::atomic<bool>* stop = nullptr;  // set: ends the run here, with complete results so far
  // Factory of the method that replaces the tracker if the cell asks for one; empty: none.
  std::function<std::unique_ptr<FrameMethod>(const Cell&)> method;
  DepthPngReader read_png = nullptr;   // for a background's images; null: rejects PNG
  RunSchedule plan;                    // cores, priorities, bounds; default: by rule
  std::vector<Injection> injections;   // test delays
  bool trace = false;                  // trace.spans in `out`
  bool write_map = true;               // map.ply in `out`, if the cell has a background
  ServiceNotifier* service = nullptr;  // receives the state of a live run; null: no service
  // Whether a live run may send poses, since a crash; asked every 50 ms. Empty: always.
  std::function<bool()> enabled;
  std::optional<int> key_terminal;  // KeyTerminal's descriptor; its keys are buttons
};

struct SessionResult : SinkOutcome {
  Accuracy accuracy;  // frames == 0: no ground truth
  SourceReport source;
  std::vector<FrameOutcome> outcomes;  // one per delivered frame
  std::vector<FrameToCan> latencies;
  std::int64_t latencies_overwritten = 0;
  SentTicksSummary sent;                // ticks sent over CAN
  std::uint64_t ticks_source_late = 0;  // without a measurement, while the source was late
  std::int64_t frames = 0;
  std::int64_t frames_tracked = 0;              // with at least one tool seen
  NoiseEstimate noise;                          // of the markers, after the last frame
  std::vector<CalibrationFinding> calibration;  // of tools with enough fits
  std::int64_t ticks = 0;
  std::int64_t ticks_late = 0, ticks_skipped = 0;
  std::vector<std::int64_t> tick_wake_up_ns;  // live: the newest, and the largest
  std::int64_t frames_late = 0;               // of the source
  double duration_s = 0;                      // session time of the last tick
  std::uint64_t heap_allocations_after_start = 0;
  bool heap_counted = false;
  std::uint64_t worker_overruns = 0;  // waits for another worker longer than some milliseconds
  OverrunCounts frame_overruns, tick_overruns;
  std::optional<BackgroundCounts> background;  // if the cell has one
  std::uint64_t page_faults_after_start = 0;   // of the groups' threads
  MachineCheck machine;                        // timing faults of a live run
  std::uint64_t trace_spans = 0, trace_dropped = 0;
  std::uint64_t can_frames = 0;
  std::uint64_t key_events = 0;  // button events from keys
  std::string decision_sha256;   // over every tick's states and every frame's verdict
};

// Throws InputError, MissingDevice.
[[nodiscard]] SessionResult run_session(const Cell& cell, FrameSource& source,
                                        const SessionOptions& options);

}  // namespace glint

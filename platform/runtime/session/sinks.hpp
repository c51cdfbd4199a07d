// All outputs of a run, opened from a cell and closed in the right order.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/rt/followed_robot.hpp"
#include "platform/runtime/rt/loss_counters.hpp"
#include "platform/runtime/rt/overrun_counters.hpp"
#include "platform/runtime/session/file_sink.hpp"
#include "platform/runtime/session/held_buttons.hpp"
#include "platform/runtime/session/sink_outcome.hpp"
#include "platform/runtime/session/tool_roster.hpp"
#include "platform/sinks/can/can_buttons.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "platform/sinks/dds/dds_inputs.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/reader_process.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/sinks/record/recorder.hpp"
#include "platform/tools/report/calibration_findings.hpp"

namespace glint {

class Sinks {
 public:
  // Throws InputError for a bus that cannot carry the cell's traffic or a file that cannot be
  // created, MissingDevice for an interface that does not exist.
  Sinks(const Cell& cell, const SinkOptions& options, std::int64_t unix_offset_ns);

  [[nodiscard]] CanSink* can() noexcept { return can_.get(); }
  [[nodiscard]] DdsSink* dds() noexcept { return dds_.get(); }
  [[nodiscard]] OpenIgtLinkSink* openigtlink() noexcept { return openigtlink_.get(); }
  // Inputs from the same DDS domain; null if there are none.
  [[nodiscard]] DdsInputs* inputs() noexcept { return inputs_.get(); }
  [[nodiscard]] Recorder* recorder() noexcept { return recorder_.get(); }
  [[nodiscard]] FileSink* files() noexcept { return files_.get(); }

  // Button event: records it and publishes it to the following ticks. Thread-safe; may block, thus
  // call on neither the frame nor the tick thread.
  void offer_button(const ButtonEvent& event);

  // The held buttons, for the tick group, its only reader.
  [[nodiscard]] graph::TripleBuffer<PenButtons>& held_buttons() noexcept {
    return held_buttons_.published();
  }

  // Tool changes requested over DDS.
  [[nodiscard]] ToolRequests& tool_requests() noexcept { return tool_requests_; }

  // Written by the groups' callers; published by the DDS diagnostics.
  [[nodiscard]] OverrunCounters& overruns() noexcept { return overruns_; }

  // Written by the tick group, which counts losses; published likewise.
  [[nodiscard]] LossCounters& losses() noexcept { return losses_; }

  // Written by the background group; published likewise.
  [[nodiscard]] RobotTrackingStatus& robot_notes() noexcept { return robot_notes_; }

  // Written by the calibration watch; published likewise.
  [[nodiscard]] CalibrationFindingsStore& calibration_notes() noexcept {
    return calibration_notes_;
  }

  // Call after the last offer. Writes all queued data and stores the results in `result`.
  void close(SinkOutcome& result);

 private:
  std::string out_;
  double can_bus_load_ = 0;
  bool by_rate_ = false;
  OverrunCounters overruns_;
  LossCounters losses_;
  InputAccess input_access_;
  RobotTrackingStatus robot_notes_;
  CalibrationFindingsStore calibration_notes_;
  ToolRequests tool_requests_;
  std::vector<ToolChangeCounts> tool_change_counts_;  // by tool; of the thread that reads from DDS
  std::mutex button_mutex_;  // serialises the input lane and the held buttons
  HeldButtons held_buttons_;
  std::unique_ptr<Recorder> recorder_;  // outlives the threads that offer to it
  std::unique_ptr<FileSink> files_;
  std::unique_ptr<CanSink> can_;
  std::unique_ptr<OpenIgtLinkSink> openigtlink_;
  std::unique_ptr<CanButtons> buttons_;
  std::unique_ptr<ReaderProcess> reader_;  // started before the sink, ended after it
  std::unique_ptr<DdsSink> dds_;
  std::unique_ptr<DdsInputs> inputs_;
  std::string can_receive_error_;
  std::string recording_file_, can_file_, tum_file_, csv_file_;
};

}  // namespace glint

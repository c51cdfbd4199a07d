// Message for /diagnostics: one entry per tool and one each for timing, losses, the DDS process,
// inputs, source, robot and calibration.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "platform/runtime/rt/followed_robot.hpp"
#include "platform/runtime/rt/loss_counters.hpp"
#include "platform/runtime/rt/overrun_counters.hpp"
#include "platform/runtime/rt/source_faults.hpp"
#include "platform/sinks/dds/input_access.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/tools/report/calibration_findings.hpp"

namespace glint {

struct SinkCounts;

// Owns the text of one message; message() refers to it.
class Diagnostics {
 public:
  void add(std::string_view tool, const PoseSample& sample, const SinkCounts& counts);
  // Deadline overruns and this machine's timing faults.
  void add_timing(const OverrunCounters& overruns, std::string_view timing_faults);
  // Output losses so far; an error from the first loss on.
  void add_losses(const LossCounters& losses);
  // The DDS process ended `restarts` times; `how`: the last time.
  void add_process(std::uint64_t restarts, std::string_view how);
  // A warning names the refused inputs.
  void add_inputs(const InputRefusals& refusals);
  // Faults of a live source: an error while no frame arrives, a warning if the number of faults
  // exceeds `published`, that of the previous message.
  void add_source(const SourceFaults& faults, std::uint64_t published);
  // Whether the robot was detected at its assumed pose.
  void add_robot(const RobotTrackingStatus& robot);
  // Calibration errors that are larger than stated.
  void add_calibration(const std::vector<CalibrationFinding>& findings);
  [[nodiscard]] DiagnosticsMessage message(Time unix_time);

 private:
  using Entry = diagnostic_msgs_msg_dds__DiagnosticStatus_;
  using Value = diagnostic_msgs_msg_dds__KeyValue_;

  char* keep(std::string_view text);
  void add_entry(std::uint8_t level, char* name, char* message, std::vector<Value>& values);

  std::deque<std::string> texts_;
  std::deque<std::vector<Value>> values_;
  std::vector<Entry> entries_;
};

}  // namespace glint

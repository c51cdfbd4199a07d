// Locations of a run's output files, and results of all its outputs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/runtime/rt/source_faults.hpp"
#include "platform/runtime/session/output_figures.hpp"
#include "platform/sinks/can/button_frames.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "platform/sinks/dds/dds_inputs.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/reader_result.hpp"
#include "platform/sinks/headset/headset_output.hpp"
#include "platform/sinks/openigtlink/openigtlink_sink.hpp"
#include "platform/sinks/record/derived_messages.hpp"
#include "platform/sinks/record/message_observer.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint {

struct SinkOptions {
  std::string out = "out";                 // folder for relative file names of the cell
  bool with_reader = true;                 // a separate DDS reader process counts received samples
  std::vector<std::string> timing_faults;  // this machine's timing faults, stated in all outputs
  bool by_rate = true;                     // statistics by frame rate
  MessageObserver* observer = nullptr;     // of the recorded messages
  DerivedMessages* derived = nullptr;      // further messages for viewers, from the recorded ones
  HeadsetOutput* headset = nullptr;        // display of a headset
  // Of run_session()'s source: for `by_rate`, and for the diagnostics.
  GroundTruthOfTool truth{};
  const SourceFaults* faults = nullptr;
};

// Numbers of tool change requests from other DDS participants.
struct ToolChangeCounts {
  std::uint64_t added = 0, removed = 0;
};

struct SinkOutcome {
  CanSinkCounts can;
  double can_bus_load = 0;         // computed, of the bus that the cell declares
  ButtonFrameCounts can_received;  // button frames received
  std::string can_receive_error;   // why no button frames can arrive, if the cell names one
  DdsCounts dds;
  std::string dds_process_end;                       // why the DDS process ended; empty: it did not
  ReceivedCounts dds_received;                       // received over DDS
  std::vector<ToolChangeCounts> tool_change_counts;  // by tool; empty: no DDS
  ReaderResult dds_reader;
  bool dds_was_read = false;
  std::string dds_reader_error;  // why the reader process has no result, if there was one
  std::shared_ptr<const OutputByRate> by_rate;   // null: not requested
  std::optional<HeadsetCounts> headset;          // null: not requested
  std::optional<OpenIgtLinkCounts> openigtlink;  // null: no server
  std::uint64_t files_lost = 0;                  // lines missing in TUM and CSV files
  std::string files_error;                       // first write error of these
  RecordingOutcome recording;
  std::string recording_file;
  std::string output_sha256;
  std::string fault;                     // why the run had to stop; empty: it did not
  std::vector<std::string> refused;      // real-time rights that the system refused
  std::vector<std::string> files;        // all written files
  std::vector<std::string> not_written;  // other files that failed, each with the reason
};

}  // namespace glint

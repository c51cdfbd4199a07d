// Where a run's files go, and what became of everything it sent.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/can/button_frames.hpp"
#include "platform/can/can_sink.hpp"
#include "platform/dds/dds_inputs.hpp"
#include "platform/dds/dds_sink.hpp"
#include "platform/dds/reader_result.hpp"
#include "platform/record/recording.hpp"
#include "platform/session/output_figures.hpp"

namespace glint {

struct SinkOptions {
  std::string out = "out";               // folder of all files that the cell names relatively
  bool with_reader = true;               // a DDS reader process of its own counts what arrives
  std::vector<std::string> best_effort;  // what this machine spoils: said in every output
  bool by_rate = true;                   // figures by frame rate
  TruthOfTool truth{};                   // of run_session()'s source, for them
};

// Messages of other DDS participants that named a tool.
struct ToolOrders {
  std::uint64_t added = 0, removed = 0;
};

struct SinkOutcome {
  CanSinkCounts can;
  double can_bus_load = 0;      // computed, of the bus that the cell declares
  ButtonFrameCounts can_heard;  // frames of buttons
  std::string can_not_heard;    // why none can come, where the cell names one
  DdsCounts dds;
  HeardCounts heard;                    // over DDS
  std::vector<ToolOrders> tool_orders;  // by tool; empty: no DDS
  ReaderResult dds_reader;
  bool dds_was_read = false;
  std::string dds_not_read;  // why the reader process has no result, where there was one
  std::shared_ptr<const OutputByRate> by_rate;  // null: not wanted
  std::uint64_t files_lost = 0;                 // lines that TUM and CSV files lack
  std::string files_wrong;                      // the first write of these that failed
  RecordingOutcome recording;
  std::string recording_file;
  std::string output_sha256;
  std::string fault;                     // why the run had to stop; empty: it did not
  std::vector<std::string> refused;      // real-time rights that the system did not grant
  std::vector<std::string> files;        // everything written
  std::vector<std::string> not_written;  // other files that the disk refused, each with the reason
};

}  // namespace glint

// Reads the status and pose topics of every tool with keep_all, and counts the messages.
#pragma once

#include <vector>

#include "platform/sinks/dds/latency_histogram.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/reader_result.hpp"
#include "platform/sinks/dds/stream_counter.hpp"

namespace glint {

class StatusReader {
 public:
  // Throws as Participant does.
  explicit StatusReader(const DdsSettings& settings);

  // Waits at most `limit` for messages and counts all that are available.
  void read(Duration limit);

  // found: at least one sink was discovered. present: one of them has not left.
  struct Sinks {
    bool found = false, present = false;
  };
  [[nodiscard]] Sinks sinks() const;

  [[nodiscard]] ReaderResult result() const;

 private:
  struct ToolReader {
    dds_entity_t status = 0, pose = 0;
    StreamCounter counter;
  };

  void take_statuses(ToolReader& tool);
  void take_poses(const ToolReader& tool);
  void count(ToolReader& tool, const StatusMessage& status, Time taken);

  Participant participant_;
  dds_entity_t waitset_ = 0;
  std::vector<ToolReader> tools_;
  ReaderResult result_;
  bool any_received_ = false;
  LatencyHistogram latency_;
};

}  // namespace glint

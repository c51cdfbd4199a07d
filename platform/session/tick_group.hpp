// The tick group as it runs: at each tick the newest estimates become pose samples and CAN frames;
// frames are sent at once, samples go to DDS, to the recorder and into the hash.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "graph/rate_group.hpp"
#include "nodes/output.hpp"
#include "platform/can/can_sink.hpp"
#include "platform/cells/cell.hpp"
#include "platform/dds/dds_sink.hpp"
#include "platform/record/recorder.hpp"
#include "platform/record/sha256.hpp"
#include "platform/session/file_sink.hpp"
#include "platform/session/frame_group.hpp"
#include "platform/session/latency.hpp"

namespace glint {

// Whoever listens; each may be null.
struct TickSinks {
  CanSink* can = nullptr;
  DdsSink* dds = nullptr;
  FileSink* files = nullptr;
  RecorderLane* lane = nullptr;
};

class TickGroup {
 public:
  TickGroup(const Cell& cell, graph::TripleBuffer<Estimates>& estimates,
            graph::TripleBuffer<RobotFrame>& robot, Clock now, TickSinks sinks,
            std::int64_t unix_offset_ns, std::size_t latency_entries);

  // Tick `number` at its nominal time; `woken` is when it really began.
  void tick(std::uint32_t number, Time nominal, Time woken) noexcept;

  [[nodiscard]] const LatencyLog& latencies() const noexcept { return latencies_; }
  [[nodiscard]] std::uint64_t can_frames() const noexcept { return can_frames_; }
  [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
  [[nodiscard]] const PoseSamples& samples() const noexcept {
    return output_->output<PoseSamples>();
  }
  // Over all output records so far, lower-case hex.
  [[nodiscard]] std::string output_sha256() const;

 private:
  void send(Time woken) noexcept;

  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  graph::RateGroup<Output> group_;
  Clock now_;
  TickSinks sinks_;
  std::int64_t unix_offset_ns_;
  LatencyLog latencies_;
  Sha256 hash_;
  std::uint64_t carried_version_ = 0;  // of the estimates that CAN has carried already
  std::uint64_t can_frames_ = 0;
  std::uint64_t records_ = 0;
};

}  // namespace glint

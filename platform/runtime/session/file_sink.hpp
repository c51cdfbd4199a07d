// Writes pose samples to text files (TUM, CSV) and adds them to a run's output figures, on a thread
// of its own behind a bounded ring. The tick thread only copies. Samples that the full ring rejects
// are counted.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "graph/ring.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/runtime/session/output_figures.hpp"
#include "platform/sinks/record/trajectory_files.hpp"
#include "platform/when_full.hpp"

namespace glint {

class FileSink {
 public:
  static constexpr int k_ring_capacity = 1024;  // 4 s of one tool at 250 Hz

  // An empty name creates no file. Throws InputError if a file cannot be created.
  FileSink(const std::string& tum_file, const std::string& csv_file, OverflowPolicy when_full,
           const Cell& cell, GroundTruthOfTool truth);
  ~FileSink() { close(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  // Call from one thread. No heap, no lock; OverflowPolicy::wait sleeps while the ring is full.
  // `newest_frame`: see OutputStatistics::add().
  void offer(const PoseSample& sample, std::optional<Time> newest_frame) noexcept;

  // Writes the queued samples and closes the files. Returns the first error message, or an empty
  // string.
  std::string close();
  // Call by_rate() after close(). lost(): samples rejected by the full ring and lines lost by
  // failed writes so far; thread-safe.
  [[nodiscard]] const OutputByRate& by_rate() const noexcept { return figures_.figures(); }
  [[nodiscard]] std::uint64_t lost() const noexcept {
    return ring_.dropped() + lines_lost_.load(std::memory_order_relaxed);
  }

 private:
  void run();
  bool write_queued();
  void count_lost() noexcept;

  struct QueuedSample {
    PoseSample sample;
    std::optional<Time> newest_frame;
  };
  graph::Ring<QueuedSample, k_ring_capacity> ring_;
  OutputStatistics figures_;
  std::unique_ptr<TumFile> tum_;
  std::unique_ptr<CsvFile> csv_;
  OverflowPolicy when_full_;
  std::atomic<std::int64_t> queued_{0};
  std::atomic<std::uint64_t> lines_lost_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace glint

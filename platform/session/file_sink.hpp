// Pose samples to text files (TUM, CSV) and to the figures of a run, from a thread of its own
// behind a bounded ring: the tick thread only copies. What the ring cannot hold is counted.
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
#include "platform/record/trajectory_files.hpp"
#include "platform/session/output_figures.hpp"
#include "platform/when_full.hpp"

namespace glint {

class FileSink {
 public:
  static constexpr int k_ring_capacity = 1024;  // 4 s of one tool at 250 Hz

  // Empty names make no file. Throws InputError where a file cannot be made.
  FileSink(const std::string& tum_file, const std::string& csv_file, WhenFull when_full,
           const Cell& cell, TruthOfTool truth);
  ~FileSink() { close(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  // From one thread. No heap, no lock; WhenFull::wait sleeps where the ring is full.
  // `newest_frame`: as OutputFigures::add() has it.
  void offer(const PoseSample& sample, std::optional<Time> newest_frame) noexcept;

  // Writes what waits and closes the files. The first line that says what went wrong, or nothing.
  std::string close();
  // Samples that found no room, and lines that a failed write cost, so far; any thread may ask.
  // After close().
  [[nodiscard]] const OutputByRate& by_rate() const noexcept { return figures_.figures(); }
  [[nodiscard]] std::uint64_t lost() const noexcept {
    return ring_.dropped() + lines_lost_.load(std::memory_order_relaxed);
  }

 private:
  void run();
  bool write_waiting();
  void count_lost() noexcept;

  struct Offered {
    PoseSample sample;
    std::optional<Time> newest_frame;
  };
  graph::Ring<Offered, k_ring_capacity> ring_;
  OutputFigures figures_;
  std::unique_ptr<TumFile> tum_;
  std::unique_ptr<CsvFile> csv_;
  WhenFull when_full_;
  std::atomic<std::int64_t> waiting_{0};
  std::atomic<std::uint64_t> lines_lost_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace glint

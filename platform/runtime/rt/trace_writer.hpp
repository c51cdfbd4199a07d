// Writes trace spans from their rings to a file, in a thread of its own. The file is renamed to its
// final name when it is closed.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "platform/runtime/rt/node_trace.hpp"

namespace glint {

class TraceWriter {
 public:
  // `header` is the file's first line (trace_span.hpp). Throws InputError if the file cannot be
  // created.
  TraceWriter(const std::string& path, const std::string& header);
  ~TraceWriter() { (void)close(); }
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  // Adds a ring for one producer. Call before start().
  [[nodiscard]] SpanRing& add_ring();
  void start();

  // Call after the last span: writes pending spans and closes the file. Returns an error message,
  // or "".
  std::string close();
  [[nodiscard]] std::uint64_t written() const noexcept { return written_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept;

 private:
  void run();
  void write_pending();

  std::string path_, part_path_;
  std::FILE* file_ = nullptr;
  std::vector<std::unique_ptr<SpanRing>> rings_;
  std::uint64_t written_ = 0;
  bool failed_ = false;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace glint

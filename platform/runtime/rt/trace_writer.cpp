#include "platform/runtime/rt/trace_writer.hpp"

#include <chrono>
#include <cstdio>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {
namespace {
constexpr auto k_poll = std::chrono::milliseconds(5);
}  // namespace

TraceWriter::TraceWriter(const std::string& path, const std::string& header) : path_(path) {
  PartFile part = open_part_file(path);
  part_path_ = std::move(part.path);
  if (part.descriptor >= 0) file_ = ::fdopen(part.descriptor, "wb");
  if (file_ == nullptr) throw InputError(path + ": cannot be written; expected a writable folder");
  failed_ = std::fputs((header + "\n").c_str(), file_) < 0;
}

SpanRing& TraceWriter::add_ring() { return *rings_.emplace_back(std::make_unique<SpanRing>()); }

void TraceWriter::start() {
  thread_ = std::thread([this] { run(); });
}

void TraceWriter::run() {
  for (;;) {
    const bool last_pass = ending_;
    write_pending();
    if (last_pass) return;
    std::this_thread::sleep_for(k_poll);
  }
}

void TraceWriter::write_pending() {
  TraceSpan span;
  for (const auto& ring : rings_) {
    while (ring->pop(span)) {
      failed_ = failed_ || std::fwrite(&span, sizeof span, 1, file_) != 1;
      ++written_;
    }
  }
}

std::uint64_t TraceWriter::dropped() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& ring : rings_) sum += ring->dropped();
  return sum;
}

std::string TraceWriter::close() {
  if (file_ == nullptr) return {};
  ending_ = true;
  if (thread_.joinable()) thread_.join();
  failed_ = std::fclose(file_) != 0 || failed_;
  failed_ = std::rename(part_path_.c_str(), path_.c_str()) != 0 || failed_;
  file_ = nullptr;
  return failed_ ? path_ + ": written incompletely" : std::string{};
}

}  // namespace glint

#include "platform/runtime/session/file_sink.hpp"

#include <chrono>
#include <utility>

namespace glint {
namespace {
constexpr auto k_poll = std::chrono::milliseconds(2);
}  // namespace

FileSink::FileSink(const std::string& tum_file, const std::string& csv_file,
                   OverflowPolicy when_full, const Cell& cell, GroundTruthOfTool truth)
    : figures_(cell, std::move(truth)), when_full_(when_full) {
  if (!tum_file.empty()) tum_ = std::make_unique<TumFile>(tum_file);
  if (!csv_file.empty()) csv_ = std::make_unique<CsvFile>(csv_file);
  thread_ = std::thread([this] { run(); });
}

void FileSink::offer(const PoseSample& sample, std::optional<Time> newest_frame) noexcept {
  while (when_full_ == OverflowPolicy::wait && queued_ >= k_ring_capacity) {
    std::this_thread::sleep_for(k_poll);
  }
  ++queued_;
  if (!ring_.push({sample, newest_frame})) --queued_;
}

bool FileSink::write_queued() {
  QueuedSample offered;
  if (!ring_.pop(offered)) return false;
  --queued_;
  const PoseSample& sample = offered.sample;
  figures_.add(sample, offered.newest_frame);
  if (tum_ != nullptr) tum_->write(sample);
  if (csv_ != nullptr) csv_->write(sample);
  count_lost();
  return true;
}

void FileSink::count_lost() noexcept {
  const std::uint64_t tum = tum_ != nullptr ? tum_->file().lines_lost() : 0;
  const std::uint64_t csv = csv_ != nullptr ? csv_->file().lines_lost() : 0;
  lines_lost_.store(tum + csv, std::memory_order_relaxed);
}

void FileSink::run() {
  for (;;) {
    const bool last_look = ending_;
    while (write_queued()) {
    }
    if (last_look) return;
    std::this_thread::sleep_for(k_poll);
  }
}

std::string FileSink::close() {
  if (!thread_.joinable()) return {};
  ending_ = true;
  thread_.join();
  std::string wrong;
  if (tum_ != nullptr && !tum_->close()) wrong = tum_->file().error();
  if (csv_ != nullptr && !csv_->close() && wrong.empty()) wrong = csv_->file().error();
  count_lost();
  return wrong;
}

}  // namespace glint

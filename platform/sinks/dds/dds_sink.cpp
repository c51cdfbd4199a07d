#include "platform/sinks/dds/dds_sink.hpp"

#include <chrono>

#include "platform/sinks/dds/pose_publisher.hpp"

namespace glint {
namespace {

using Clock = std::chrono::steady_clock;
constexpr Clock::duration k_diagnostics_period = std::chrono::seconds(1);
// Shortest gap of diagnostics with a new fault: less than one frame of 45 Hz.
constexpr Clock::duration k_fault_gap = std::chrono::milliseconds(20);
constexpr Duration k_receipts_limit = milliseconds(2000);

// Only one thread writes each counter, so no read-modify-write is needed.
void add_one(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

Clock::duration chrono_of(Duration duration) {
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::nanoseconds(duration.nanoseconds));
}

}  // namespace

DdsSink::DdsSink(const DdsSettings& settings)
    : tool_count_(static_cast<int>(settings.tool_names.size())),
      poll_period_(settings.poll_period),
      source_(settings.source),
      publisher_(std::make_unique<PosePublisher>(settings)) {}

DdsSink::~DdsSink() { stop(); }

void DdsSink::start() {
  if (!thread_.joinable() && publisher_ != nullptr) thread_ = std::thread([this] { run(); });
}

bool DdsSink::wait_for_readers(int count, Duration limit) const {
  const Clock::time_point deadline = Clock::now() + chrono_of(limit);
  while (publisher_ != nullptr) {
    if (publisher_->readers() >= count) return true;
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

bool DdsSink::offer(const PoseSample& sample) noexcept {
  add_one(offered_);
  if (sample.tool >= tool_count_ || !accepting_.load(std::memory_order_relaxed)) {
    add_one(refused_);
    return false;
  }
  return ring_.push(sample);
}

void DdsSink::stop() {
  if (publisher_ == nullptr) return;
  accepting_.store(false);
  stopping_.store(true);
  if (thread_.joinable()) thread_.join();
  write_queued();
  write_diagnostics();  // including the losses of the last second
  publisher_->flush(k_receipts_limit);
  note_process_counts();  // without the marks that follow
  publisher_->end_streams(k_receipts_limit);
  publisher_.reset();
}

DdsCounts DdsSink::counts() const noexcept {
  DdsCounts counts;
  counts.offered = offered_.load(std::memory_order_relaxed);
  counts.process_lost = process_lost_.load(std::memory_order_relaxed);
  counts.written = written_.load(std::memory_order_relaxed);
  counts.write_failed = write_failed_.load(std::memory_order_relaxed);
  counts.ring_dropped = ring_.dropped() + refused_.load(std::memory_order_relaxed) +
                        counts.write_failed + counts.process_lost;
  counts.process_restarts = restarts_.load(std::memory_order_relaxed);
  counts.poses_written = poses_written_.load(std::memory_order_relaxed);
  counts.poses_and_transforms_lost =
      frames_.dropped() + others_failed_.load(std::memory_order_relaxed);
  return counts;
}

void DdsSink::run() {
  Clock::time_point diagnostics_due = Clock::now(), fault_due = diagnostics_due;
  std::uint64_t faults = 0;
  while (!stopping_.load(std::memory_order_acquire)) {
    write_queued();
    const Clock::time_point now = Clock::now();
    const std::uint64_t newest = source_ != nullptr ? source_->total() : 0;
    if (now >= diagnostics_due || (newest != faults && now >= fault_due)) {
      write_diagnostics();
      if (now >= diagnostics_due) diagnostics_due += k_diagnostics_period;
      fault_due = now + k_fault_gap;
      faults = newest;
    }
    std::this_thread::sleep_for(chrono_of(poll_period_));
  }
}

void DdsSink::write_diagnostics() {
  const DdsCounts now = counts();
  publisher_->write_diagnostics({now.offered, now.written, now.ring_dropped});
}

std::shared_ptr<DdsProcess> DdsSink::process() const {
  return publisher_ != nullptr ? publisher_->process() : nullptr;
}

void DdsSink::write_queued() {
  FrameTransforms frame;
  while (frames_.pop(frame)) publisher_->write_frame(frame);
  if (robot_.sample()) publisher_->write_robot(robot_.value());
  PoseSample sample;
  while (ring_.pop(sample)) {
    if (!publisher_->write(sample)) add_one(write_failed_);
  }
  note_process_counts();
}

void DdsSink::note_process_counts() {
  const ProcessCounts counts = publisher_->process_counts();
  written_.store(counts.statuses, std::memory_order_relaxed);
  poses_written_.store(counts.poses, std::memory_order_relaxed);
  process_lost_.store(counts.statuses_lost, std::memory_order_relaxed);
  others_failed_.store(publisher_->others_failed() + counts.others_lost, std::memory_order_relaxed);
  restarts_.store(publisher_->process()->restarts(), std::memory_order_relaxed);
}

}  // namespace glint

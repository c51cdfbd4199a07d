#include "platform/sinks/can/log_sink.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "platform/sinks/can/candump_line.hpp"
#include "platform/sinks/can/frame_ring.hpp"
#include "platform/sinks/can/line_file.hpp"

namespace glint {
namespace {

// Sleep time of the writer when idle. A wake-up from `send` would cost the sender a system call.
constexpr std::chrono::milliseconds k_idle_sleep{2};
// Lines are flushed, and then counted as written or lost, after this number of frames.
constexpr std::uint64_t k_batch = 256;
static_assert(FrameRing::k_capacity + k_batch <= k_can_in_flight_max);

class LogSink : public CanSink {
 public:
  LogSink(const std::filesystem::path& file, const CanSinkOptions& options)
      : options_(options), file_(file), writer_([this] { write_until_stopped(); }) {}

  ~LogSink() override {
    stop_.store(true);
    writer_.join();
  }

  bool send(const CanFrame& frame, Time time) noexcept override {
    while (!ring_.push({frame, time})) {
      if (options_.when_full == OverflowPolicy::drop) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return false;
      }
      std::this_thread::sleep_for(k_idle_sleep);
    }
    return true;
  }

  void flush() noexcept override {
    const std::uint64_t target = ring_.pushed();
    while (sent_.load() + failed_.load() < target) std::this_thread::sleep_for(k_idle_sleep);
  }

  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    return {sent_.load(), dropped_.load(), failed_.load(), error_.load()};
  }

 private:
  void write_until_stopped() {
    bool stopping = false;
    while (!stopping) {
      stopping = stop_.load();  // before the last drain: nothing is sent after it is set
      drain();
      if (!stopping) std::this_thread::sleep_for(k_idle_sleep);
    }
  }

  void drain() noexcept {
    CandumpLine buffer;
    while (const auto item = ring_.pop()) {
      const auto line =
          format_candump(item->frame, item->time.nanoseconds + options_.unix_offset_ns,
                         options_.log_interface, buffer);
      file_.add(line);
      if (++taken_ % k_batch == 0) update_counts();
    }
    update_counts();
  }

  void update_counts() noexcept {
    file_.write_out();
    error_.store(file_.error());
    failed_.store(file_.lines_lost());
    sent_.store(taken_ - file_.lines_lost());
  }

  CanSinkOptions options_;
  FrameRing ring_;
  LineFile file_;
  std::uint64_t taken_ = 0;  // frames popped; used by the writer only
  std::atomic<std::uint64_t> dropped_{0}, failed_{0}, sent_{0};
  std::atomic<int> error_{0};
  std::atomic<bool> stop_{false};
  std::thread writer_;  // last: it uses all of the above
};

}  // namespace

std::unique_ptr<CanSink> open_log_sink(const std::string& file, const CanSinkOptions& options) {
  return std::make_unique<LogSink>(options.directory / file, options);
}

}  // namespace glint

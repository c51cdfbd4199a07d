#include "platform/can/log_sink.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "platform/can/candump_line.hpp"
#include "platform/can/frame_ring.hpp"
#include "platform/can/line_file.hpp"

namespace glint {
namespace {

// How long the writer sleeps when there is nothing to write. Waking it from `send` instead would
// cost the sender a system call.
constexpr std::chrono::milliseconds k_nap{2};

class LogSink : public CanSink {
 public:
  LogSink(const std::filesystem::path& file, const CanSinkOptions& options)
      : options_(options), file_(file), writer_([this] { write_until_stopped(); }) {}

  ~LogSink() override {
    stop_.store(true);
    writer_.join();
  }

  void send(const CanFrame& frame, Time time) noexcept override {
    while (!ring_.push({frame, time})) {
      if (options_.when_full == WhenFull::drop) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return;
      }
      std::this_thread::sleep_for(k_nap);
    }
  }

  void flush() noexcept override {
    const std::uint64_t target = ring_.pushed();
    while (settled_.load() < target) std::this_thread::sleep_for(k_nap);
  }

  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    const std::uint64_t failed = failed_.load();
    return {ring_.pushed() - failed, dropped_.load(), failed};
  }

 private:
  void write_until_stopped() {
    bool stopping = false;
    while (!stopping) {
      stopping = stop_.load();  // before the last drain: nothing is sent after it is set
      drain();
      if (!stopping) std::this_thread::sleep_for(k_nap);
    }
  }

  void drain() noexcept {
    std::uint64_t taken = 0;
    CandumpLine buffer;
    while (const auto item = ring_.pop()) {
      const auto line =
          format_candump(item->frame, item->time.nanoseconds + options_.unix_offset_ns,
                         options_.log_interface, buffer);
      ++taken;
      file_.add(line);
    }
    file_.write_out();
    failed_.store(file_.lines_lost());
    settled_.store(settled_.load() + taken);
  }

  CanSinkOptions options_;
  FrameRing ring_;
  LineFile file_;
  std::atomic<std::uint64_t> dropped_{0}, failed_{0}, settled_{0};
  std::atomic<bool> stop_{false};
  std::thread writer_;  // last: it uses all of the above
};

}  // namespace

std::unique_ptr<CanSink> open_log_sink(const std::string& file, const CanSinkOptions& options) {
  return std::make_unique<LogSink>(options.directory / file, options);
}

}  // namespace glint

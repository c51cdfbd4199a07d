#include "platform/sinks/can/socketcan_sink.hpp"

#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <optional>
#include <thread>
#include <utility>

#include "platform/sinks/can/socketcan_socket.hpp"

namespace glint {
namespace {

constexpr int k_flush_tries_max = 50;
constexpr std::chrono::milliseconds k_flush_pause{1};

enum class Written { yes, full, failed };

class SocketCanSink : public CanSink {
 public:
  SocketCanSink(Descriptor socket, Descriptor errors) : socket_(std::move(socket)) {
    if (errors.get() >= 0) errors_.emplace(std::move(errors));
  }

  void begin_set() noexcept override {
    send_rest();
    set_ = Set::fresh;
  }

  bool send(const CanFrame& frame, Time) noexcept override {
    send_rest();
    if (set_ == Set::refused) return drop();
    if (rest_count_ == 0) {
      const Written written = write(frame);
      if (written == Written::failed) return false;
      if (written == Written::yes) {
        set_ = Set::begun;
        return true;
      }
    }
    if (set_ == Set::fresh) {
      set_ = Set::refused;
      sets_replaced_.fetch_add(1, std::memory_order_relaxed);
      return drop();
    }
    if (rest_count_ == rest_.size()) return drop();
    rest_[rest_count_++] = frame;
    return true;
  }

  void flush() noexcept override {
    for (int tries = 0; tries < k_flush_tries_max; ++tries) {
      send_rest();
      if (rest_count_ == 0) return;
      std::this_thread::sleep_for(k_flush_pause);
    }
    dropped_.fetch_add(rest_count_, std::memory_order_relaxed);
    rest_count_ = 0;
  }

  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    return {sent_.load(),  dropped_.load(),       failed_.load(),
            error_.load(), sets_replaced_.load(), errors_ ? errors_->counts() : CanErrorCounts{}};
  }

 private:
  enum class Set { fresh, begun, refused };

  bool drop() noexcept {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }

  // Sends what remains of a set that was begun, as far as there is space.
  void send_rest() noexcept {
    std::size_t done = 0;
    while (done < rest_count_ && write(rest_[done]) != Written::full) ++done;
    if (done == 0) return;
    std::copy(rest_.begin() + static_cast<std::ptrdiff_t>(done),
              rest_.begin() + static_cast<std::ptrdiff_t>(rest_count_), rest_.begin());
    rest_count_ -= done;
  }

  Written write(const CanFrame& frame) noexcept {
    canfd_frame raw{};
    raw.can_id = frame.identifier | (frame.extended ? CAN_EFF_FLAG : 0U);
    raw.len = frame.length;
    if (frame.bit_rate_switch) raw.flags = CANFD_BRS;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
    const ssize_t written = ::write(socket_.get(), &raw, size);
    if (written == static_cast<ssize_t>(size)) {
      sent_.fetch_add(1, std::memory_order_relaxed);
      return Written::yes;
    }
    if (written < 0 && (errno == EAGAIN || errno == ENOBUFS)) return Written::full;
    if (error_ == 0) error_ = errno;
    failed_.fetch_add(1, std::memory_order_relaxed);
    return Written::failed;
  }

  Descriptor socket_;
  Set set_ = Set::fresh;
  std::array<CanFrame, k_can_frames_max> rest_;  // of sets that were begun, in order
  std::size_t rest_count_ = 0;
  std::atomic<std::uint64_t> sent_{0}, dropped_{0}, failed_{0}, sets_replaced_{0};
  std::atomic<int> error_{0};
  std::optional<CanErrors> errors_;
};

// The kernel's memory of a queued frame, at most; the kernel doubles the size that it is given.
constexpr int k_queued_frame_bytes = 1024;

}  // namespace

std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                             const CanSinkOptions& options) {
  Descriptor errors = open_can_errors(interface);
  Descriptor socket = open_socketcan(interface, options.format);
  const int bytes = options.frames_a_tick * k_queued_frame_bytes / 2;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  return std::make_unique<SocketCanSink>(std::move(socket), std::move(errors));
}

std::unique_ptr<CanSink> socketcan_sink_of(Descriptor socket) {
  return std::make_unique<SocketCanSink>(std::move(socket), Descriptor());
}

}  // namespace glint

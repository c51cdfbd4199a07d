#include "platform/sinks/can/socketcan_sink.hpp"

#include <linux/can.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <utility>

#include "platform/sinks/can/socketcan_socket.hpp"

namespace glint {
namespace {

class SocketCanSink : public CanSink {
 public:
  explicit SocketCanSink(Descriptor socket) : socket_(std::move(socket)) {}

  bool send(const CanFrame& frame, Time) noexcept override {
    canfd_frame raw{};
    raw.can_id = frame.identifier | (frame.extended ? CAN_EFF_FLAG : 0U);
    raw.len = frame.length;
    if (frame.bit_rate_switch) raw.flags = CANFD_BRS;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
    const ssize_t written = ::write(socket_.get(), &raw, size);
    const bool taken = written == static_cast<ssize_t>(size);
    const bool full = written < 0 && (errno == EAGAIN || errno == ENOBUFS);
    if (!taken && !full && error_ == 0) error_ = errno;
    (taken ? sent_ : full ? dropped_ : failed_).fetch_add(1, std::memory_order_relaxed);
    return taken;
  }

  void flush() noexcept override {}  // write() passes the frame to the kernel at once

  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    return {sent_.load(), dropped_.load(), failed_.load(), error_.load()};
  }

 private:
  Descriptor socket_;
  std::atomic<std::uint64_t> sent_{0}, dropped_{0}, failed_{0};
  std::atomic<int> error_{0};
};

}  // namespace

std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                             const CanSinkOptions& options) {
  return socketcan_sink_of(open_socketcan(interface, options.format));
}

std::unique_ptr<CanSink> socketcan_sink_of(Descriptor socket) {
  return std::make_unique<SocketCanSink>(std::move(socket));
}

}  // namespace glint

#include "platform/can/socketcan_sink.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "platform/input_error.hpp"

namespace glint {
namespace {

[[noreturn]] void missing(const std::string& interface, const std::string& what) {
  throw MissingDevice("socketcan:" + interface + ": " + what);
}

class Socket {
 public:
  explicit Socket(const std::string& interface)
      : descriptor_(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)) {
    if (descriptor_ < 0)
      missing(interface, std::string("no CAN socket: ") + std::strerror(errno) +
                             "; expected a kernel with CAN (modprobe can_raw)");
  }
  ~Socket() { ::close(descriptor_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

class SocketCanSink : public CanSink {
 public:
  SocketCanSink(const std::string& interface, const CanSinkOptions& options) : socket_(interface) {
    require(interface, options.format);
    // Nothing is read: without this the receive queue would fill with the bus' traffic.
    ::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0);
    const int on = 1;
    ::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      missing(interface, std::string("cannot be used: ") + std::strerror(errno) +
                             "; expected a CAN interface");
  }

  void send(const CanFrame& frame, Time) noexcept override {
    canfd_frame raw{};
    raw.can_id = frame.identifier | (frame.extended ? CAN_EFF_FLAG : 0U);
    raw.len = frame.length;
    if (frame.bit_rate_switch) raw.flags = CANFD_BRS;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
    const ssize_t written = ::write(socket_.get(), &raw, size);
    if (written == static_cast<ssize_t>(size))
      sent_.fetch_add(1, std::memory_order_relaxed);
    else if (written < 0 && (errno == EAGAIN || errno == ENOBUFS))
      dropped_.fetch_add(1, std::memory_order_relaxed);
    else
      failed_.fetch_add(1, std::memory_order_relaxed);
  }

  void flush() noexcept override {}  // a write hands the frame to the kernel at once

  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    return {sent_.load(), dropped_.load(), failed_.load()};
  }

 private:
  void require(const std::string& interface, CanFormat format) const {
    ifreq request{};
    interface.copy(request.ifr_name, IFNAMSIZ - 1);
    if (::ioctl(socket_.get(), SIOCGIFFLAGS, &request) != 0)
      missing(interface, std::string("cannot be asked: ") + std::strerror(errno));
    if ((request.ifr_flags & IFF_UP) == 0)
      missing(interface, "is down; expected up (ip link set " + interface + " up)");
    if (format != CanFormat::fd) return;
    if (::ioctl(socket_.get(), SIOCGIFMTU, &request) != 0 || request.ifr_mtu < int{CANFD_MTU})
      missing(interface, "carries no CAN FD frames; expected mtu 72 (ip link set " + interface +
                             " type can ... fd on)");
  }

  Socket socket_;
  std::atomic<std::uint64_t> sent_{0}, dropped_{0}, failed_{0};
};

}  // namespace

std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                             const CanSinkOptions& options) {
  if (interface.size() >= IFNAMSIZ)
    throw InputError("socketcan:" + interface + ": a name of " + std::to_string(interface.size()) +
                     " characters; expected at most " + std::to_string(IFNAMSIZ - 1));
  if (::if_nametoindex(interface.c_str()) == 0)
    missing(interface, "no such network interface; expected one of `ip link`");
  return std::make_unique<SocketCanSink>(interface, options);
}

}  // namespace glint

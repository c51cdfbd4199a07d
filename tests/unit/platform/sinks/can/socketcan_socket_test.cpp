// Configuration of a CAN socket, with simulated system calls: the machine may have no CAN.
#include "platform/sinks/can/socketcan_socket.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/sinks/can/can_buttons.hpp"
#include "platform/sinks/can/can_sink.hpp"

// Replace the C library's calls while a simulated kernel is set; otherwise pass through.
namespace {

struct CanKernel {
  // State of the simulated kernel.
  short flags = IFF_UP;
  int mtu = CANFD_MTU;
  int socket_error = 0, flags_error = 0, mtu_error = 0, bind_error = 0;  // 0: none
  // Arguments that it received.
  int domain = 0, type = 0, protocol = 0;
  std::string flags_of, mtu_of;
  can_filter filter{};
  bool has_filter = false, filter_before_bind = false;
  socklen_t filter_bytes = 77;
  int fd_frames = 0;
  sockaddr_can address{};
  int peer_fd = -1;  // the other end of the socket
};
CanKernel* g_kernel = nullptr;

int result_of(int error) {
  if (error != 0) errno = error;
  return error == 0 ? 0 : -1;
}

}  // namespace

extern "C" int socket(int domain, int type, int protocol) noexcept {
  if (g_kernel == nullptr || domain != PF_CAN)
    return static_cast<int>(::syscall(SYS_socket, domain, type, protocol));
  g_kernel->domain = domain;
  g_kernel->type = type;
  g_kernel->protocol = protocol;
  int ends[2] = {-1, -1};
  if (result_of(g_kernel->socket_error) != 0) return -1;
  if (g_kernel->peer_fd >= 0) ::close(g_kernel->peer_fd);
  if (::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) return -1;
  g_kernel->peer_fd = ends[1];
  return ends[0];
}

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list list;
  va_start(list, request);
  void* const argument = va_arg(list, void*);
  va_end(list);
  if (g_kernel == nullptr || (request != SIOCGIFFLAGS && request != SIOCGIFMTU))
    return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
  auto* const asked = static_cast<ifreq*>(argument);
  if (request == SIOCGIFFLAGS) {
    g_kernel->flags_of = asked->ifr_name;
    asked->ifr_flags = g_kernel->flags;
    return result_of(g_kernel->flags_error);
  }
  g_kernel->mtu_of = asked->ifr_name;
  asked->ifr_mtu = g_kernel->mtu;
  return result_of(g_kernel->mtu_error);
}

extern "C" int setsockopt(int descriptor, int level, int name, const void* value,
                          socklen_t bytes) noexcept {
  if (g_kernel == nullptr || level != SOL_CAN_RAW)
    return static_cast<int>(::syscall(SYS_setsockopt, descriptor, level, name, value, bytes));
  if (name == CAN_RAW_FILTER) {
    g_kernel->has_filter = value != nullptr;
    g_kernel->filter_bytes = bytes;
    g_kernel->filter_before_bind = g_kernel->address.can_family == 0;
    if (value != nullptr) std::memcpy(&g_kernel->filter, value, sizeof g_kernel->filter);
  }
  if (name == CAN_RAW_FD_FRAMES) std::memcpy(&g_kernel->fd_frames, value, sizeof(int));
  return 0;
}

extern "C" int bind(int descriptor, const sockaddr* address, socklen_t bytes) noexcept {
  if (g_kernel == nullptr || address->sa_family != AF_CAN)
    return static_cast<int>(::syscall(SYS_bind, descriptor, address, bytes));
  std::memcpy(&g_kernel->address, address, sizeof g_kernel->address);
  return result_of(g_kernel->bind_error);
}

namespace glint::socketcan_socket_test {
namespace {

// The loopback's name and index replace those of a CAN interface.
class SocketCanSocket : public testing::Test {
 protected:
  SocketCanSocket() { g_kernel = &kernel_; }
  ~SocketCanSocket() override {
    g_kernel = nullptr;
    if (kernel_.peer_fd >= 0) ::close(kernel_.peer_fd);
  }
  // The error message, or "" for an open socket.
  static std::string refusal(CanFormat format) {
    try {
      return open_socketcan("lo", format).get() >= 0 ? "" : "no descriptor";
    } catch (const MissingDevice& error) {
      return error.what();
    }
  }
  CanKernel kernel_;
};

TEST_F(SocketCanSocket, IsRawAndNeverBlocksAndBelongsToItsInterface) {
  const Descriptor socket = open_socketcan("lo", CanFormat::fd);
  EXPECT_EQ(kernel_.domain, PF_CAN);
  EXPECT_EQ(kernel_.type, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC);
  EXPECT_EQ(kernel_.protocol, CAN_RAW);
  EXPECT_EQ(kernel_.flags_of, "lo");
  EXPECT_EQ(kernel_.mtu_of, "lo");
  EXPECT_EQ(kernel_.address.can_family, AF_CAN);
  EXPECT_EQ(kernel_.address.can_ifindex, static_cast<int>(::if_nametoindex("lo")));
  EXPECT_EQ(kernel_.fd_frames, 1);
}

TEST_F(SocketCanSocket, ReceivesOneIdentifierOfElevenBitsOrNothing) {
  {
    const Descriptor socket = open_socketcan("lo", CanFormat::classic, 0x190);
    EXPECT_TRUE(kernel_.has_filter);
    EXPECT_EQ(kernel_.filter_bytes, sizeof(can_filter));
    EXPECT_EQ(kernel_.filter.can_id, 0x190u);
    EXPECT_EQ(kernel_.filter.can_mask, CAN_SFF_MASK | CAN_EFF_FLAG);
    EXPECT_TRUE(kernel_.filter_before_bind) << "or frames of others would wait in the queue";
  }
  const Descriptor socket = open_socketcan("lo", CanFormat::classic);
  EXPECT_FALSE(kernel_.has_filter);
  EXPECT_EQ(kernel_.filter_bytes, 0u);
}

TEST_F(SocketCanSocket, IsRefusedWithTheNextStep) {
  EXPECT_EQ(refusal(CanFormat::classic), "");
  EXPECT_EQ(refusal(CanFormat::fd), "");
  kernel_.mtu = CANFD_MTU - 1;
  EXPECT_EQ(refusal(CanFormat::classic), "");
  const std::string no_fd =
      "socketcan:lo: carries no CAN FD frames; expected mtu 72 (ip link set "
      "lo type can ... fd on)";
  EXPECT_EQ(refusal(CanFormat::fd), no_fd);
  kernel_.mtu = CANFD_MTU;
  kernel_.mtu_error = ENODEV;
  EXPECT_EQ(refusal(CanFormat::fd), no_fd);
  kernel_.flags = IFF_LOOPBACK;
  EXPECT_EQ(refusal(CanFormat::classic), "socketcan:lo: is down; expected up (ip link set lo up)");
  kernel_.flags_error = ENODEV;
  EXPECT_EQ(refusal(CanFormat::classic), "socketcan:lo: cannot be queried: No such device");
  kernel_.socket_error = EAFNOSUPPORT;
  EXPECT_EQ(refusal(CanFormat::classic),
            "socketcan:lo: no CAN socket: Address family not supported by protocol; expected a "
            "kernel with CAN (modprobe can_raw)");
  kernel_.socket_error = kernel_.flags_error = 0;
  kernel_.flags = IFF_UP;
  kernel_.bind_error = ENODEV;
  EXPECT_EQ(refusal(CanFormat::classic),
            "socketcan:lo: cannot be used: No such device; expected a CAN interface");
}

TEST_F(SocketCanSocket, CarriesTheFramesOfASink) {
  CanSinkOptions options;
  options.format = CanFormat::fd;
  kernel_.mtu = CAN_MTU;
  EXPECT_THROW((void)open_can_sink("socketcan:lo", options), MissingDevice);
  options.format = CanFormat::classic;
  const auto sink = open_can_sink("socketcan:lo", options);
  CanFrame frame;
  frame.identifier = 0x1A0;
  EXPECT_TRUE(sink->send(frame, {}));
  can_frame raw{};
  EXPECT_EQ(::recv(kernel_.peer_fd, &raw, sizeof raw, 0), static_cast<ssize_t>(sizeof raw));
  EXPECT_EQ(raw.can_id, 0x1A0u);
}

TEST_F(SocketCanSocket, BringsTheButtonsToAThread) {
  std::atomic<int> events{0};
  const auto buttons =
      open_can_buttons("socketcan:lo", 0x190, {}, [&](const ButtonEvent&) { ++events; });
  ASSERT_NE(buttons, nullptr);
  EXPECT_EQ(kernel_.filter.can_id, 0x190u);
  can_frame raw{};
  raw.can_id = 0x190;
  raw.can_dlc = 1;
  raw.data[0] = 1;
  ASSERT_EQ(::send(kernel_.peer_fd, &raw, sizeof raw, 0), static_cast<ssize_t>(sizeof raw));
  for (int waited = 0; events < 1 && waited < 5'000; ++waited)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(events, 1);
  EXPECT_EQ(buttons->counts().received, 1u);
}

}  // namespace
}  // namespace glint::socketcan_socket_test

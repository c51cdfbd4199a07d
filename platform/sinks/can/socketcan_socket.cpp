#include "platform/sinks/can/socketcan_socket.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "platform/input_error.hpp"

namespace glint {
namespace {

[[noreturn]] void missing(const std::string& interface, const std::string& what) {
  throw MissingDevice("socketcan:" + interface + ": " + what);
}

void require(int socket, const std::string& interface, CanFormat format) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0)
    missing(interface, std::string("cannot be queried: ") + std::strerror(errno));
  if ((request.ifr_flags & IFF_UP) == 0)
    missing(interface, "is down; expected up (ip link set " + interface + " up)");
  if (!is_fd(format)) return;
  if (::ioctl(socket, SIOCGIFMTU, &request) != 0 || request.ifr_mtu < int{CANFD_MTU})
    missing(interface, "carries no CAN FD frames; expected mtu 72 (ip link set " + interface +
                           " type can ... fd on)");
}

}  // namespace

Descriptor open_socketcan(const std::string& interface, CanFormat format,
                          std::optional<std::uint32_t> identifier_filter) {
  if (interface.size() >= IFNAMSIZ)
    throw InputError("socketcan:" + interface + ": a name of " + std::to_string(interface.size()) +
                     " characters; expected at most " + std::to_string(IFNAMSIZ - 1));
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) missing(interface, "no such network interface; expected one of `ip link`");
  Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket.get() < 0)
    missing(interface, std::string("no CAN socket: ") + std::strerror(errno) +
                           "; expected a kernel with CAN (modprobe can_raw)");
  require(socket.get(), interface, format);
  // Before bind(), so that no other frame is ever queued.
  const can_filter filter{identifier_filter.value_or(0), CAN_SFF_MASK | CAN_EFF_FLAG};
  ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_FILTER, identifier_filter ? &filter : nullptr,
               identifier_filter ? sizeof filter : 0);
  const int on = 1;
  ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    missing(interface,
            std::string("cannot be used: ") + std::strerror(errno) + "; expected a CAN interface");
  return socket;
}

}  // namespace glint

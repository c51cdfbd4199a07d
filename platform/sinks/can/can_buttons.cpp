#include "platform/sinks/can/can_buttons.hpp"

#include <linux/can.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <string_view>
#include <utility>

#include "platform/runtime/rt/clock.hpp"
#include "platform/sinks/can/socketcan_socket.hpp"

namespace glint {
namespace {

constexpr Duration k_poll_period = milliseconds(20);
constexpr int k_frames_per_wakeup_max = 256;           // per wake-up
constexpr Duration k_wait_max = milliseconds(10'000);  // of a frame in the socket's queue
constexpr std::string_view k_socketcan = "socketcan:";

Time time_of(const timespec& time) {
  return Time{std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec};
}

Time unix_time() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return time_of(time);
}

// Time of reception by the kernel, Unix clock; `otherwise` if the message has no time stamp.
Time unix_stamp(msghdr& message, Time otherwise) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec time{};
    std::memcpy(&time, CMSG_DATA(part), sizeof time);
    return time_of(time);
  }
  return otherwise;
}

}  // namespace

Time monotonic_arrival(Time unix_stamp, Time unix_now, Time local_now) noexcept {
  const Duration age = unix_now - unix_stamp;
  return age < Duration{} || age > k_wait_max ? local_now : local_now - age;
}

CanButtons::CanButtons(Descriptor socket, std::uint32_t identifier, Duration unix_minus_local,
                       ButtonFrames::OnButton on_button, Duration timeout)
    : socket_(std::move(socket)),
      local_minus_monotonic_(unix_offset() - unix_minus_local),
      frames_(identifier, std::move(on_button), timeout) {
  const int on = 1;
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

CanButtons::~CanButtons() { stop(); }

void CanButtons::start() {
  if (thread_.joinable()) return;
  stopping_ = false;
  thread_ = std::thread([this] {
    while (!stopping_) read(k_poll_period);
  });
  pthread_setname_np(thread_.native_handle(), "glint_buttons");
}

void CanButtons::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

int CanButtons::read(Duration limit) {
  pollfd waiting{socket_.get(), POLLIN, 0};
  const bool ready = ::poll(&waiting, 1, static_cast<int>(limit.nanoseconds / 1'000'000)) > 0;
  int taken = 0;
  while (ready && taken < k_frames_per_wakeup_max && read_one()) ++taken;
  frames_.release_on_timeout(local_now());
  if (!ready) return 0;
  // The socket of a removed interface is always readable, without data.
  if (taken == 0) std::this_thread::sleep_for(std::chrono::nanoseconds(limit.nanoseconds));
  return taken;
}

bool CanButtons::read_one() {
  std::array<std::uint8_t, CANFD_MTU + 1> bytes{};  // one byte more, to detect longer frames
  alignas(cmsghdr) std::array<std::uint8_t, 256> control{};
  iovec part{bytes.data(), bytes.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
  if (size < 0) return false;
  const Time unix_now = unix_time();
  frames_.receive(frame_of_socketcan({bytes.data(), static_cast<std::size_t>(size)}),
                  monotonic_arrival(unix_stamp(message, unix_now), unix_now, local_now()));
  return true;
}

Time CanButtons::local_now() const { return monotonic_now() + local_minus_monotonic_; }

std::unique_ptr<CanButtons> open_can_buttons(const std::string& specification,
                                             std::uint32_t identifier, Duration unix_minus_local,
                                             ButtonFrames::OnButton on_button, Duration timeout) {
  if (!specification.starts_with(k_socketcan)) return nullptr;
  auto buttons = std::make_unique<CanButtons>(
      open_socketcan(specification.substr(k_socketcan.size()), CanFormat::classic, identifier),
      identifier, unix_minus_local, std::move(on_button), timeout);
  buttons->start();
  return buttons;
}

}  // namespace glint

// State messages to the service manager: ready, stopping and watchdog.
//
// The watchdog is fed only if the counter of every watched thread has advanced since it was last
// fed. A held thread therefore ends the service, whatever the others do.
// Source: sd_notify(3), sd_watchdog_enabled(3): one datagram to $NOTIFY_SOCKET a message.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "kernels/units.hpp"

namespace glint {

class ServiceNotifier {
 public:
  static constexpr std::size_t k_threads_max = 8;

  // Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID. Without a service manager, every call does
  // nothing.
  ServiceNotifier();
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;

  // Adds a thread by the counter that it advances; `counter` must live until stopping(). Call
  // before the first feed(). At most k_threads_max; further ones are ignored.
  void watch(const std::atomic<std::uint64_t>& counter) noexcept;

  // The following do not block: a message that the manager does not accept sets refused(). Not for
  // real-time threads.
  //
  // Sent at the first call only: the output has begun.
  void ready() noexcept;
  // Feeds the watchdog four times per watchdog time, if every watched thread has advanced since it
  // was fed. Call more often than that.
  void feed(Time now) noexcept;
  // The run ends; no thread is watched any more.
  void stopping() noexcept;

  [[nodiscard]] bool enabled() const noexcept { return socket_ >= 0; }
  // Why messages are not accepted; empty: they are.
  [[nodiscard]] const std::string& refused() const noexcept { return refused_; }

 private:
  struct Watched {
    const std::atomic<std::uint64_t>* counter = nullptr;
    std::uint64_t when_fed = 0;
  };

  void send(std::string_view message) noexcept;
  [[nodiscard]] bool all_advanced() const noexcept;

  int socket_ = -1;
  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  Duration feed_period_;  // 0: no watchdog
  Time next_feed_;
  std::array<Watched, k_threads_max> watched_{};
  std::size_t watched_count_ = 0;
  bool ready_ = false;
  std::string refused_;
};

}  // namespace glint

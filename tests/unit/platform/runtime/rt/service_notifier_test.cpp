// Messages to a service manager, received by a stand-in.
#include "platform/runtime/rt/service_notifier.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

namespace glint::service_notifier_test {
namespace {

// A service manager's socket with an abstract name, and its environment variables.
class Manager {
 public:
  Manager() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    const std::string name = "glint notifier test " + std::to_string(::getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + 1, name.data(), name.size());
    const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), bytes), 0);
    ::setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
    ::setenv("WATCHDOG_USEC", "4000000", 1);
    ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  }
  ~Manager() {
    ::close(socket_);
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  // All messages that have arrived, each followed by a space.
  [[nodiscard]] std::string received() const {
    std::string text;
    std::array<char, 256> message{};
    for (;;) {
      const ssize_t size = ::recv(socket_, message.data(), message.size(), 0);
      if (size < 0) return text;
      text.append(message.data(), static_cast<std::size_t>(size)).append(" ");
    }
  }

 private:
  int socket_;
};

Time at(std::int64_t ms) { return Time{} + milliseconds(ms); }

TEST(ServiceNotifier, SaysOnceThatItIsReadyAndThatItStops) {
  const Manager manager;
  ServiceNotifier service;
  service.ready();
  service.ready();
  service.stopping();
  EXPECT_EQ(manager.received(), "READY=1 STOPPING=1 ");
}

TEST(ServiceNotifier, FeedsFourTimesPerWatchdogTime) {
  const Manager manager;
  ServiceNotifier service;
  std::atomic<std::uint64_t> thread{0};
  service.watch(thread);
  for (std::int64_t ms = 0; ms < 4000; ms += 50) {
    ++thread;
    service.feed(at(ms));
  }
  EXPECT_EQ(manager.received(), "WATCHDOG=1 WATCHDOG=1 WATCHDOG=1 WATCHDOG=1 ");
}

TEST(ServiceNotifier, FeedsOnlyWhileEachThreadAdvances) {
  const Manager manager;
  ServiceNotifier service;
  std::array<std::atomic<std::uint64_t>, 3> threads{};
  for (const auto& thread : threads) service.watch(thread);
  std::int64_t ms = 0;
  for (std::size_t held = 0; held < threads.size(); ++held) {
    for (int i = 0; i < 100; ++i) {
      for (std::size_t t = 0; t < threads.size(); ++t) threads[t] += t == held ? 0 : 1;
      service.feed(at(ms += 1000));
    }
    EXPECT_EQ(manager.received(), "") << "thread " << held << " is held";
    ++threads[held];
    service.feed(at(ms += 1000));
    EXPECT_EQ(manager.received(), "WATCHDOG=1 ") << "thread " << held << " goes on";
  }
}

TEST(ServiceNotifier, FeedsNoWatchdogOfAnotherProcess) {
  const Manager manager;
  ::setenv("WATCHDOG_PID", "1", 1);
  ServiceNotifier service;
  service.feed(at(0));
  EXPECT_EQ(manager.received(), "");
}

TEST(ServiceNotifier, DoesNothingWithoutAServiceManager) {
  ServiceNotifier service;
  EXPECT_FALSE(service.enabled());
  service.ready();
  service.feed(at(0));
  EXPECT_EQ(service.refused(), "");
}

TEST(ServiceNotifier, ReportsASocketThatDoesNotExist) {
  ::setenv("NOTIFY_SOCKET", "/nonexistent/notify", 1);
  ServiceNotifier service;
  service.ready();
  EXPECT_NE(service.refused(), "");
  ::setenv("NOTIFY_SOCKET", "relative", 1);
  EXPECT_FALSE(ServiceNotifier().enabled());
  ::unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace glint::service_notifier_test

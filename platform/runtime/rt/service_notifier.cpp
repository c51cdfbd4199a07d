#include "platform/runtime/rt/service_notifier.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>

namespace glint {
namespace {

constexpr std::int64_t k_watchdog_max_us = std::int64_t{3'600} * 1'000'000;
constexpr int k_feeds_per_watchdog = 4;  // sd_watchdog_enabled(3) advises at least two

std::optional<std::int64_t> number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  std::int64_t number = 0;
  if (text == nullptr) return std::nullopt;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, number);
  return error == std::errc{} && stop == end ? std::optional(number) : std::nullopt;
}

Duration feed_period() {
  const auto watchdog_us = number_in("WATCHDOG_USEC");
  const auto process = number_in("WATCHDOG_PID");
  const bool of_another = process && *process != ::getpid();
  if (!watchdog_us || *watchdog_us <= 0 || of_another) return {};
  return microseconds(std::min(*watchdog_us, k_watchdog_max_us) / k_feeds_per_watchdog);
}

}  // namespace

ServiceNotifier::ServiceNotifier() : feed_period_(feed_period()) {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr || path[0] == '\0') return;
  const std::size_t length = std::strlen(path);
  if ((path[0] != '/' && path[0] != '@') || length >= sizeof address_.sun_path) {
    refused_ = std::string("NOTIFY_SOCKET: ") + path + "; expected /PATH or @NAME, at most " +
               std::to_string(sizeof address_.sun_path - 1) + " bytes";
    return;
  }
  address_.sun_family = AF_UNIX;
  std::memcpy(address_.sun_path, path, length);
  if (path[0] == '@') address_.sun_path[0] = '\0';  // an abstract name has no file
  address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) refused_ = "NOTIFY_SOCKET: " + std::generic_category().message(errno);
}

ServiceNotifier::~ServiceNotifier() {
  if (socket_ >= 0) ::close(socket_);
}

void ServiceNotifier::watch(const std::atomic<std::uint64_t>& counter) noexcept {
  if (watched_count_ < k_threads_max) watched_[watched_count_++] = {&counter, counter};
}

void ServiceNotifier::ready() noexcept {
  if (!ready_) send("READY=1");
  ready_ = true;
}

bool ServiceNotifier::all_advanced() const noexcept {
  return std::all_of(watched_.begin(),
                     watched_.begin() + static_cast<std::ptrdiff_t>(watched_count_),
                     [](const Watched& thread) { return *thread.counter != thread.when_fed; });
}

void ServiceNotifier::feed(Time now) noexcept {
  if (feed_period_ <= Duration{} || now < next_feed_ || !all_advanced()) return;
  send("WATCHDOG=1");
  next_feed_ = now + feed_period_;
  for (std::size_t i = 0; i < watched_count_; ++i) watched_[i].when_fed = *watched_[i].counter;
}

void ServiceNotifier::stopping() noexcept {
  send("STOPPING=1");
  watched_count_ = 0;
}

void ServiceNotifier::send(std::string_view message) noexcept {
  if (socket_ < 0) return;
  const ssize_t sent = ::sendto(socket_, message.data(), message.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address_), address_bytes_);
  if (sent < 0 && refused_.empty()) {
    refused_ = "NOTIFY_SOCKET: " + std::generic_category().message(errno);
  }
}

}  // namespace glint

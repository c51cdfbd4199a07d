#include "tests/hil/injector/controller_side.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/session/run_schedule.hpp"
#include "platform/sinks/can/socketcan_socket.hpp"

namespace glint::hil {
namespace {

constexpr std::uint32_t k_base = 0x1A0;
constexpr std::uint32_t k_heartbeat = 0x720;  // node 0x20
constexpr std::int64_t k_poll_ms = 20;
constexpr std::int64_t k_load_period_us = 1000;
constexpr std::int64_t k_frame_bits = 135;  // classic, eight bytes, worst-case stuffing
constexpr std::uint32_t k_foreign[] = {0x1B0, 0x300, 0x555};  // another tool, and other devices
constexpr std::int64_t k_clock_slack_us = 1'000'000;

std::string* decisions = nullptr;  // of the one controller of this process
void put_decision(const char* text) { *decisions += text; }

std::int64_t now_us() { return monotonic_now().nanoseconds / 1000; }

Descriptor stamped_socket(const std::string& interface) {
  Descriptor socket = open_socketcan(interface, CanFormat::classic, std::nullopt);
  const can_filter everything{0, 0};
  ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_FILTER, &everything, sizeof everything);
  const int on = 1, bytes = 8 << 20;
  ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof on);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes);
  return socket;
}

}  // namespace

ControllerSide::ControllerSide(const std::string& interface, const Script& script,
                               std::int64_t start_us)
    : socket_(stamped_socket(interface)),
      script_(script),
      start_us_(start_us),
      last_us_(start_us),
      real_minus_monotonic_ns_{unix_offset().nanoseconds, unix_offset().nanoseconds},
      receiver_({"hil-controller", -1, k_background_priority}, [this] { run(); }),
      loader_({"hil-load", -1, k_tick_priority + 2}, [this] { load_bus(); }) {}

ControllerSide::~ControllerSide() { stop_ = true; }

void ControllerSide::apply_now(const Command& command) {
  const std::lock_guard lock(mutex_);
  from_outside_.push_back(command);
}

void ControllerSide::clock_stepped() {
  const std::lock_guard lock(mutex_);
  real_minus_monotonic_ns_ = {unix_offset().nanoseconds, real_minus_monotonic_ns_[0]};
}

// A frame that waits has a stamp of the clock before its last step.
std::int64_t ControllerSide::monotonic_us(std::int64_t stamp_ns, std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  const std::int64_t at_us = (stamp_ns - real_minus_monotonic_ns_[0]) / 1000;
  const bool is_of_now = at_us <= now_us && at_us > now_us - k_clock_slack_us;
  return is_of_now ? at_us : (stamp_ns - real_minus_monotonic_ns_[1]) / 1000;
}

void ControllerSide::run() {
  decisions = &decisions_;
  const glint_settings settings{k_base,
                                false,
                                static_cast<std::uint32_t>(script_.cycle_us),
                                static_cast<std::uint32_t>(script_.speed_max),
                                1000,
                                100'000,
                                k_heartbeat};
  follow_begin(&follower_, &settings, static_cast<std::uint64_t>(start_us_), 0, put_decision);
  events_.push_back({start_us_, "first cycle"});
  while (!stop_) {
    pollfd waited{socket_.get(), POLLIN, 0};
    (void)::poll(&waited, 1, k_poll_ms);
    const std::int64_t now = now_us();
    drain(now);
    advance_to(now);
  }
  drain(now_us());
  advance_to(end_us());
  follow_at(&follower_, FOLLOW_END, static_cast<std::uint64_t>(end_us()));
  events_.push_back({end_us(), "end"});
}

// As many frames as wait.
void ControllerSide::drain(std::int64_t now) {
  for (;;) {
    canfd_frame raw{};
    alignas(cmsghdr) char control[128];
    iovec data{&raw, sizeof raw};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t got = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (got < 0) return;
    Frame frame;
    frame.at_us = now;
    for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
         head = CMSG_NXTHDR(&message, head)) {
      if (head->cmsg_type != SO_TIMESTAMPNS) continue;
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(head), sizeof stamp);
      frame.at_us = monotonic_us(stamp.tv_sec * 1'000'000'000 + stamp.tv_nsec, now_us());
    }
    frame.identifier = raw.can_id & CAN_EFF_MASK;
    frame.fd = got == CANFD_MTU;
    frame.length = raw.len;
    std::copy_n(raw.data, sizeof raw.data, frame.data.begin());
    advance_to(frame.at_us);
    disturb(frame);
  }
}

void ControllerSide::advance_to(std::int64_t until_us) {
  while (next_command_ < script_.commands.size()) {
    const Command& command = script_.commands[next_command_];
    const std::int64_t at_us = start_us_ + command.at_ms * 1000;
    if (at_us > until_us) break;
    ++next_command_;
    pass_delayed(at_us);
    apply(command, at_us);
  }
  std::vector<Command> outside;
  {
    const std::lock_guard lock(mutex_);
    outside.swap(from_outside_);
  }
  for (const Command& command : outside) apply(command, until_us);
  pass_delayed(until_us);
}

void ControllerSide::apply(const Command& command, std::int64_t at_us) {
  const std::int64_t number = command.number[0];
  at_us = last_us_ = std::max(at_us, last_us_);
  if (command.target == Target::controller) {
    const bool restarts = command.verb == "restart";
    if (restarts) restarted_us_ = at_us + number * 1000;
    follow_at(&follower_, restarts ? FOLLOW_RESTART : FOLLOW_ENABLE,
              static_cast<std::uint64_t>(at_us));
    events_.push_back({at_us, command.verb});
  }
  if (command.target != Target::bus) return;
  if (command.verb == "drop") faults_.drop = number;
  if (command.verb == "flip") faults_.flip = number;
  if (command.verb == "freeze") faults_.frozen = number != 0;
  if (command.verb == "repeat") faults_.repeats = number != 0;
  if (command.verb == "delay") faults_.delay_us = number * 1000;
  if (command.verb == "off") faults_.off_until_us = at_us + number * 1000;
  if (command.verb == "load") load_percent_ = number;
}

void ControllerSide::disturb(Frame frame) {
  const bool is_glints = std::find(std::begin(k_foreign), std::end(k_foreign), frame.identifier) ==
                         std::end(k_foreign);
  if (is_glints && (faults_.frozen || frame.at_us < faults_.off_until_us)) return;
  if (is_glints && faults_.drop > 0) {
    --faults_.drop;
    return;
  }
  if (is_glints && frame.identifier < last_of_identifier_.size()) {
    Frame& last = last_of_identifier_[frame.identifier];
    if (faults_.repeats) frame.data = last.data;
    last = frame;
  }
  if (is_glints && faults_.flip > 0) {
    frame.data[frame.length - 1] ^= 1;
    --faults_.flip;
  }
  frame.at_us += faults_.delay_us;
  if (!delayed_.empty()) frame.at_us = std::max(frame.at_us, delayed_.back().at_us);
  delayed_.push_back(frame);
  if (faults_.delay_us == 0) pass_delayed(frame.at_us);
}

void ControllerSide::pass_delayed(std::int64_t until_us) {
  while (!delayed_.empty() && delayed_.front().at_us <= until_us) {
    deliver(delayed_.front());
    delayed_.pop_front();
  }
}

void ControllerSide::deliver(const Frame& frame) {
  const std::int64_t at_us = std::max(frame.at_us, last_us_);
  if (at_us < restarted_us_ || at_us >= end_us()) return;
  last_us_ = at_us;
  log_.push_back(frame);
  log_.back().at_us = at_us;
  const glint_frame decoded{frame.identifier, frame.fd, frame.length, frame.data.data()};
  follow_frame(&follower_, &decoded, static_cast<std::uint64_t>(at_us));
}

// Foreign traffic: a burst each millisecond, from this end of the bus.
void ControllerSide::load_bus() {
  std::int64_t sent = 0, owed_bits = 0;
  for (Time at = monotonic_now(); !stop_; at = at + microseconds(k_load_period_us)) {
    if (!sleep_until(at)) return;
    owed_bits += load_percent_ * k_load_period_us / 100;  // one bit a microsecond
    for (; owed_bits >= k_frame_bits; owed_bits -= k_frame_bits) {
      can_frame frame{};
      frame.can_id = k_foreign[static_cast<std::size_t>(sent) % std::size(k_foreign)];
      frame.can_dlc = CAN_MAX_DLEN;
      std::memcpy(frame.data, &sent, sizeof frame.data);
      if (::write(socket_.get(), &frame, sizeof frame) == sizeof frame) ++sent;
    }
  }
}

void ControllerSide::write_results(const std::string& name) {
  stop_ = true;
  receiver_.join();
  loader_.join();
  std::FILE* const log = std::fopen((name + ".log").c_str(), "w");
  std::FILE* const events = std::fopen((name + ".events").c_str(), "w");
  std::FILE* const text = std::fopen((name + ".decisions").c_str(), "w");
  if (log == nullptr || events == nullptr || text == nullptr) return;
  for (const Frame& frame : log_) {
    std::fprintf(log, "(%lld.%06lld) can1 %03X#", static_cast<long long>(frame.at_us / 1'000'000),
                 static_cast<long long>(frame.at_us % 1'000'000), frame.identifier);
    if (frame.fd) std::fprintf(log, "#0");
    for (int i = 0; i < frame.length; ++i) {
      std::fprintf(log, "%02X", frame.data[static_cast<std::size_t>(i)]);
    }
    std::fprintf(log, "\n");
  }
  std::fputs(decisions_.c_str(), text);
  for (const Event& event : events_) {
    std::fprintf(events, "%lld %s\n", static_cast<long long>(event.at_us), event.what.c_str());
  }
  std::fclose(log);
  std::fclose(events);
  std::fclose(text);
}

}  // namespace glint::hil

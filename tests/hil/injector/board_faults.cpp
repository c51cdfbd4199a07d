#include "tests/hil/injector/board_faults.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <ctime>
#include <thread>
#include <utility>
#include <vector>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/sinks/can/socketcan_socket.hpp"
#include "tests/hil/arm64/semihosting.h"

extern char** environ;

namespace glint::hil {
namespace {

constexpr const char* k_tc = "/usr/bin/tc";

// With default scheduling, whatever this thread has.
pid_t spawn(const std::vector<std::string>& words, const std::string& console) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  if (!console.empty()) {
    ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, console.c_str(),
                                       O_WRONLY | O_CREAT | O_APPEND, 0644);
    ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  }
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  const sched_param plain{};
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSCHEDULER);
  ::posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
  ::posix_spawnattr_setschedparam(&attributes, &plain);
  pid_t child = -1;
  if (::posix_spawnp(&child, arguments[0], &files, &attributes, arguments.data(), environ) != 0) {
    child = -1;
  }
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&attributes);
  return child;
}

int status_of(pid_t child) {
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return -1;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void run(const std::vector<std::string>& words) {
  if (const int status = status_of(spawn(words, "")); status != 0) {
    std::fprintf(stderr, "%s %s: exit status %d; expected 0\n", words[0].c_str(), words[1].c_str(),
                 status);
  }
}

// At once: a program that does it would start first.
void set_interface(const std::string& interface, bool up) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(socket.get(), SIOCGIFFLAGS, &request) != 0) return;
  const int flags = up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
  request.ifr_flags = static_cast<short>(flags);
  (void)::ioctl(socket.get(), SIOCSIFFLAGS, &request);
}

void load_processor(Time until, int priority) {
  std::thread([until, priority] {
    apply_settings({"hil-load", -1, priority});
    while (monotonic_now() < until) {
    }
  }).detach();
}

// The machine ends between two instructions; the host's console receives the Unix time.
void cut_power() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  char text[64];
  std::snprintf(text, sizeof text, "power off at %lld ns\n",
                static_cast<long long>(now.tv_sec) * 1'000'000'000 + now.tv_nsec);
  semihosting_call(k_sys_write0, text);
  unsigned long block[2] = {k_stopped_application_exit, 0};
  semihosting_call(k_sys_exit, block);
}

void step_clock(std::int64_t milliseconds) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  now.tv_sec += milliseconds / 1000;
  ::clock_settime(CLOCK_REALTIME, &now);
}

}  // namespace

BoardFaults::BoardFaults(std::string interface, std::string name)
    : interface_(std::move(interface)), name_(std::move(name)) {}

bool BoardFaults::apply(const Command& command) {
  const auto [first, second] = command.number;
  switch (command.target) {
    case Target::interface:
      if (command.verb == "slow" && first > 0) {
        run({k_tc, "qdisc", "replace", "dev", interface_, "root", "tbf", "rate",
             std::to_string(first) + "bit", "burst", "160", "limit", "1600"});
      } else if (command.verb == "slow") {
        run({k_tc, "qdisc", "del", "dev", interface_, "root"});
      } else {
        set_interface(interface_, command.verb == "up");
      }
      return true;
    case Target::bus:
      if (command.verb == "off") send_bus_off();
      return false;  // the rest is at the other end
    case Target::clock:
      step_clock(first);
      return true;
    case Target::load:
      load_processor(monotonic_now() + milliseconds(first), static_cast<int>(second));
      return true;
    case Target::glint:
      if (command.verb == "start") start_glint(command.text, false);
      if (command.verb == "record") start_glint(command.text, true);
      if (command.verb == "hang" && glint_ > 0) ::kill(glint_, SIGSTOP);
      if (command.verb == "continue" && glint_ > 0) ::kill(glint_, SIGCONT);
      if (command.verb == "kill") kill_glint();
      return true;
    case Target::power:
      cut_power();
      return true;
    default:
      return false;
  }
}

void BoardFaults::start_glint(const std::string& cell, bool records) {
  ++starts_;
  const std::string name = starts_ == 1 ? name_ : name_ + "." + std::to_string(starts_);
  std::vector<std::string> words{
      "glint_board",         "--cell", cell,       "--count", "0",           "--board",
      "cortex-a72-emulated", "--out",  "/tmp/out", "--json",  name + ".json"};
  if (records) words.insert(words.end(), {"--record", "/tmp/out/run.mcap"});
  glint_ = spawn(words, name_ + ".console");
}

void BoardFaults::kill_glint() {
  if (glint_ <= 0) return;
  ::kill(glint_, SIGKILL);
  (void)status_of(std::exchange(glint_, -1));
}

int BoardFaults::end_glint() {
  if (glint_ <= 0) return -1;
  ::kill(glint_, SIGCONT);
  ::kill(glint_, SIGTERM);
  return status_of(std::exchange(glint_, -1));
}

// The emulated controllers never leave the bus: the error frames that a driver delivers then.
void BoardFaults::send_bus_off() const {
  const Descriptor socket = open_socketcan(interface_, CanFormat::classic);
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  frame.can_dlc = CAN_ERR_DLC;
  (void)!::write(socket.get(), &frame, sizeof frame);
}

}  // namespace glint::hil

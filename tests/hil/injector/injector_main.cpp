// glint_hil_injector: runs one scenario on the emulated board. It starts Glint, and is its camera
// and the controller at the other end of the bus. It causes the faults of the scenario's script, or
// those that a program on the host requests through a serial port.
#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/session/run_schedule.hpp"
#include "tests/hil/injector/board_faults.hpp"
#include "tests/hil/injector/controller_side.hpp"
#include "tests/hil/injector/faulty_camera.hpp"

namespace glint::hil {
namespace {

constexpr int k_director_priority = k_tick_priority + 4;
constexpr std::int64_t k_lead_ms = 20;  // until the threads run

class Scenario {
 public:
  Scenario(const std::string& script_file, std::string name)
      : name_(std::move(name)),
        script_(load_script(script_file)),
        start_(monotonic_now() + milliseconds(k_lead_ms)),
        camera_("/loop.frames", "/tmp/frames.sock", start_),
        controller_("can1", script_, start_.nanoseconds / 1000),
        board_("can0", name_) {}

  int run(const std::string& port) {
    std::thread listener;
    if (!port.empty()) listener = std::thread([this, port] { listen(port); });
    apply_settings({"hil-director", -1, k_director_priority});
    for (const Command& command : script_.commands) {
      if (!sleep_until(start_ + milliseconds(command.at_ms))) return 1;
      apply(command);
    }
    (void)sleep_until(start_ + milliseconds(script_.ends_ms));
    ended_ = true;
    if (listener.joinable()) listener.join();
    apply_settings({"hil-director", -1, 0});
    const int status = board_.end_glint();
    controller_.write_results(name_);
    camera_.write_deliveries(name_ + ".frames");
    std::printf("%s: Glint's exit status %d\n", name_.c_str(), status);
    return 0;
  }

 private:
  // Those of the bus and the controller also take effect in the controller's own time.
  void apply(const Command& command) {
    const std::lock_guard lock(mutex_);
    if (command.target == Target::camera) return camera_.apply(command);
    (void)board_.apply(command);
    if (command.target == Target::clock) controller_.clock_stepped();
  }

  // A command a line; each is answered by "ok" or the reason.
  void listen(const std::string& port) {
    const int serial = ::open(port.c_str(), O_RDWR | O_NOCTTY);
    termios raw{};  // without an echo
    ::tcgetattr(serial, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(serial, TCSANOW, &raw);
    std::string line;
    while (!ended_) {
      pollfd waited{serial, POLLIN, 0};
      char byte = 0;
      if (::poll(&waited, 1, 20) <= 0 || ::read(serial, &byte, 1) != 1) continue;
      if (byte != '\n') {
        if (byte != '\r') line += byte;
        continue;
      }
      std::string answer = "ok";
      if (const std::optional<Command> command = command_of(line, answer)) {
        apply(*command);
        controller_.apply_now(*command);
      }
      answer += "\n";
      (void)!::write(serial, answer.data(), answer.size());
      line.clear();
    }
    ::close(serial);
  }

  std::string name_;
  Script script_;
  Time start_;
  std::atomic<bool> ended_{false};
  std::mutex mutex_;  // of the next three
  FaultyCamera camera_;
  ControllerSide controller_;
  BoardFaults board_;
};

}  // namespace
}  // namespace glint::hil

int main(int count, char** arguments) {
  if (count < 3 || count > 4) {
    std::fprintf(stderr, "expected: glint_hil_injector SCRIPT NAME [SERIAL_PORT]\n");
    return 2;
  }
  return glint::hil::Scenario(arguments[1], arguments[2]).run(count > 3 ? arguments[3] : "");
}

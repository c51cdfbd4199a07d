// Controller stand-in at the other end of the bus: the C decoder behind an injector of bus faults.
//
// It works in the time of the kernel's stamps: faults and cycles of the controller take effect at
// their time between the frames, however late this thread runs. So it needs no priority over Glint,
// which shares the processor with it, and its decisions repeat on another processor from its log.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "platform/descriptor.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "tests/hil/controller/follow_log.h"
#include "tests/hil/injector/script.hpp"

namespace glint::hil {

struct BusFaults {
  std::int64_t drop = 0;  // frames still to lose
  std::int64_t flip = 0;  // frames still to receive one wrong bit
  bool frozen = false;    // no frame passes
  bool repeats = false;   // each frame has the data of the last one before the fault
  std::int64_t delay_us = 0;
  std::int64_t off_until_us = 0;  // Glint's controller is off the bus
  std::int64_t load_percent = 0;  // of foreign frames, at 1 Mbit/s
};

class ControllerSide {
 public:
  // Receives on `interface`; the first cycle is at `start_us` (CLOCK_MONOTONIC). Commands of the
  // bus and of the controller in `script` take effect at their time.
  ControllerSide(const std::string& interface, const Script& script, std::int64_t start_us);
  ~ControllerSide();
  ControllerSide(const ControllerSide&) = delete;
  ControllerSide& operator=(const ControllerSide&) = delete;

  // A command from outside of the script, now.
  void apply_now(const Command& command);
  // CLOCK_REALTIME, which stamps the frames, was stepped.
  void clock_stepped();
  // Stops, and writes NAME.log (candump -L), NAME.events and NAME.decisions.
  void write_results(const std::string& name);

 private:
  struct Frame {
    std::int64_t at_us = 0;
    std::uint32_t identifier = 0;
    std::uint8_t length = 0;
    bool fd = false;
    std::array<std::uint8_t, 64> data{};
  };
  struct Event {
    std::int64_t at_us;
    std::string what;
  };

  void run();
  void drain(std::int64_t now_us);
  void advance_to(std::int64_t now_us);
  void apply(const Command& command, std::int64_t at_us);
  void disturb(Frame frame);
  void deliver(const Frame& frame);
  void pass_delayed(std::int64_t until_us);
  [[nodiscard]] std::int64_t monotonic_us(std::int64_t stamp_ns, std::int64_t now_us);
  void load_bus();
  [[nodiscard]] std::int64_t end_us() const { return start_us_ + script_.ends_ms * 1000; }

  Descriptor socket_;
  Script script_;
  std::int64_t start_us_, last_us_;
  std::size_t next_command_ = 0;
  std::mutex mutex_;  // of the next two
  std::vector<Command> from_outside_;
  std::array<std::int64_t, 2> real_minus_monotonic_ns_{};  // now, and before the last step
  std::atomic<std::int64_t> load_percent_{0};
  BusFaults faults_;
  std::array<Frame, 2048> last_of_identifier_{};
  std::deque<Frame> delayed_;
  std::int64_t restarted_us_ = 0;  // the controller receives from then on
  follower follower_{};
  std::vector<Frame> log_;
  std::vector<Event> events_;
  std::string decisions_;
  std::atomic<bool> stop_{false};
  RealTimeThread receiver_, loader_;  // last: they use all of the above
};

}  // namespace glint::hil

// What the operating system adds to a chain on this board, measured: an estimate, never a bound.
//
// What:     four figures, each as a distribution, on an otherwise idle board with the priorities
//           of a run: lateness of an absolute sleep; release of one thread by another; how long a
//           thread that only reads the clock is kept from doing so, and how far apart that
//           happens; one write of one CAN frame, in bursts as a tick sends them.
// Cost:     some seconds.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/can/can_sink.hpp"

namespace glint {

struct SystemShareOptions {
  int core = -1;
  int wake_ups = 1000;  // and as many releases
  Duration tick_period = milliseconds(4);
  Duration interrupts_watched = milliseconds(1000);
  int can_bursts = 200;
  int can_frames_a_burst = 5;  // a classic pose
};

struct SystemShareFigures {
  std::vector<std::int64_t> tick_wake_up_ns;   // due -> the sleeping thread runs
  std::vector<std::int64_t> frame_wake_up_ns;  // due -> the thread released by another runs
  std::vector<std::int64_t> interrupt_ns;      // taken from a thread that never gives up the core
  std::vector<std::int64_t> interrupt_gap_ns;  // from one such loss to the next
  std::int64_t clock_read_ns = 0;              // between two undisturbed readings
  std::vector<std::int64_t> can_write_ns;
};

[[nodiscard]] SystemShareFigures measure_system_share(CanSink& can,
                                                      const SystemShareOptions& options);

}  // namespace glint

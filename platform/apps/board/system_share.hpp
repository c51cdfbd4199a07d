// Measurement of the operating system's contribution to the latency of a chain on this machine: an
// estimate, not a bound.
//
// What:     four distributions, on an otherwise idle machine with a run's priorities: lateness of
//           an absolute sleep; release of one thread by another; duration and distance of
//           interruptions of a thread that only reads the clock; write of one CAN frame, in bursts
//           as at a tick.
// Cost:     some seconds.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/sinks/can/can_sink.hpp"

namespace glint {

struct SystemShareOptions {
  int core = -1;
  int wake_ups = 1000;  // and the same number of releases
  Duration tick_period = milliseconds(4);
  Duration interrupts_watched = milliseconds(1000);
  int can_bursts = 200;
  int can_frames_a_burst = 5;  // a classic pose
};

struct SystemShareFigures {
  std::vector<std::int64_t> tick_wake_up_ns;   // due time to start of the sleeping thread
  std::vector<std::int64_t> frame_wake_up_ns;  // due time to start of the released thread
  std::vector<std::int64_t> interrupt_ns;      // time taken from a busy thread
  std::vector<std::int64_t> interrupt_gap_ns;  // between two interruptions
  std::int64_t clock_read_ns = 0;              // between two undisturbed readings
  std::vector<std::int64_t> can_write_ns;
};

[[nodiscard]] SystemShareFigures measure_system_share(CanSink& can,
                                                      const SystemShareOptions& options);

}  // namespace glint

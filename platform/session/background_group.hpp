// The background group of a live run: a slice at every period, beneath frames and ticks.
//
// It runs at the lowest priority of the plan, or where real-time rights are refused at the system's
// idle priority, so that no tick and no frame waits for it. Nothing of it is recorded: what leaves
// a session does not depend on it.
#pragma once

#include <atomic>
#include <cstdint>

#include "nodes/background.hpp"
#include "platform/cells/cell.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/run_plan.hpp"

namespace glint {

struct BackgroundCounts {
  std::uint64_t slices = 0;
  std::uint64_t late = 0;     // of them: ended after the next one was due
  std::uint64_t skipped = 0;  // releases that came while a slice still ran
  Duration longest_response;  // from a nominal release to its slice's end
};

class BackgroundGroup {
 public:
  // The cell has a background. `trace` may be null; it is not yet started.
  BackgroundGroup(const Cell& cell, const GroupPlan<Background>& plan, TraceWriter* trace);

  // The thread that run() wants to be called in.
  [[nodiscard]] static ThreadSettings thread_settings(const GroupPlan<Background>& plan);

  // From `epoch` on, until `stop`; returns at most a slice and some milliseconds after it.
  void run(Time epoch, const std::atomic<bool>& stop) noexcept;

  // When run() has returned.
  [[nodiscard]] const BackgroundCounts& counts() const noexcept { return counts_; }

 private:
  Background graph_;
  GroupRunner<Background> runner_;
  Duration period_;
  BackgroundCounts counts_;
};

}  // namespace glint

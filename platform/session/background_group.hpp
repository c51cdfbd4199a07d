// The background group of a run: a slice of mapping at every period, beneath frames and ticks.
//
// Live it runs at the lowest priority of the plan, or where real-time rights are refused at the
// system's idle priority, so that no tick and no frame waits for it. In order its slices run at
// their nominal times.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "graph/latest.hpp"
#include "nodes/mapper.hpp"
#include "platform/cells/cell.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/depth_loop.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/run_plan.hpp"
#include "platform/session/tracked_capsules.hpp"

namespace glint {

struct BackgroundCounts {
  std::uint64_t slices = 0;
  std::uint64_t late = 0;            // of them: ended after the next one was due
  std::uint64_t skipped = 0;         // releases that came while a slice still ran
  Duration longest_response;         // from a nominal release to its slice's end; in order: none
  int longest_steps = 0;             // of a slice
  std::int64_t pictures_missed = 0;  // taken while another was looked at, and not shown
  MapTotals map;
};

// What the cell's map is made by. Throws InputError where it would refuse a slice's bound.
[[nodiscard]] MapSettings map_settings_of(const Cell& cell);

class BackgroundGroup {
 public:
  // The cell has a background. `trace` may be null; it is not yet started. Takes all its memory.
  BackgroundGroup(const Cell& cell, const GroupPlan<Background>& plan, TraceWriter* trace,
                  DepthLoop pictures);

  // The thread that run() wants to be called in.
  [[nodiscard]] static ThreadSettings thread_settings(const GroupPlan<Background>& plan);

  // From `epoch` on, until `stop`; returns at most a slice and some milliseconds after it.
  void run(Time epoch, const std::atomic<bool>& stop) noexcept;
  // In a run that keeps no real time: all slices that are due by then.
  void reach(Time now) noexcept;

  // The frame group's: what is tracked stays out of the map.
  [[nodiscard]] graph::TripleBuffer<TrackedCapsules>& tracked() noexcept { return tracked_; }

  // When run() has returned: a last map of all pictures that were shown whole.
  void finish() noexcept;
  [[nodiscard]] const BackgroundCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const PointCloud& map() noexcept { return graph_.node<ExtendMap>().map().map(); }

 private:
  void slice(Time nominal, Time now) noexcept;
  void show(std::int64_t number) noexcept;

  Background graph_;
  std::vector<std::byte> memory_;
  GroupRunner<Background> runner_;
  Duration period_;
  DepthLoop pictures_;
  std::int64_t shown_ = 0;
  std::int64_t next_ = 0;  // slice in order
  graph::TripleBuffer<TrackedCapsules> tracked_;
  std::array<LeftOut, k_left_out_max> left_out_;
  BackgroundCounts counts_;
};

}  // namespace glint

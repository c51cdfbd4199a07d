// The groups as a board runs them, and one hash over everything that they decided.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "graph/latest.hpp"
#include "platform/boards/board_run.hpp"
#include "platform/record/sha256.hpp"
#include "platform/session/background_group.hpp"
#include "platform/session/frame_group.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/sinks.hpp"
#include "platform/session/tick_group.hpp"
#include "platform/session/tool_roster.hpp"

namespace glint {

class BoardGroups {
 public:
  BoardGroups(const Cell& cell, Sinks& sinks, const Clock& now, std::int64_t unix_offset_ns,
              std::size_t frames, const BoardBounds& bounds = {}, BackgroundScene scene = {});

  void process(const ArrivedFrame& arrived) noexcept;                  // frame thread
  void tick(std::uint64_t number, Time nominal, Time woken) noexcept;  // tick thread
  void stop_safe() noexcept { tick_.stop_safe(); }                     // likewise, in its place
  // Null where the cell has none; its thread is BackgroundGroup's.
  [[nodiscard]] BackgroundGroup* background() noexcept { return background_.get(); }

  // When all threads have ended.
  void report(BoardResult& result);

 private:
  ToolRoster roster_;
  graph::TripleBuffer<RobotFrame> robot_;
  GroupRunner<Tracker> frame_runner_;
  GroupRunner<Output> tick_runner_;
  FrameGroup frame_;
  TickGroup tick_;
  std::unique_ptr<BackgroundGroup> background_;
  // Each thread has its own hash; the run's is taken over both.
  Sha256 verdicts_, states_;
  std::int64_t frames_ = 0, tracked_ = 0;
};

}  // namespace glint

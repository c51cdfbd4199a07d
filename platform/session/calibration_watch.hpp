// Adds up, in a run, what the tools' residuals show of calibration errors.
//
// Of each frame one tool counts, in turn, so that a frame's cost does not grow with the tools. Of
// each tool, fits count whose pose differs from that of the fit counted before, since a tool at
// rest shows the same errors of lens and range again. Fits that were refused as bad count, too.
#pragma once

#include <array>
#include <vector>

#include "graph/latest.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/report/calibration_findings.hpp"

namespace glint {

class CalibrationWatch {
 public:
  explicit CalibrationWatch(const Cell& cell);

  // After each frame, by its thread. No heap.
  void see(const Tracker& tracker) noexcept;

  // Of the tools of which enough was seen; after the last frame.
  [[nodiscard]] std::vector<CalibrationFinding> findings() const;
  // What they rest on, of one tool.
  [[nodiscard]] const CalibrationErrors& errors_of(std::size_t tool) const {
    return tools_[tool].errors;
  }

  // While frames come, for one other thread that may take its time: every k_review the findings of
  // what it saw so far go to `notes`. Each call takes the newest sums of one tool.
  static constexpr Duration k_review = milliseconds(1000);
  void review(Time now, CalibrationNotes& notes);

 private:
  struct Watched {
    int tool = 0;
    std::uint32_t identity = 0;
    Pose counted;  // T_camera_tool of the last fit that did
    CalibrationErrors errors;
  };
  void see(const Tracker& tracker, const Tool& tool, Watched& watched) noexcept;
  using AllWatched = std::array<Watched, k_tools_max>;
  [[nodiscard]] std::vector<CalibrationFinding> findings_of(const AllWatched& tools) const;

  const Cell& cell_;
  AllWatched tools_;
  std::uint64_t seen_ = 0;  // frames
  graph::TripleBuffer<Watched> shared_;
  AllWatched reviewed_;  // the reviewing thread's
  Time next_review_;
};

}  // namespace glint

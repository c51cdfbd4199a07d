// Adds up, in a run, what the tools' residuals show of calibration errors.
//
// Of each frame one tool counts, in turn, so that a frame's cost does not grow with the tools. Of
// each tool, fits count whose pose differs from that of the fit counted before, since a tool at
// rest shows the same errors of lens and range again. Fits that were refused as bad count, too.
// Where a body stands still in view, each fifth of a second one of its fits shows what the lens,
// the clocks and the headset's drift do to its place in the world.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "graph/latest.hpp"
#include "kernels/motion/world_errors.hpp"
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
  struct SeenBody {
    StampedPose head;  // then
    BodySight sight;
  };
  void see(const Tracker& tracker, const Tool& tool, Watched& watched) noexcept;
  [[nodiscard]] bool body_is_due(int tool, const HeadPose& head, Time now) const;
  void note_body(const OptimalFit& fit, const HeadPose& head) noexcept;
  [[nodiscard]] double time_sigma_s() const;
  using AllWatched = std::array<Watched, k_tools_max>;
  [[nodiscard]] std::vector<CalibrationFinding> findings_of(const AllWatched& tools,
                                                            const WorldErrors& world) const;

  const Cell& cell_;
  AllWatched tools_;
  std::uint64_t seen_ = 0;  // frames
  HeadWalk walk_;
  SeenBody body_;                   // the newest sight
  StampedPose head_before_;         // of the one before
  int in_a_row_ = 0;                // sights, up to 2
  std::optional<Time> last_sight_;  // that world_ took
  WorldErrors world_;
  struct Newest {
    Watched tool;
    WorldErrors world;
  };
  graph::TripleBuffer<Newest> shared_;
  AllWatched reviewed_;  // the reviewing thread's
  WorldErrors reviewed_world_;
  Time next_review_;
};

}  // namespace glint

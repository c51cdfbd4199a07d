// Online estimation of calibration errors from the residuals of the tools' fits, during a run.
//
// Each frame adds the fit of one tool, in turn, so that the cost of a frame does not depend on the
// number of tools. A fit is added if its pose differs from that of the tool's last added fit, since
// a static tool repeats the same errors of lens and range. Fits that the tracker rejected are added
// too. If a reference body is in view, one of its fits every 200 ms shows the effects of lens,
// clocks and headset drift on its world pose.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "graph/latest.hpp"
#include "kernels/motion/world_errors.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/tools/report/calibration_findings.hpp"

namespace glint {

class CalibrationMonitor {
 public:
  explicit CalibrationMonitor(const Cell& cell);

  // Call on the frame thread after each frame. No heap.
  void add_frame(const Tracker& tracker) noexcept;

  // Findings for the tools with at least k_fits_min fits. Call after the last frame.
  [[nodiscard]] std::vector<CalibrationFinding> findings() const;
  // The sums behind the findings of one tool.
  [[nodiscard]] const CalibrationErrors& errors_of(std::size_t tool) const {
    return tools_[tool].errors;
  }

  // Call on one other thread, not real-time, while frames arrive. Writes the findings so far to
  // `notes` every k_review. Each call reads the newest sums of one tool.
  static constexpr Duration k_review = milliseconds(1000);
  void review(Time now, CalibrationFindingsStore& notes);

 private:
  struct Watched {
    int tool = 0;
    std::uint32_t identity = 0;
    Pose counted;  // T_camera_tool of the last added fit
    CalibrationErrors errors;
  };
  struct BodySighting {
    TimedPose head;  // at the sighting
    BodyMeasurement sight;
  };
  void add_fit_of_tool(const Tracker& tracker, const Tool& tool, Watched& watched) noexcept;
  [[nodiscard]] bool body_is_due(int tool, const HeadPose& head, Time now) const;
  void add_sighting(const OptimalFit& fit, const HeadPose& head) noexcept;
  [[nodiscard]] double time_sigma_s() const;
  using AllWatched = std::array<Watched, k_tools_max>;
  [[nodiscard]] std::vector<CalibrationFinding> findings_of(const AllWatched& tools,
                                                            const WorldErrors& world) const;

  const Cell& cell_;
  AllWatched tools_;
  std::uint64_t seen_ = 0;  // frames
  HeadErrorProcess walk_;
  BodySighting body_;               // the newest sighting
  TimedPose head_before_;           // of the sighting before body_
  int consecutive_sightings_ = 0;   // consecutive sightings, up to 2
  std::optional<Time> last_sight_;  // last one added to world_
  WorldErrors world_;
  struct Newest {
    Watched tool;
    WorldErrors world;
  };
  graph::TripleBuffer<Newest> shared_;
  AllWatched reviewed_;  // of the reviewing thread
  WorldErrors reviewed_world_;
  Time next_review_;
};

}  // namespace glint

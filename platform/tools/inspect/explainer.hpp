// Explanations of a run, or of recorded frames, as they arrive: one a tool.
//
// Examines at most ten frames a second; while a tool was never found, a second has one diagnosis
// by trials (diagnosis.hpp), of one such tool after another.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "kernels/pose/head_pose.hpp"
#include "platform/cells/cell.hpp"
#include "platform/tools/inspect/examined_frame.hpp"
#include "platform/tools/inspect/explanation.hpp"

namespace glint {

inline constexpr Duration k_examination_period = milliseconds(100);
inline constexpr Duration k_diagnosis_period = milliseconds(1000);

class Explainer {
 public:
  // The cell outlives it.
  explicit Explainer(const Cell& cell);

  void add_head(const HeadPose& head) noexcept { head_ = head; }
  // Returns whether a frame that arrives then is to be examined.
  [[nodiscard]] bool examines(Time arrival) const noexcept;
  // Examines it; call after the frame's head pose.
  const ExaminedFrame& add_frame(const Frame& frame);
  // A frame that is not examined.
  void add_arrival(Time mid_exposure, Time arrival) noexcept;
  void add_refused(Time arrival, Reason reason) noexcept;
  void add_output(const PoseSample& sample) noexcept;

  // Of the tool's newest output.
  [[nodiscard]] Explanation explanation(std::size_t tool) const;

 private:
  struct Sighting {
    Time time;
    ReferenceFrame base = ReferenceFrame::camera;
    Pose T_base_tool;
  };
  struct ToolState {
    PoseSample newest;
    bool ever_measured = false;
    Time measured;       // its newest measurement
    bool found = false;  // in the newest examined frame
    std::optional<Sighting> last, before;
    LeftView left_view = LeftView::no;
    std::optional<CheckRow> cause;
  };
  void add_sighting(const Track& track, ToolState& tool) const;
  [[nodiscard]] LeftView left_view_of(std::size_t tool, Time time) const;
  void diagnose_next_tool();

  const Cell& cell_;
  FrameExaminer examiner_;
  HeadPose head_;
  std::optional<ExaminedFrame> examined_;
  Time next_examination_, next_diagnosis_;
  bool any_frame_ = false;
  Time arrival_;  // of the newest frame
  Duration frame_age_;
  Reason refused_ = Reason::none;
  std::size_t next_tool_ = 0;  // of the diagnosis
  std::array<ToolState, k_tools_max> tools_;
};

}  // namespace glint

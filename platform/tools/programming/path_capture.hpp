// Path recorder: a state machine over poses and button events that collects a path while the pen's
// button is held. It has neither clock nor thread; the same input gives the same path.
//
//   draw held          a stroke: points at a declared spacing (kernels/path/resample_stroke)
//   draw clicked       a waypoint at the tip's position when the button went down
//   delete_last, undo  deletes the last element; undoes the last change
//   finish             later input is only counted
//
// Only measured poses in the robot's frame extend a stroke. A gap longer than gap_max ends it, and
// the next pose begins another, since the path in the gap is not measured. Memory is allocated in
// the constructor; input beyond the capacity is counted.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/path/resample_stroke.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/tools/programming/path.hpp"

namespace glint {

struct CaptureSettings {
  StrokeSettings stroke;
  Duration click_max = milliseconds(300);  // limits of a click: duration, and distance of the tip
  double click_radius_m = 0.005;
  int points_max = 1 << 16;  // of all elements; includes deleted ones, for undo
  int elements_max = 4096;   // likewise
};

struct CaptureCounts {
  std::int64_t poses = 0;                   // while draw was held
  std::int64_t poses_accepted = 0;          // accepted into strokes
  std::int64_t not_measured = 0;            // rejected: predicted or lost
  std::int64_t not_in_robot = 0;            // rejected: not in the robot's frame
  std::int64_t not_usable = 0;              // rejected: stamp not rising, a jump, not finite
  std::int64_t gaps = 0;                    // strokes ended by a gap in the poses
  std::int64_t presses_without_effect = 0;  // draw without a pose; delete_last, undo without effect
  std::int64_t points_over_capacity = 0;    // beyond points_max
  std::int64_t strokes_over_capacity = 0;   // beyond elements_max
  std::int64_t inputs_after_finish = 0;     // poses and events
};

class PathCapture {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit PathCapture(const CaptureSettings& settings);

  // Requires rising times. Order at equal times: press, pose, release.
  void add(const PoseSample& sample);
  void add(const ButtonEvent& event);
  // Same as the finish button. Ends a stroke in progress.
  void finish();

  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] const CaptureCounts& counts() const { return counts_; }
  // Elements that are not deleted, in the order of drawing, without a stroke in progress.
  [[nodiscard]] DrawnPath path() const;

 private:
  struct Element {
    PathKind kind = PathKind::waypoint;
    int first = 0, count = 0;  // in points_
  };
  struct Change {
    bool added = false;  // else deleted
    int element = 0;     // in elements_
  };

  void press(Time time);
  void release(Time time);
  void begin_stroke();
  void end_stroke();
  void take_points();
  void delete_last();
  void undo();
  void store(Element element);

  CaptureSettings settings_;
  StrokeResampler resampler_;
  std::vector<UncertainPose> points_;
  std::vector<Element> elements_;  // all elements, deleted ones too
  std::vector<int> active_;        // elements that are not deleted
  std::vector<Change> changes_;
  CaptureCounts counts_;
  bool held_ = false, finished_ = false;
  Time pressed_;
  // Of the stroke in progress.
  int first_point_ = 0;
  std::int64_t samples_ = 0;
  Vector3 began_ = Vector3::Zero();
  bool left_click_radius_ = false;
  bool truncated_ = false;     // points of it exceeded the capacity
  bool split_by_gap_ = false;  // a gap ended a stroke of the same press
};

}  // namespace glint

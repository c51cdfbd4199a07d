// Collects a path while the pen's button is held: a state machine of poses and button events, with
// neither clock nor thread. The same input gives the same path.
//
//   draw held          a stroke: points a declared distance apart (kernels/path/resample_stroke)
//   draw clicked       a waypoint where the tip was as the button went down
//   delete_last, undo  take the last element away; take the last change back
//   finish             whatever follows is only counted
//
// A stroke goes on only by measured poses in the robot's frame. Where they stay away for longer
// than gap_max it ends, and another begins with the next one: nobody knows the way between. All
// memory is taken at the start; what does not fit is counted.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/path/resample_stroke.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/programming/path.hpp"
#include "platform/record/button_event.hpp"

namespace glint {

struct CaptureSettings {
  StrokeSettings stroke;
  Duration click_max = milliseconds(300);  // held no longer, and the tip within the reach: a click
  double click_reach_m = 0.005;
  int points_max = 1 << 16;  // of all elements, deleted ones too, for undo may bring them back
  int elements_max = 4096;   // likewise
};

struct CaptureCounts {
  std::int64_t poses = 0;             // while draw was held
  std::int64_t taken = 0;             // of these, into strokes
  std::int64_t not_measured = 0;      // left out: predicted or lost
  std::int64_t not_in_robot = 0;      // left out: the robot's frame was not known
  std::int64_t not_usable = 0;        // left out: the stamp does not rise, a jump, no numbers
  std::int64_t gaps = 0;              // strokes ended by poses that stayed away
  std::int64_t presses_in_vain = 0;   // draw without a pose; delete_last or undo with nothing there
  std::int64_t points_left_out = 0;   // beyond points_max
  std::int64_t strokes_left_out = 0;  // beyond elements_max
  std::int64_t after_finish = 0;      // poses and events
};

class PathCapture {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit PathCapture(const CaptureSettings& settings);

  // In the order of time; a pose and an event of one time: press, pose, release.
  void add(const PoseSample& sample);
  void add(const ButtonEvent& event);
  // As the finish button; ends a stroke that is under way.
  void finish();

  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] const CaptureCounts& counts() const { return counts_; }
  // Elements that stand, in the order in which they were drawn; not a stroke that is under way.
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
  void keep(Element element);

  CaptureSettings settings_;
  StrokeResampler resampler_;
  std::vector<UncertainPose> points_;
  std::vector<Element> elements_;  // all that ever were
  std::vector<int> standing_;      // those that were not deleted
  std::vector<Change> changes_;
  CaptureCounts counts_;
  bool held_ = false, finished_ = false;
  Time pressed_;
  // Of the stroke under way.
  int first_point_ = 0;
  std::int64_t samples_ = 0;
  Vector3 began_ = Vector3::Zero();
  bool left_reach_ = false;
  bool cut_ = false;            // points of it found no room
  bool pieces_before_ = false;  // a gap ended one under the same press
};

}  // namespace glint

// One stroke of a simulated hand: rendered frames through the tracker, then the tip's pose at the
// ticks, live and smoothed in hindsight, against the truth in the robot's frame.
//
// The camera delivers 45 Hz until the tool starts to move, since a reference body is defined by 45
// frames, then the case's rate. The device has no calibration errors and the cell states none: the
// errors judged are noise, interpolation and the headset's localisation.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "platform/formats/trajectory.hpp"
#include "platform/lab/experiments/case_list.hpp"

namespace glint {

enum class StrokeShape { hand, edge, circle };  // free strokes; 300 mm straight; diameter 100 mm

struct StrokeCase {
  StrokeShape shape = StrokeShape::hand;
  bool slow = false;            // 5 Hz
  bool reference_body = false;  // in view; else the headset localises itself
};

// Errors of a method at ticks.
struct StrokeErrors {
  std::int64_t n = 0;
  double position_m2 = 0, rotation_rad2 = 0;                    // sums of squared errors
  double position_variance_m2 = 0, rotation_variance_rad2 = 0;  // sums of stated variances
  std::int64_t position_inside = 0, rotation_inside = 0;        // the 95 % ellipsoid, 3 axes each
  double from_line_m2 = 0;  // sum of squared distances from the edge or the circle

  void add(const UncertainPose& estimate, const Pose& truth);
  void add(const StrokeErrors& other);
  [[nodiscard]] double position_rms_m() const;
  [[nodiscard]] double rotation_rms_rad() const;
  [[nodiscard]] double position_sigma_m() const;
  [[nodiscard]] double rotation_sigma_rad() const;
  [[nodiscard]] double from_line_rms_m() const;
};

struct StrokeTally {
  StrokeErrors smoothed, live;  // at the same ticks
  std::int64_t ticks = 0;       // of the strokes
  std::int64_t frames = 0;      // measured frames within the strokes

  void add(const StrokeTally& other);
};

[[nodiscard]] StrokeTally follow_stroke(const StrokeCase& stroke, std::uint64_t seed);

// A recorded motion, measured with declared noise every `period`, smoothed and judged at the
// measurements and between them. Gaps of the recording end a stroke.
[[nodiscard]] StrokeErrors follow_recorded_stroke(const Trajectory& motion, Duration period,
                                                  std::uint64_t seed);

// With options.data also recorded motions. Strokes at 45 and 5 Hz with and without a reference
// body, a straight edge and a circle.
[[nodiscard]] CaseList run_strokes(const CaseOptions& options);

}  // namespace glint

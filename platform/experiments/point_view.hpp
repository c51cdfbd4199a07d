// A tool as points in a simulated camera: each marker's pixel and range with noise of a declared
// size, without an image. What experiments on the pose alone work on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/pose/decide_labeling.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sim/random.hpp"

namespace glint {

// A tool, which of its axes is its normal (that of its plane, if it is flat), and a point 150 mm
// beyond its markers' mean, across the normal, where a pen of this head has its tip.
struct PointTool {
  std::string name;
  Tool tool;
  Vector3 normal = Vector3::UnitX();
};
// NDI's rigid body 8700339, exactly flat; sawNDITracker, core/share/roms.
[[nodiscard]] PointTool ndi_8700339();
// STTAR's pointer, flat within 0.05 mm, 17 mm rms on its short axis; IRToolTrackingWithHololens2.
[[nodiscard]] PointTool sttar_pointer();
// The built-in pen: five markers, no four in a plane.
[[nodiscard]] PointTool five_marker_pen();

[[nodiscard]] Vector3 marker_mean(const Tool& tool);

// AHAT with its lens as a table of rays at pixel centres, as the device itself has it.
[[nodiscard]] Camera ahat_ray_table();

struct SightNoise {
  double pixel_px = 0.1;  // an axis
  double range_m = 0.001;
  // What is declared of it: an estimator's sigma is never zero.
  [[nodiscard]] MarkerVariance variance() const;
};

// The random numbers of one sample, drawn one after the other.
class SampleNumbers {
 public:
  SampleNumbers(std::uint64_t seed, std::uint64_t case_number, std::uint64_t sample)
      : key_{seed, sim::Stream::points, case_number}, next_(sample << 12) {}
  [[nodiscard]] double within(double low, double high) {
    return low + (high - low) * sim::uniform(key_, next_++);
  }
  [[nodiscard]] double normal() { return sim::gaussian(key_, next_++); }
  [[nodiscard]] Vector3 vector(double sigma);
  [[nodiscard]] int below(int n);

 private:
  sim::RandomKey key_;
  std::uint64_t next_;
};

// A pose and what a flat tool would look like nearly the same in: its plane mirrored in depth.
struct DrawnPose {
  Pose T_camera_tool, T_camera_mirrored;
};
// The markers' mean `range_m` away, within 25 degrees of the axis; the normal tilted by this much
// from the line of sight, about any axis, and the tool turned by any angle about it.
[[nodiscard]] DrawnPose draw_pose(const PointTool& tool, double range_m, double tilt_rad,
                                  SampleNumbers& numbers);

// One frame's markers and what the camera knows of each.
struct PointView {
  Markers markers;
  MarkerSights sights;
  std::array<std::int16_t, k_markers_per_tool_max> truth{};  // of each tool marker, -1: none

  void clear();
  // False: outside the lens. `label` -1: a stray.
  bool add(const Camera& camera, const Tool& tool, const Vector3& centre, int label,
           const SightNoise& noise, SampleNumbers& numbers);
  void shuffle(SampleNumbers& numbers);
};

// Angle between two rotations, radians.
[[nodiscard]] double turned_by(const Pose& a, const Pose& b);

}  // namespace glint

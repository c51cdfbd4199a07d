// Simulated marker observations of a tool without an image: pixel and range of each marker, with
// noise of declared size. Used by experiments on the pose alone.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/pose/decide_labeling.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/sim/random.hpp"

namespace glint {

// A tool and its normal axis (that of its plane, if it is flat). Its tip is 150 mm from the
// markers' mean, perpendicular to the normal, as on a pen with this head.
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

// AHAT with its lens as a table of rays at pixel centres, as on the device.
[[nodiscard]] Camera ahat_ray_table();

struct ObservationNoise {
  double pixel_px = 0.1;  // per axis
  double range_m = 0.001;
  // Declared variance; the range's sigma has a minimum, as an estimator's sigma is never zero.
  [[nodiscard]] MarkerVariance variance() const;
};

// Sequence of random numbers of one sample.
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

// A pose and the one in which a flat tool looks nearly the same: its plane mirrored in depth.
struct DrawnPose {
  Pose T_camera_tool, T_camera_mirrored;
};
// Draws a pose: the markers' mean `range_m` away, within 25 degrees of the optical axis; the normal
// tilted by `tilt_rad` from the line of sight, about a random axis; a random rotation about the
// normal.
[[nodiscard]] DrawnPose draw_pose(const PointTool& tool, double range_m, double tilt_rad,
                                  SampleNumbers& numbers);

// Markers of one frame, with their local rays and variances.
struct PointView {
  Markers markers;
  MarkerObservations sights;
  std::array<std::int16_t, k_markers_per_tool_max> truth{};  // index per tool marker, -1: none

  void clear();
  // Returns false outside the lens or beyond k_blobs_max. `label` -1: a false marker.
  bool add(const Camera& camera, const Tool& tool, const Vector3& centre, int label,
           const ObservationNoise& noise, SampleNumbers& numbers);
  void shuffle(SampleNumbers& numbers);
};

// Returns the angle between the two rotations, radians.
[[nodiscard]] double rotation_between_rad(const Pose& a, const Pose& b);

}  // namespace glint

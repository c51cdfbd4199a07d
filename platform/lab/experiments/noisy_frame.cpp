#include "platform/lab/experiments/noisy_frame.hpp"

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

constexpr double k_range_m = 0.5;
constexpr double k_tilt_most_deg = 45;
constexpr double k_stray_box_m = 0.5;
// Of each axis: 10 mm and 5 degrees are the rms of the whole error.
constexpr double k_per_axis = 0.5773502691896258;
constexpr double k_prior_sigma_m = 0.01 * k_per_axis;
constexpr double k_prior_sigma_rad = 5 * k_radians_per_degree * k_per_axis;
constexpr int k_stray_trials = 20;

// Two spheres whose images touch would be one blob.
bool touches(const PointView& view, const Vector3& place, double radius_m) {
  const double range = place.norm();
  for (int m = 0; m < view.markers.count; ++m) {
    const Marker& marker = view.markers.items[static_cast<std::size_t>(m)];
    const double apart = (place / range - marker.ray).norm();
    if (apart < radius_m / range + radius_m / marker.surface_range_m) return true;
  }
  return false;
}

Vector3 draw_stray(const NoisyFrame& frame, const Vector3& middle, const Tool& tool,
                   SampleNumbers& numbers) {
  Vector3 place;
  for (int trial = 0; trial < k_stray_trials; ++trial) {
    const double x = numbers.within(-0.5, 0.5), y = numbers.within(-0.5, 0.5);
    place = middle + k_stray_box_m * Vector3(x, y, numbers.within(-0.5, 0.5));
    if (!touches(frame.view, place, tool.marker_radius_m)) break;
  }
  return place;
}

}  // namespace

void draw_frame(const NoisyScene& scene, const Camera& camera, SampleNumbers& numbers,
                NoisyFrame& frame) {
  const double tilt = k_radians_per_degree * numbers.within(0, k_tilt_most_deg);
  draw_frame(scene, camera, draw_pose(scene.tool, k_range_m, tilt, numbers).T_camera_tool, numbers,
             frame);
}

void draw_frame(const NoisyScene& scene, const Camera& camera, const Pose& T_camera_tool,
                SampleNumbers& numbers, NoisyFrame& frame) {
  const Tool& tool = scene.tool.tool;
  frame.truth = T_camera_tool;
  const Vector3 mean = marker_mean(tool);
  frame.view.clear();
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 place = frame.truth * tool.markers_m[static_cast<std::size_t>(i)];
    (void)frame.view.add(camera, tool, place, i, scene.noise, numbers);
  }
  for (int s = 0; s < scene.strays; ++s) {
    const Vector3 place = draw_stray(frame, frame.truth * mean, tool, numbers);
    (void)frame.view.add(camera, tool, place, -1, scene.noise, numbers);
  }
  frame.view.shuffle(numbers);
  frame.prior.reference_m = mean;
  Pose& prior = frame.prior.T_camera_tool;
  prior.rotation =
      (from_rotation_vector(numbers.vector(k_prior_sigma_rad)) * frame.truth.rotation).normalized();
  prior.translation = frame.truth * mean + numbers.vector(k_prior_sigma_m) - prior.rotation * mean;
  frame.prior.information = Matrix6::Zero();
  frame.prior.information.diagonal().head<3>().setConstant(1 / (k_prior_sigma_m * k_prior_sigma_m));
  frame.prior.information.diagonal().tail<3>().setConstant(1 /
                                                           (k_prior_sigma_rad * k_prior_sigma_rad));
}

}  // namespace glint

#include "platform/lab/experiments/point_run.hpp"

#include "kernels/motion/interpolate.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

constexpr double k_distance_m = 0.5;
constexpr double k_half_turn = 3.14159265358979323846;
constexpr std::uint64_t k_frames_max = 1 << 20;  // per run: the noise of two runs never overlaps

}  // namespace

Vector3 direction(std::uint64_t seed, std::uint64_t run, std::uint64_t which) {
  const sim::RandomKey key{seed, sim::Stream::hand, which};
  return sim::gaussian_vector(key, run).normalized();
}

Pose held_pose(double tilt_rad, std::uint64_t seed, std::uint64_t run) {
  const sim::RandomKey key{seed, sim::Stream::hand, 0};
  const double roll = k_half_turn * (2 * sim::uniform(key, 2 * run) - 1);
  const double side = k_half_turn * (2 * sim::uniform(key, 2 * run + 1) - 1);
  // Points the tool's x axis, normal to its markers, towards the camera.
  const Quaternion facing = from_rotation_vector(0.5 * k_half_turn * Vector3::UnitY());
  const Quaternion rolled = from_rotation_vector(roll * Vector3::UnitZ());
  const Vector3 tilt_axis = from_rotation_vector(side * Vector3::UnitZ()) * Vector3::UnitX();
  return {from_rotation_vector(tilt_rad * tilt_axis) * rolled * facing, {0, 0, k_distance_m}};
}

Result<UncertainPose> measure(const PointCamera& camera, const std::vector<Vector3>& model_m,
                              const Pose& truth, const PointNoise& noise, std::uint64_t frame) {
  const Vector3 sigma =
      noise.share * Vector3(camera.pixel_sigma_px, camera.pixel_sigma_px, camera.range_sigma_m);
  std::vector<Vector3> seen;
  for (std::size_t i = 0; i < model_m.size(); ++i) {
    const sim::RandomKey key{noise.seed, sim::Stream::blob, i};
    seen.push_back(seen_at(camera, truth * model_m[i]) +
                   sigma.cwiseProduct(sim::gaussian_vector(key, noise.run * k_frames_max + frame)));
  }
  return fit_points(camera, model_m, seen);
}

}  // namespace glint

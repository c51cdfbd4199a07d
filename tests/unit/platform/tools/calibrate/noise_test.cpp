#include "platform/tools/calibrate/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "platform/sim/random.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"

namespace glint::noise_test {
namespace {

const AxisNoise k_position{0.0001, 0.0003, 0.0005}, k_rotation{0.001, 0.003, 0.002};
constexpr CorrelationTimes k_times{0.5, 20};

// Poses of a static tool every 0.2 s, with this noise on all axes.
std::vector<TimedPose> rest(int frames, std::uint64_t seed) {
  const sim::RandomKey key{seed, sim::Stream::reference};
  const double keep_fast = std::exp(-0.2 / k_times.fast_s);
  const double keep_slow = std::exp(-0.2 / k_times.slow_s);
  Vector6 fast = Vector6::Zero(), slow = Vector6::Zero();
  std::vector<TimedPose> poses;
  std::uint64_t drawn = 0;
  for (int frame = 0; frame < frames; ++frame) {
    Vector6 error;
    for (int k = 0; k < 6; ++k) {
      const AxisNoise& noise = k < 3 ? k_position : k_rotation;
      const auto step = [&](double keep, double& state) {
        const double next = sim::gaussian(key, drawn++);
        state = frame == 0 ? next : keep * state + std::sqrt(1 - keep * keep) * next;
        return state;
      };
      error(k) = noise.fast * step(keep_fast, fast(k)) + noise.slow * step(keep_slow, slow(k)) +
                 noise.white * sim::gaussian(key, drawn++);
    }
    poses.push_back(
        {Time{} + milliseconds(200) * frame,
         {from_rotation_vector(error.tail<3>()), Vector3(0.1, 0, 0.5) + error.head<3>()}});
  }
  return poses;
}

TEST(Noise, IsFoundByItsAllanDeviation) {
  const NoiseCalibration found = calibrate_noise(rest(6000, 3), "rest");
  EXPECT_NEAR(found.period_s, 0.2, 1e-9);
  EXPECT_GT(found.correlation.fast_s, 0.25);
  EXPECT_LT(found.correlation.fast_s, 1);
  EXPECT_GT(found.correlation.slow_s, 8);
  EXPECT_LT(found.correlation.slow_s, 60);
  double fast = 0, slow = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    fast += found.axes[k].fast * found.axes[k].fast / 3;
    slow += found.axes[k].slow * found.axes[k].slow / 3;
  }
  EXPECT_NEAR(std::sqrt(fast), k_position.fast, 0.2 * k_position.fast);
  EXPECT_NEAR(std::sqrt(slow), k_position.slow, 0.3 * k_position.slow);
  EXPECT_LT(found.worst_factor, 1.5);
  // The model's Allan deviation at one frame: white and fast noise only, where the test uses no
  // closed form.
  EXPECT_NEAR(allan_deviation({0.002, 0, 0}, k_times, 0.2, 4), 0.001, 1e-12);
}

TEST(Noise, RefusesWhatIsNoRest) {
  const std::vector<TimedPose> few = rest(50, 1);
  test::expect_input_error([&] { (void)calibrate_noise(few, "few.tum"); }, {"few.tum: 50 poses"});
  std::vector<TimedPose> moved = rest(200, 1);
  moved[150].pose.translation.x() += 0.05;
  test::expect_input_error([&] { (void)calibrate_noise(moved, "moved.tum"); },
                           {"moved.tum: the tool moved by 5"});
  std::vector<TimedPose> alike = rest(200, 1);
  for (TimedPose& pose : alike) pose.pose = alike.front().pose;
  test::expect_input_error([&] { (void)calibrate_noise(alike, "alike.tum"); },
                           {"all poses are equal"});
}

TEST(Noise, OfTwoBodiesIsThatOfTheirRelativePose) {
  std::vector<TimedPose> tool = rest(20, 1), body;
  const Pose drift{from_rotation_vector({0, 0, 0.3}), {1, 2, 3}};
  for (std::size_t i = 0; i < tool.size(); ++i) {
    const Pose at{Quaternion::Identity(), {0.01 * static_cast<double>(i), 0, 0}};
    body.push_back({tool[i].time + milliseconds(3), drift * at});
    tool[i].pose = drift * at * tool[i].pose;
  }
  body.erase(body.begin() + 7);
  const std::vector<TimedPose> relative = relative_poses(tool, body, milliseconds(20));
  ASSERT_EQ(relative.size(), 19u);
  for (const TimedPose& pose : relative)
    EXPECT_LT((pose.pose.translation - Vector3(0.1, 0, 0.5)).norm(), 0.005);
}

// The marker errors are recovered from the pose errors that they cause.
TEST(Noise, GivesTheErrorsOfEachMarker) {
  const Cell cell = default_cell();
  const Tool& tool = cell.tools.items[0];
  const Pose T_camera_tool{from_rotation_vector({0.4, 0.9, -0.3}), {0.02, 0.03, 0.45}};
  std::vector<WeightedMarker> markers;
  std::vector<LocalRays> rays;
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 point = T_camera_tool * tool.markers_m[static_cast<std::size_t>(i)];
    int steps = 0;
    rays.push_back(local_rays(cell.camera.model, project(cell.camera.model, point).value,
                              k_ray_steps_max, steps)
                       .value);
    markers.push_back(whiten_marker(tool.markers_m[static_cast<std::size_t>(i)], rays.back(),
                                    point.norm(), {0.01, 0, 0.01, 0.0015 * 0.0015})
                          .value);
  }
  CameraUncertainty truth = k_exact_camera;
  truth.correlated_range_m = 0.0012;
  truth.correlated_centroid_px = 0.08;
  truth.fast_share = 0.3;
  const CorrelatedErrors errors =
      systematic_covariance(markers, rays, T_camera_tool, tool.middle_m(), truth, 0)
          .value.correlated;
  NoiseCalibration noise;
  for (int k = 0; k < 6; ++k) {
    noise.axes[static_cast<std::size_t>(k)] = {0, std::sqrt(errors.fast(k, k)),
                                               std::sqrt(errors.slow(k, k))};
  }
  const CameraUncertainty found = marker_errors_of(noise, cell, tool, T_camera_tool);
  EXPECT_NEAR(found.correlated_range_m, 0.0012, 1e-6);
  EXPECT_NEAR(found.correlated_centroid_px, 0.08, 1e-4);
  EXPECT_NEAR(found.fast_share, 0.3, 1e-9);
  EXPECT_EQ(found.principal_point_px, cell.camera.uncertainty.principal_point_px);
  // White noise alone gives marker errors of zero, and no NaN.
  const CameraUncertainty white = marker_errors_of({}, cell, tool, T_camera_tool);
  EXPECT_EQ(white.correlated_range_m, 0);
  EXPECT_EQ(white.correlated_centroid_px, 0);
  EXPECT_EQ(white.fast_share, cell.camera.uncertainty.fast_share);
  noise.axes[2] = {0.001, 0, 0};
  EXPECT_TRUE(std::isfinite(marker_errors_of(noise, cell, tool, T_camera_tool).correlated_range_m));
}

}  // namespace
}  // namespace glint::noise_test

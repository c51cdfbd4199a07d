#include "kernels/pose/calibration_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::calibration_errors_test {
namespace {

using test::Random;

constexpr MarkerVariance k_variance{0.01, 0, 0.01, 0.0015 * 0.0015};
constexpr double k_marker_sigma_m = 0.0003;
constexpr CameraUncertainty k_stated;

// In declared standard deviations.
struct Errors {
  ErrorVector sigmas = ErrorVector::Zero();

  void apply(const CameraModel& camera, Vector2& pixel, double& range_m) const {
    const Vector2 principal(camera.cx, camera.cy);
    pixel += sigmas(4) * k_stated.focal_scale * (pixel - principal);
    pixel += k_stated.principal_point_px * sigmas.segment<2>(2);
    range_m += k_stated.range_offset_m * sigmas(0) + k_stated.range_scale * sigmas(1) * range_m;
  }
};

// Measurements of a tool by a device with these errors.
struct Measurements {
  std::vector<WeightedMarker> markers;
  std::vector<LocalRays> rays;
  std::vector<int> of_tool;

  Measurements(const Tool& tool, const Pose& pose, const Errors& errors, double noise,
               Random& random) {
    const CameraModel camera = test::pinhole();
    for (int i = 0; i < tool.marker_count; ++i) {
      const auto m = static_cast<std::size_t>(i);
      const Vector3 true_marker_m =
          tool.markers_m[m] + k_marker_sigma_m * errors.sigmas.segment<3>(k_common_errors + 3 * i);
      const Vector3 point = pose * true_marker_m;
      Vector2 pixel = project(camera, point).value;
      double range_m = point.norm();
      errors.apply(camera, pixel, range_m);
      pixel += noise * random.vector(0.1).head<2>();
      range_m += noise * 0.0015 * random.normal();
      int steps = 0;
      rays.push_back(local_rays(camera, pixel, k_ray_steps_max, steps).value);
      markers.push_back(whiten_marker(tool.markers_m[m], rays.back(), range_m, k_variance).value);
      of_tool.push_back(i);
    }
  }
  Result<OptimalFit> add_to(CalibrationErrors* sums, const Pose& pose) const {
    return add_fit(markers, rays, of_tool, pose, k_stated, k_marker_sigma_m, sums);
  }
};

Pose held_pose(const Tool& tool, Random& random) {
  const Vector3 place(random.within(-0.2, 0.2), random.within(-0.2, 0.2), random.within(0.35, 0.7));
  const Quaternion turn = random.rotation();
  return {turn, place - turn * test::mean_of_markers(tool)};
}

// Sums over fits of a hand-held tool, each at the true pose.
CalibrationErrors seen_by(const Tool& tool, const Errors& errors, int fits, Random& random) {
  CalibrationErrors sums;
  for (int n = 0; n < fits; ++n) {
    const Pose pose = held_pose(tool, random);
    EXPECT_TRUE(Measurements(tool, pose, errors, 1, random).add_to(&sums, pose));
  }
  return sums;
}

ErrorMatrix covariance_of(const CalibrationErrors& sums) {
  ErrorMatrix matrix = sums.information.selfadjointView<Eigen::Lower>();
  matrix.diagonal().array() += 1;
  return inverse_of(matrix);
}

// Errors drawn from the declared distributions: NEES of the estimate.
TEST(CalibrationErrors, LieWithinTheirCovariance) {
  Random random(7);
  double squares = 0;
  constexpr int k_devices = 60;
  for (int device = 0; device < k_devices; ++device) {
    const Tool tool = test::random_tool(random, 4 + device % 4);
    Errors errors;
    for (int i = 0; i < k_common_errors + 3 * tool.marker_count; ++i)
      errors.sigmas(i) = random.normal();
    const CalibrationErrors sums = seen_by(tool, errors, 30, random);
    EXPECT_EQ(sums.fits, 30);
    const ErrorMatrix covariance = covariance_of(sums);
    const ErrorVector off = covariance * sums.information_vector - errors.sigmas;
    squares += off.dot(ErrorVector(solve_symmetric(covariance, off))) /
               (k_common_errors + 3 * tool.marker_count);
  }
  // These measurements lack the correlated and uncalibrated errors that inflate the stated noise,
  // so the estimate's errors are a little smaller.
  EXPECT_GT(squares / k_devices, 0.5);
  EXPECT_LT(squares / k_devices, 1.2);
}

// One error of four standard deviations.
TEST(CalibrationErrors, FindARangeOffsetAndAMarkerOutOfPlace) {
  Random random(8);
  const Tool tool = test::random_tool(random, 5);
  Errors offset, marker;
  offset.sigmas(0) = 4;
  marker.sigmas.segment<3>(k_common_errors + 6) = Vector3(4, 0, -4);
  const CalibrationErrors of_offset = seen_by(tool, offset, 60, random);
  const ErrorVector found = covariance_of(of_offset) * of_offset.information_vector;
  EXPECT_GT(found(0), 2.5);
  EXPECT_LT(found.tail(k_calibration_errors - k_common_errors).cwiseAbs().maxCoeff(), 1.5);
  const CalibrationErrors of_marker = seen_by(tool, marker, 60, random);
  const ErrorVector moved = covariance_of(of_marker) * of_marker.information_vector;
  EXPECT_LT(std::abs(moved(0)), 1);
  // A translation of the whole tool is part of the pose, and its scale may be the focal length's.
  // Only the shape is observable.
  const auto shape_of = [&tool](const ErrorVector& errors) {
    std::vector<double> distances;
    double sum = 0;
    for (int a = 0; a < tool.marker_count; ++a) {
      for (int b = 0; b < a; ++b) {
        const Vector3 apart = tool.markers_m[static_cast<std::size_t>(a)] -
                              tool.markers_m[static_cast<std::size_t>(b)] +
                              k_marker_sigma_m * (errors.segment<3>(k_common_errors + 3 * a) -
                                                  errors.segment<3>(k_common_errors + 3 * b));
        distances.push_back(apart.norm());
        sum += apart.norm();
      }
    }
    for (double& distance : distances) distance *= static_cast<double>(distances.size()) / sum;
    return distances;
  };
  const std::vector<double> drawn = shape_of(ErrorVector::Zero()), made = shape_of(marker.sigmas),
                            seen = shape_of(moved);
  double largest = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_NEAR(seen[i], made[i], 0.0025) << i;
    largest = std::max(largest, std::abs(made[i] - drawn[i]));
  }
  EXPECT_GT(largest, 0.006);
}

// A common translation of all markers is a translation of the tool.
TEST(CalibrationErrors, LeaveOpenWhatAPoseExplains) {
  Random random(9);
  const Tool tool = test::random_tool(random, 5);
  const ErrorMatrix covariance = covariance_of(seen_by(tool, {}, 20, random));
  ErrorVector shift = ErrorVector::Zero();
  for (int i = 0; i < tool.marker_count; ++i) shift(k_common_errors + 3 * i) = std::sqrt(0.2);
  EXPECT_NEAR(shift.dot(covariance * shift), 1, 1e-6);
  EXPECT_LT(covariance(0, 0), 0.7);
  EXPECT_LT(covariance(2, 2), 0.5);
}

TEST(CalibrationErrors, AddNothingOfAFitThatIsNotDetermined) {
  Random random(10);
  CalibrationErrors sums;
  const std::vector<WeightedMarker> none;
  EXPECT_EQ(add_fit(none, {}, {}, Pose{}, k_stated, k_marker_sigma_m, &sums).reason,
            Reason::degenerate);
  // Three times the same marker.
  int steps = 0;
  const LocalRays rays = local_rays(test::pinhole(), {200, 200}, k_ray_steps_max, steps).value;
  const Vector3 point = rays.ray * 0.5;
  const WeightedMarker one = whiten_marker(Vector3::Zero(), rays, 0.5, k_variance).value;
  const Pose pose{Quaternion::Identity(), point};
  EXPECT_EQ(add_fit(std::vector(3, one), std::vector(3, rays), std::vector{0, 1, 2}, pose, k_stated,
                    k_marker_sigma_m, &sums)
                .reason,
            Reason::degenerate);
  EXPECT_EQ(sums.fits, 0);
  EXPECT_TRUE(sums.information_vector.isZero());
}

// Two swapped markers: no declared error explains the residuals, even eight times as large.
TEST(CalibrationErrors, AddNothingOfAWrongLabeling) {
  Random random(11);
  const Tool tool = test::random_tool(random, 5);
  CalibrationErrors sums;
  int refused = 0;
  for (int n = 0; n < 20; ++n) {
    const Pose pose = held_pose(tool, random);
    Measurements seen(tool, pose, {}, 1, random);
    std::swap(seen.markers[0].model_m, seen.markers[1].model_m);
    refused += seen.add_to(&sums, pose).reason == Reason::bad_fit ? 1 : 0;
  }
  EXPECT_EQ(refused, 20);
  EXPECT_EQ(sums.fits, 0);
}

// From a nearby pose: the optimum, its covariance and its derivatives by the common errors.
TEST(CalibrationErrors, GiveTheOptimumAndWhatMovesIt) {
  Random random(12);
  for (int n = 0; n < 10; ++n) {
    const Tool tool = test::random_tool(random, 5);
    const Pose pose = held_pose(tool, random);
    Pose beside = pose;
    beside.translation += Vector3(0.0005, -0.0003, 0.0004);
    const OptimalFit exact = Measurements(tool, pose, {}, 0, random).add_to(nullptr, beside).value;
    EXPECT_LT((exact.T_camera_tool.translation - pose.translation).norm(), 2e-5);
    EXPECT_LT(exact.T_camera_tool.rotation.angularDistance(pose.rotation), 2e-4);
    for (int error = 0; error < k_common_errors; ++error) {
      Errors one;
      one.sigmas(error) = 0.1;
      const OptimalFit moved = Measurements(tool, pose, one, 0, random).add_to(nullptr, pose).value;
      Vector6 by;
      by << moved.T_camera_tool.translation - pose.translation,
          rotation_vector(moved.T_camera_tool.rotation * pose.rotation.conjugate());
      const Vector6 stated = 0.1 * exact.by_errors.col(error);
      EXPECT_LT((by - stated).norm(), 0.1 * stated.norm()) << error;
    }
  }
}

}  // namespace
}  // namespace glint::calibration_errors_test

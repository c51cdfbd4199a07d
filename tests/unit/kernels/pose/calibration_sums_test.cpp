// Sums of the calibration errors and a fit's optimum against full matrices.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/pose/calibration_errors.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::calibration_sums_test {
namespace {

using test::Random;
using Full = Eigen::MatrixXd;

constexpr MarkerVariance k_variance{0.01, 0.003, 0.02, 0.0015 * 0.0015};
constexpr CameraUncertainty k_stated{0.005, 0.02, 2, 0.004, 0.0009, 0.06, 0.6, 0.002};
constexpr double k_marker_sigma_m = 0.0004;

// A tool with noise on every measurement; its markers are in reversed order.
struct Measurements {
  std::vector<WeightedMarker> markers;
  std::vector<LocalRays> rays;
  std::vector<int> of_tool;

  Measurements(const Tool& tool, const Pose& pose, Random& random) {
    const CameraModel camera = test::pinhole();
    for (int i = tool.marker_count - 1; i >= 0; --i) {
      const Vector3& model = tool.markers_m[static_cast<std::size_t>(i)];
      const Vector2 pixel = project(camera, pose * model).value + 0.1 * random.vector(1).head<2>();
      int steps = 0;
      rays.push_back(local_rays(camera, pixel, k_ray_steps_max, steps).value);
      const double range_m = (pose * model).norm() + 0.0015 * random.normal();
      markers.push_back(whiten_marker(model, rays.back(), range_m, k_variance).value);
      of_tool.push_back(i);
    }
  }
  Result<OptimalFit> add_to(CalibrationErrors* sums, const Pose& pose) const {
    return add_fit(markers, rays, of_tool, pose, k_stated, k_marker_sigma_m, sums);
  }
};

// The three residuals of marker i with its model position displaced by `moved` and its pixel by
// `pixel`.
Vector3 residuals(const Measurements& seen, std::size_t i, const Pose& pose, const Vector3& moved,
                  const Vector2& pixel, double range_off_m) {
  const WeightedMarker& marker = seen.markers[i];
  const LocalRays& rays = seen.rays[i];
  const Vector3 point = pose * (marker.model_m + moved);
  const double along = marker.ray.dot(point);
  const Vector3 turned = rays.along_x * pixel.x() + rays.along_y * pixel.y();
  const Vector3 apart = point / along - turned;
  Vector3 off(marker.across_first.dot(apart), marker.across_second.dot(apart),
              point.norm() - marker.range_m - range_off_m);
  // Uncalibrated and correlated errors inflate each residual: both axes of the pixel, and the
  // range.
  const double slow_px2 = 0.06 * 0.06 + 4 * 0.1 * 0.1;
  const double slow_m2 = 0.0009 * 0.0009 + 16 * 0.001 * 0.001;
  for (int k = 0; k < 2; ++k) {
    const Vector3& across = k == 0 ? marker.across_first : marker.across_second;
    const double right = across.dot(rays.along_x), down = across.dot(rays.along_y);
    off(k) /= std::sqrt(1 + slow_px2 * (right * right + down * down));
  }
  off.z() /= std::sqrt(std::pow(1 / marker.per_range_sigma, 2) + slow_m2);
  return off;
}

// Parameters as in the fit: position of the markers' mean, rotation about it.
Pose nudged(const Pose& pose, const Vector3& mean_m, int parameter, double by) {
  Vector3 turn = Vector3::Zero(), shift = Vector3::Zero();
  (parameter < 3 ? shift : turn)(parameter % 3) = by;
  Pose out;
  out.rotation = (from_rotation_vector(turn) * pose.rotation).normalized();
  out.translation = pose * mean_m + shift - out.rotation * mean_m;
  return out;
}

struct FullMatrices {
  Full f;
  Full j;
  Full c;  // minus the derivatives by the errors, per declared sigma
};

// Numerical derivatives of the residuals.
FullMatrices full_matrices_of(const Measurements& seen, const Pose& pose) {
  const auto n = static_cast<Eigen::Index>(seen.markers.size());
  const Vector3 mean_m = mean_of(seen.markers), none = Vector3::Zero();
  const Vector2 still = Vector2::Zero(), principal(256, 256);
  FullMatrices out{Full(3 * n, 1), Full(3 * n, 6), Full::Zero(3 * n, k_calibration_errors)};
  constexpr double k_h = 1e-6;
  for (Eigen::Index row = 0; row < n; ++row) {
    const auto i = static_cast<std::size_t>(row);
    out.f.block<3, 1>(3 * row, 0) = residuals(seen, i, pose, none, still, 0);
    for (int p = 0; p < 6; ++p)
      out.j.block<3, 1>(3 * row, p) =
          (residuals(seen, i, nudged(pose, mean_m, p, k_h), none, still, 0) -
           residuals(seen, i, nudged(pose, mean_m, p, -k_h), none, still, 0)) /
          (2 * k_h);
    // -C: an error adds this to the computed residuals.
    const auto by = [&](int error, const Vector3& moved, const Vector2& pixel, double range_m) {
      const auto at = [&](double h) {
        return residuals(seen, i, pose, h * moved, h * pixel, h * range_m);
      };
      out.c.block<3, 1>(3 * row, error) = -(at(k_h) - at(-k_h)) / (2 * k_h);
    };
    by(0, none, still, k_stated.range_offset_m);
    by(1, none, still, k_stated.range_scale * seen.markers[i].range_m);
    by(2, none, {k_stated.principal_point_px, 0}, 0);
    by(3, none, {0, k_stated.principal_point_px}, 0);
    by(4, none, k_stated.focal_scale * (seen.rays[i].pixel - principal), 0);
    // A marker's true position differs from the tool file's: the model's residual, with negative
    // sign.
    for (int axis = 0; axis < 3; ++axis)
      by(k_common_errors + 3 * seen.of_tool[i] + axis, -k_marker_sigma_m * Vector3::Unit(axis),
         still, 0);
  }
  return out;
}

Pose held_pose(const Tool& tool, Random& random) {
  const Vector3 place(random.within(-0.2, 0.2), random.within(-0.2, 0.2), random.within(0.35, 0.7));
  const Quaternion turn = random.rotation();
  return {turn, place - turn * test::mean_of_markers(tool)};
}

TEST(CalibrationSums, AreThoseOfTheWholeMatricesWithoutThePosesPart) {
  Random random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Tool tool = test::random_tool(random, 3 + trial % 6);
    CalibrationErrors sums;
    ErrorMatrix information = ErrorMatrix::Zero();
    ErrorVector pull = ErrorVector::Zero();
    double ranges_m = 0;
    for (int fit = 0; fit < 2; ++fit) {
      const Pose pose = held_pose(tool, random);
      const Measurements seen(tool, pose, random);
      ASSERT_TRUE(seen.add_to(&sums, pose));
      const FullMatrices full = full_matrices_of(seen, pose);
      const Full jt = full.j.transpose(), normal = jt * full.j;
      const Full left = full.f - full.j * solve_symmetric(normal, jt * full.f);
      const Full kept = full.c - full.j * solve_symmetric(normal, jt * full.c);
      const Full kept_t = kept.transpose();
      information += Full(kept_t * kept);
      pull -= Full(kept_t * left);
      for (const WeightedMarker& marker : seen.markers)
        ranges_m += marker.range_m / tool.marker_count;
      EXPECT_EQ(sums.fits, fit + 1);
    }
    EXPECT_NEAR(sums.ranges_m, ranges_m, 1e-12);
    const double scale = information.norm();
    for (int c = 0; c < k_calibration_errors; ++c) {
      EXPECT_NEAR(sums.information_vector(c), pull(c), 1e-6 * (1 + pull.norm()))
          << trial << " " << c;
      for (int r = c; r < k_calibration_errors; ++r)
        EXPECT_NEAR(sums.information(r, c), information(r, c), 1e-6 * scale) << r << " " << c;
    }
  }
}

TEST(CalibrationSums, GiveTheStepToTheOptimumItsCovarianceAndWhatMovesIt) {
  Random random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Tool tool = test::random_tool(random, 3 + trial % 6);
    const Pose pose = held_pose(tool, random);
    const Measurements seen(tool, pose, random);
    const Result<OptimalFit> fit = seen.add_to(nullptr, pose);
    ASSERT_TRUE(fit);
    const FullMatrices full = full_matrices_of(seen, pose);
    const Full jt = full.j.transpose(), inverse = inverse_of(jt * full.j);
    const Vector6 step = Full(-inverse * Full(jt * full.f));
    const Vector3 mean_m = mean_of(seen.markers);
    const Quaternion turned = from_rotation_vector(step.tail<3>()) * pose.rotation;
    const Pose& found = fit.value.T_camera_tool;
    EXPECT_LT(found.rotation.angularDistance(turned), 1e-6);
    EXPECT_LT((found * mean_m - pose * mean_m - step.head<3>()).norm(), 1e-7);
    const Full to_origin = pose_by_pose(-(found.rotation * mean_m));
    const Full moved = to_origin * inverse;
    const Full covariance = moved * Full(to_origin.transpose());
    EXPECT_LT((fit.value.covariance - covariance).norm(), 1e-5 * covariance.norm());
    const Full by_errors = moved * Full(jt * Full(full.c.leftCols(k_common_errors)));
    EXPECT_LT((fit.value.by_errors - by_errors).norm(), 1e-5 * by_errors.norm());
  }
}

TEST(CalibrationSums, NeedThreeMarkersEachInFrontWithItsRayAndItsPlaceInTheTool) {
  Random random(3);
  const Tool tool = test::random_tool(random, 4);
  const Pose pose = held_pose(tool, random);
  const Measurements seen(tool, pose, random);
  CalibrationErrors sums;
  const auto reason = [&](const Measurements& of, const Pose& at) {
    return of.add_to(&sums, at).reason;
  };
  EXPECT_EQ(reason(seen, pose), Reason::none);
  Measurements three = seen;
  three.markers.resize(3);
  EXPECT_EQ(reason(three, pose), Reason::none) << "more rays than markers do no harm";
  three.rays.resize(3);
  three.of_tool.resize(3);
  EXPECT_EQ(reason(three, pose), Reason::none);
  EXPECT_EQ(sums.fits, 3);
  const auto expect_none = [&](auto&& spoil) {
    Measurements spoiled = seen;
    spoil(spoiled);
    EXPECT_EQ(reason(spoiled, pose), Reason::degenerate);
  };
  expect_none([](Measurements& s) { s.markers.resize(2); });
  expect_none([](Measurements& s) { s.rays.resize(3); });
  expect_none([](Measurements& s) { s.of_tool.resize(3); });
  expect_none([](Measurements& s) { s.of_tool[1] = -1; });
  expect_none([](Measurements& s) { s.of_tool[3] = k_markers_per_tool_max; });
  EXPECT_EQ(reason(seen, {pose.rotation, pose.translation - Vector3(0, 0, 2)}), Reason::degenerate);
  Measurements last = seen;
  last.of_tool[3] = k_markers_per_tool_max - 1;
  EXPECT_EQ(reason(last, pose), Reason::none);
  EXPECT_EQ(sums.fits, 4) << "nothing was added of the others";
}

// Of nine markers only the first eight are used.
TEST(CalibrationSums, TakeNoMoreMarkersThanAToolHas) {
  Random random(4);
  const Tool tool = test::random_tool(random, k_markers_per_tool_max);
  const Pose pose = held_pose(tool, random);
  const Measurements seen(tool, pose, random);
  Measurements more = seen;
  more.markers.push_back(seen.markers[0]);
  more.rays.push_back(seen.rays[0]);
  more.of_tool.push_back(-1);
  CalibrationErrors a, b;
  ASSERT_TRUE(seen.add_to(&a, pose));
  ASSERT_TRUE(more.add_to(&b, pose));
  EXPECT_EQ(a.information_vector, b.information_vector);
  EXPECT_EQ(a.ranges_m, b.ranges_m);
}

}  // namespace
}  // namespace glint::calibration_sums_test

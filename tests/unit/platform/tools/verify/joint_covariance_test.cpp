#include "platform/tools/verify/joint_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/platform/tools/verify/made_touches.hpp"

namespace glint::joint_covariance_test {
namespace {

std::vector<Touch> touches_of(const TipSeries& series) {
  std::vector<Touch> touches;
  for (const StaticInterval& interval : find_static_intervals(series))
    touches.push_back(mean_of(series, interval));
  return touches;
}

// The covariance of the drift of two touches decays with time; noise is independent.
TEST(JointCovariance, DriftFadesBetweenTouches) {
  TipSeries series = test::series_of({.touches = 4});
  const std::vector<Touch> touches = touches_of(series);
  const Eigen::MatrixXd drift = joint_covariance(touches, series.stated, TouchPositions::apart);
  const double variance = 1e-6, correlation_s = series.stated.head.rest_correlation_s;
  EXPECT_NEAR(drift(0, 0), variance, 0.05 * variance);
  for (int j = 1; j < 4; ++j) {
    const double apart_s =
        (touches[static_cast<std::size_t>(j)].mean.time - touches[0].mean.time).seconds();
    EXPECT_NEAR(drift(0, 3 * j), variance * std::exp(-apart_s / correlation_s), 0.01 * variance);
    EXPECT_EQ(drift(0, 3 * j + 1), 0);
  }
  EXPECT_LT((drift - drift.transpose()).norm(), 1e-18);
}

// A process much faster than a touch averages out in its mean, and touches do not share it.
TEST(JointCovariance, OfAFastProcessIsFinite) {
  TipSeries series = test::series_of({.touches = 2});
  series.stated.head.rest_correlation_s = 1e-4;
  const std::vector<Touch> touches = touches_of(series);
  const Eigen::MatrixXd covariance =
      joint_covariance(touches, series.stated, TouchPositions::apart);
  EXPECT_TRUE(covariance.allFinite());
  EXPECT_LT(covariance(0, 0), 1e-8);
  EXPECT_NEAR(covariance(0, 3), 0, 1e-20);
}

// The error of the tip is a constant in the tool's frame: it is common to all touches and rotates
// with the tool.
TEST(JointCovariance, TheTipsErrorTurnsWithTheTool) {
  TipSeries series = test::series_of({.touches = 2});
  std::vector<Touch> touches = touches_of(series);
  const Eigen::MatrixXd without = joint_covariance(touches, series.stated, TouchPositions::apart);
  touches[0].mean.rotation = Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitX()));
  touches[1].mean.rotation = Quaternion(Eigen::AngleAxisd(-0.4, Vector3::UnitX()));
  series.stated.tip_sigma_m = 2e-3;
  const Eigen::MatrixXd added =
      joint_covariance(touches, series.stated, TouchPositions::apart) - without;
  EXPECT_NEAR((added.topLeftCorner<3, 3>() - 4e-6 * Matrix3::Identity()).norm(), 0, 1e-18);
  const Matrix3 turned = Eigen::AngleAxisd(0.9, Vector3::UnitX()).toRotationMatrix();
  EXPECT_NEAR((added.block<3, 3>(0, 3) - 4e-6 * turned).norm(), 0, 1e-18);
}

// Lens residual and range ripple differ between positions: a static tool does not show them.
TEST(JointCovariance, OfOnePlaceLeavesOutLensAndRipple) {
  TipSeries series = test::series_of({.touches = 2});
  for (TipObservation& one : series.observations) one.by_markers.col(0) = Vector3(0, 0, 2);
  const std::vector<Touch> touches = touches_of(series);
  const double apart = joint_covariance(touches, series.stated, TouchPositions::apart)(2, 2);
  const double same = joint_covariance(touches, series.stated, TouchPositions::same)(2, 2);
  EXPECT_NEAR(apart - same, 4 * k_range_ripple_m * k_range_ripple_m, 1e-12);
}

}  // namespace
}  // namespace glint::joint_covariance_test

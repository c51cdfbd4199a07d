#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/unit/kernels/pose/correspond_view.hpp"

namespace glint::correspond_prediction_test {
namespace {

using test::ahat;
using test::centres;
using test::labelings_of;
using test::Random;
using test::Scene;

const Pose k_truth{Quaternion::Identity(), Vector3(0, 0, 0.4)};

// The first `seen` markers of a tool at k_truth, without noise.
Markers view_of(const Tool& tool, int seen) {
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < static_cast<std::size_t>(seen); ++i)
    points.push_back(k_truth * tool.markers_m[i]);
  return centres(tool, points);
}

Pose displaced_truth(double off_m) {
  return {k_truth.rotation, k_truth.translation + Vector3(off_m, 0, 0)};
}

TEST(CorrespondPrediction, BelievesThreeMarkersOnlyWhereTheToolCanHaveGot) {
  const Tool pen = test::five_marker_pen();
  const auto find = [&](int seen, double off_m, double partial_gate_m) {
    const Pose prior = displaced_truth(off_m);
    CorrespondSettings settings = ahat();
    settings.partial_gate_m = partial_gate_m;
    return labelings_of(view_of(pen, seen), pen, settings, &prior).count;
  };
  EXPECT_EQ(find(3, 0.019, 0.02), 1);
  EXPECT_EQ(find(3, 0.021, 0.02), 0);
  EXPECT_GE(find(4, 0.021, 0.02), 1);  // four agree by chance far less often
  EXPECT_EQ(find(3, 0.049, 1.0), 1);
  EXPECT_EQ(find(3, 0.051, 1.0), 0);  // never beyond the gate of the first search
}

TEST(CorrespondPrediction, SaysWhatAPredictionIsWorthOnlyWhereItIsMet) {
  const Tool pen = test::five_marker_pen();
  const Markers markers = view_of(pen, pen.marker_count);
  const auto log_prior_ratio = [&](const Pose* prior) {
    return labelings_of(markers, pen, ahat(), prior).items[0].log_prior_ratio_m2;
  };
  const Pose near = displaced_truth(0.012), far = displaced_truth(0.06);
  const double sigma = ahat().range_sigma_m;
  // In units of sigma squared: 6 ln(1 m / 6 mm) at the prediction.
  EXPECT_NEAR(log_prior_ratio(&k_truth), 30.7 * sigma * sigma, 1.5 * sigma * sigma);
  EXPECT_NEAR(log_prior_ratio(&k_truth) - log_prior_ratio(&near), 4 * sigma * sigma,
              1.5 * sigma * sigma);
  EXPECT_EQ(log_prior_ratio(&far), 0);
  EXPECT_EQ(log_prior_ratio(nullptr), 0);
}

// Log prior ratio: twice the logarithm of the densities' ratio, at least one, by the larger of both
// sigmas. Its position is that of the tool's centre.
TEST(CorrespondPrediction, IsWorthTheLogarithmOfItsSureness) {
  const Tool pen = test::five_marker_pen();
  const Markers markers = view_of(pen, pen.marker_count);
  CorrespondSettings settings = ahat();
  settings.prior_gate_m = 0.2;
  const auto log_prior_ratio = [&](const Pose& prior) {
    return labelings_of(markers, pen, settings, &prior).items[0].log_prior_ratio_m2 /
           (settings.range_sigma_m * settings.range_sigma_m);
  };
  for (const auto& [prior_m, range_m] : {std::pair{0.006, 0.0015}, {0.004, 0.007}, {0.02, 0.003}}) {
    settings.prior_sigma_m = prior_m;
    settings.range_sigma_m = range_m;
    const double sigma = std::max(prior_m, range_m), ratio_max = 6 * std::log(1 / sigma);
    EXPECT_NEAR(log_prior_ratio(k_truth), ratio_max, 1e-6);
    EXPECT_NEAR(log_prior_ratio(displaced_truth(2 * sigma)), ratio_max - 4, 1e-6);
    EXPECT_NEAR(log_prior_ratio(displaced_truth(0.15)),
                std::max(1.0, ratio_max - std::pow(0.15 / sigma, 2)), 1e-6);
    const Quaternion turn = from_rotation_vector({0, 0.3, 0});
    const Vector3 middle = pen.middle_m();
    EXPECT_NEAR(log_prior_ratio({turn, k_truth * middle - turn * middle}), ratio_max, 1e-6)
        << "turned about its middle";
  }
}

// One marker beyond the gate is enough to fail.
TEST(CorrespondPrediction, IsMetOnlyWhereEachMarkerLiesWithinTheGate) {
  const Tool pen = test::five_marker_pen();
  CorrespondSettings settings = ahat();
  settings.prior_gate_m = 0.03;
  const Vector3 middle = pen.middle_m();
  double farthest = 0;
  for (const Vector3& marker :
       {pen.markers_m[0], pen.markers_m[1], pen.markers_m[2], pen.markers_m[3], pen.markers_m[4]})
    farthest = std::max(farthest, (marker - middle).cross(Vector3::UnitY()).norm());
  for (const double part : {0.98, 1.02}) {
    const double radians = 2 * std::asin(0.5 * part * 0.03 / farthest);
    const Quaternion turn = from_rotation_vector({0, radians, 0});
    const Pose prior{turn, k_truth * middle - turn * middle};
    const Labelings found = labelings_of(view_of(pen, 5), pen, settings, &prior);
    ASSERT_EQ(found.items[0].count, 5);
    EXPECT_EQ(found.items[0].log_prior_ratio_m2 > 0, part < 1);
  }
}

TEST(CorrespondPrediction, LooksOnlyNearAPredictionThatIsSure) {
  const Tool pen = test::five_marker_pen();
  const Markers markers = view_of(pen, pen.marker_count);
  CorrespondSettings settings = ahat();
  for (const bool only_near : {false, true}) {
    settings.only_near = only_near;
    const auto found_with_prior_off_by = [&](double off_m) {
      const Pose prior = displaced_truth(off_m);
      return labelings_of(markers, pen, settings, &prior).count > 0;
    };
    EXPECT_TRUE(found_with_prior_off_by(0.04));
    EXPECT_EQ(found_with_prior_off_by(0.06), !only_near);
    EXPECT_GT(labelings_of(markers, pen, settings).count, 0) << "without any";
  }
}

TEST(CorrespondPrediction, APredictionDecidesBetweenReadingsThatTheNoiseCannotTellApart) {
  const Tool square = test::tool_of<4>({{0, 0, 0}, {80, 0, 0}, {80, 80, 0}, {0, 80, 0}});
  const Vector3 ahead(0, 0, 0.5);
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < 4; ++i) points.push_back(square.markers_m[i] + ahead);
  points[0].x() += 0.0004;  // so that no two hypotheses have the same residual
  const Markers markers = centres(square, points);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Quaternion turn = from_rotation_vector(Vector3(0, 0, quarter * 1.5707963267948966));
    const Vector3 middle(0.04, 0.04, 0);
    const Pose prior{turn, ahead + middle - turn * middle};
    const Labelings found = labelings_of(markers, square, ahat(), &prior);
    ASSERT_GE(found.count, 4);
    EXPECT_LT(test::angle_between(found.items[0].T_camera_tool.rotation, turn), 0.1) << quarter;
  }
}

// A rectangle rotated by 90 degrees: each corner is off by half the sides' difference along both
// axes. With four markers a likelihood ratio of three sigmas is an rms of 1.5 sigma.
TEST(CorrespondPrediction, OverrulesAResidualOfThreeSigmasAndNoMore) {
  CorrespondSettings settings;
  const double limit_m = 1.5 * settings.range_sigma_m * std::sqrt(2.0);  // of the sides' difference
  const Quaternion quarter = from_rotation_vector(Vector3(0, 0, 1.5707963267948966));
  for (const double part : {0.97, 1.03}) {
    const double longer = 80, shorter = 80 - 1e3 * part * limit_m;
    const Tool plate =
        test::tool_of<4>({{0, 0, 0}, {longer, 0, 0}, {longer, shorter, 0}, {0, shorter, 0}});
    std::vector<Vector3> points;
    for (std::size_t i = 0; i < 4; ++i) points.push_back(k_truth * plate.markers_m[i]);
    const Vector3 middle = plate.middle_m();
    const Pose turned{quarter, k_truth * middle - quarter * middle};
    const Labelings found = labelings_of(centres(plate, points), plate, settings, &turned);
    ASSERT_EQ(found.items[0].count, 4);
    const double off = test::angle_between(found.items[0].T_camera_tool.rotation, quarter);
    EXPECT_EQ(off < 0.1, part < 1) << off;
    EXPECT_NEAR(found.items[0].rms_m, part < 1 ? part * 1.5 * settings.range_sigma_m : 0, 1e-9);
  }
}

TEST(CorrespondPrediction, APredictionDoesNotOverruleAClearResidual) {
  const Tool pen = test::five_marker_pen();
  Random random(7);
  const Scene scene = test::scene_of(pen, {}, random);
  const Pose wrong{random.rotation(), scene.T_camera_tool.translation + Vector3(0.3, 0, 0)};
  const Labelings found = labelings_of(scene.markers, pen, ahat(), &wrong);
  ASSERT_GE(found.count, 1);
  EXPECT_EQ(found.items[0].marker, scene.truth);
}

TEST(CorrespondPrediction, APredictionDoesNotOverruleAReadingThatFitsWorseThanNoiseExplains) {
  const Tool plate = test::tool_of<4>({{0, 0, 0}, {80, 0, 0}, {85, 66, 0}, {0, 60, 0}});
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < 4; ++i) points.push_back(plate.markers_m[i] + Vector3(0, 0, 0.5));
  const CorrespondSettings settings;  // isotropic noise: the wide gate
  const Quaternion half = from_rotation_vector(Vector3(0, 0, 3.14159265358979));
  const Vector3 middle(0.041, 0.031, 0);
  const Pose turned{half, Vector3(0, 0, 0.5) + middle - half * middle};
  const Labelings found = labelings_of(centres(plate, points), plate, settings, &turned);
  const bool competes = std::any_of(
      found.items.begin(), found.items.begin() + found.count, [&](const Labeling& reading) {
        return reading.count == 4 &&
               test::angle_between(reading.T_camera_tool.rotation, half) < 0.1;
      });
  ASSERT_TRUE(competes);
  EXPECT_LT(found.items[0].rms_m, 1e-9);
  EXPECT_LT(found.items[0].T_camera_tool.rotation.angularDistance(Quaternion::Identity()), 1e-6);
}

}  // namespace
}  // namespace glint::correspond_prediction_test

#include "kernels/pose/fit_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

struct Noise {
  double along_m;
  double across_m;
};

struct Case {
  std::vector<Vector3> model;
  std::vector<Vector3> points;
  std::vector<Matrix3> covariances;
  Pose T_camera_tool;
};

Case case_of(test::Random& random, const Noise& noise) {
  Case c;
  const Tool tool = test::five_marker_pen();
  const int n = tool.marker_count;
  c.model.assign(tool.markers_m.begin(), tool.markers_m.begin() + n);
  const Quaternion rotation = random.rotation();
  c.T_camera_tool = {rotation, Vector3(0.05, -0.1, 0.5) - rotation * Vector3(0, 0.02, 0.17)};
  for (const Vector3& marker : c.model) {
    c.points.push_back(c.T_camera_tool * marker);
    c.covariances.push_back(
        marker_covariance(c.points.back().normalized(), noise.along_m, noise.across_m));
  }
  return c;
}

// The six errors of one simulated fit: tip position and rotation about the camera's axes.
Eigen::Matrix<double, 6, 1> simulated_error(const Case& c, const Noise& noise,
                                            test::Random& random) {
  std::vector<Vector3> measured;
  for (const Vector3& point : c.points) {
    const Vector3 ray = point.normalized();
    const Vector3 isotropic = random.vector(noise.across_m);
    measured.push_back(point + isotropic - ray * ray.dot(isotropic) +
                       ray * (noise.along_m * random.normal()));
  }
  const RigidFit fit = fit_rigid(c.model, measured);
  Eigen::Matrix<double, 6, 1> error;
  error << fit.transform.translation - c.T_camera_tool.translation,
      rotation_vector(fit.transform.rotation * c.T_camera_tool.rotation.conjugate());
  return error;
}

TEST(FitCovariance, PredictsTheScatterOfSimulatedFits) {
  const Noise noise{0.0015, 0.0002};
  constexpr int trials = 8000;
  test::Random random(1);
  for (int view = 0; view < 3; ++view) {
    const Case c = case_of(random, noise);
    const auto predicted = fit_covariance(c.points, c.covariances, c.T_camera_tool.translation);
    ASSERT_TRUE(predicted);
    Matrix6 scatter = Matrix6::Zero();
    for (int trial = 0; trial < trials; ++trial) {
      const auto error = simulated_error(c, noise, random);
      scatter += error * error.transpose() / trials;
    }
    // Relative standard deviation of a variance after 8,000 trials: 1.6 %.
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(scatter(i, i) / predicted.value(i, i), 1.0, 0.1) << view << " " << i;
      for (int j = 0; j < i; ++j) {
        const double scale = std::sqrt(predicted.value(i, i) * predicted.value(j, j));
        EXPECT_NEAR((scatter(i, j) - predicted.value(i, j)) / scale, 0.0, 0.1) << i << " " << j;
      }
    }
  }
}

TEST(FitCovariance, OfIsotropicNoiseAtTheMeanIsTheTextbooks) {
  const double sigma = 0.001;
  const std::vector<Vector3> square = {{0.1, 0, 1}, {0, 0.1, 1}, {-0.1, 0, 1}, {0, -0.1, 1}};
  const std::vector<Matrix3> covariances(4, sigma * sigma * Matrix3::Identity());
  const auto result = fit_covariance(square, covariances, Vector3(0, 0, 1));
  ASSERT_TRUE(result);
  EXPECT_NEAR(result.value(0, 0), sigma * sigma / 4, 1e-18);     // mean of four
  EXPECT_NEAR(result.value(3, 3), sigma * sigma / 0.02, 1e-16);  // sum of y^2 + z^2
  EXPECT_NEAR(result.value(5, 5), sigma * sigma / 0.04, 1e-16);
  EXPECT_NEAR(result.value(0, 4), 0.0, 1e-18);
}

TEST(FitCovariance, GrowsWithTheDistanceOfTheReference) {
  test::Random random(2);
  const Case c = case_of(random, {0.0015, 0.0002});
  const Vector3 mean = c.T_camera_tool * Vector3(0, 0.02, 0.17);
  const auto near = fit_covariance(c.points, c.covariances, mean);
  const auto far = fit_covariance(c.points, c.covariances, mean + Vector3(0.5, 0, 0));
  EXPECT_GT(far.value(1, 1), 4 * near.value(1, 1));
  EXPECT_NEAR(far.value(4, 4), near.value(4, 4), 1e-12);
}

// Different standard deviations along and across the ray.
TEST(FitCovariance, OfAMarkerHasItsVarianceAlongAndAcrossTheRay) {
  const Vector3 ray = Vector3(0.3, -0.4, 1).normalized();
  const Vector3 side = ray.unitOrthogonal(), other = ray.cross(side);
  const Matrix3 covariance = marker_covariance(ray, 0.003, 0.0005);
  EXPECT_NEAR(ray.dot(covariance * ray), 9e-6, 1e-18);
  EXPECT_NEAR(side.dot(covariance * side), 0.25e-6, 1e-18);
  EXPECT_NEAR(other.dot(covariance * other), 0.25e-6, 1e-18);
  EXPECT_NEAR(side.dot(covariance * ray), 0, 1e-18);
  EXPECT_NEAR(side.dot(covariance * other), 0, 1e-18);
}

// Against full matrices, about any reference.
TEST(FitCovariance, IsTheNoiseCarriedThroughTheUnweightedFit) {
  test::Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Case c = case_of(random, {0.0015, 0.0002});
    const Vector3 reference = c.points[0] + random.vector(0.2);
    Matrix6 normal = Matrix6::Zero(), covariance_sum = Matrix6::Zero();
    for (std::size_t i = 0; i < c.points.size(); ++i) {
      Eigen::Matrix<double, 3, 6> j;
      j << Matrix3::Identity(), -cross_matrix(c.points[i] - reference);
      normal += j.transpose() * j;
      covariance_sum += j.transpose() * c.covariances[i] * j;
    }
    const Matrix6 inverse = inverse_of(normal);
    const Matrix6 expected = inverse * covariance_sum * inverse;
    const auto found = fit_covariance(c.points, c.covariances, reference);
    ASSERT_TRUE(found);
    EXPECT_LT((found.value - expected).norm(), 1e-8 * expected.norm());
    EXPECT_EQ(found.value, Matrix6(found.value.transpose()));
  }
}

TEST(FitCovariance, RefusesWhatIsNotFinite) {
  test::Random random(4);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Case c = case_of(random, {0.0015, 0.0002});
  const Vector3& tip = c.T_camera_tool.translation;
  std::vector<Matrix3> broken = c.covariances;
  broken[2](1, 1) = none;
  EXPECT_EQ(fit_covariance(c.points, broken, tip).reason, Reason::out_of_range);
  EXPECT_EQ(fit_covariance(c.points, c.covariances, {none, 0, 0}).reason, Reason::out_of_range);
  std::vector<Vector3> points = c.points;
  points[0].x() = none;
  EXPECT_EQ(fit_covariance(points, c.covariances, tip).reason, Reason::out_of_range);
  EXPECT_TRUE(fit_covariance(points, c.covariances, tip).value.isZero());
}

TEST(FitCovariance, RefusesALineAndUnequalSpans) {
  const std::vector<Vector3> line = {{0, 0, 1}, {0.1, 0, 1}, {0.2, 0, 1}};
  const std::vector<Matrix3> three(3, Matrix3::Identity());
  const std::vector<Matrix3> two(2, Matrix3::Identity());
  EXPECT_EQ(fit_covariance(line, three, Vector3::Zero()).reason, Reason::collinear);
  EXPECT_EQ(fit_covariance(line, two, Vector3::Zero()).reason, Reason::too_few_markers);
}

}  // namespace
}  // namespace glint

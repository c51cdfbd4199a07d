#include "kernels/pose/fit_covariance.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kernels/pose/rigid_fit.hpp"
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

// The six errors of one simulated fit: the tip's place and the rotation about the camera's axes.
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
    // 8,000 trials know a variance to 1.6 %, 1 sigma.
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
  EXPECT_NEAR(result.value(0, 0), sigma * sigma / 4, 1e-18);     // a mean of four
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

TEST(FitCovariance, RefusesALineAndUnequalSpans) {
  const std::vector<Vector3> line = {{0, 0, 1}, {0.1, 0, 1}, {0.2, 0, 1}};
  const std::vector<Matrix3> three(3, Matrix3::Identity());
  const std::vector<Matrix3> two(2, Matrix3::Identity());
  EXPECT_EQ(fit_covariance(line, three, Vector3::Zero()).reason, Reason::collinear);
  EXPECT_EQ(fit_covariance(line, two, Vector3::Zero()).reason, Reason::too_few_markers);
}

}  // namespace
}  // namespace glint

// The world error filters against a textbook Kalman filter with full matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/world_errors.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::world_errors_reference_test {
namespace {

using test::Random;

constexpr int k_states = 12 + k_shared_errors;
using State = Eigen::Matrix<double, k_states, 1>;
using Square = Eigen::Matrix<double, k_states, k_states>;
using Seen = Eigen::Matrix<double, 6, k_states>;
using Gain = Eigen::Matrix<double, k_states, 6>;

// Coefficient-wise: Eigen's blocked product takes a second to compile for each pair of sizes.
template <class A, class B>
Eigen::Matrix<double, A::RowsAtCompileTime, B::ColsAtCompileTime> product(const A& a, const B& b) {
  return a.lazyProduct(b);
}

// The state is (e, b, c, t): the headset's error, the body's pose, the shared errors, the time
// offset.
struct ReferenceFilter {
  State state = State::Zero();
  Square covariance = Square::Identity();
  Pose body;
  bool initialized = false;
  int refused = 0;
  double log_likelihood = 0;

  ReferenceFilter() { covariance.topLeftCorner<6, 6>().setZero(); }

  void update(const BodyMeasurement& sight, double factor) {
    Square walk = Square::Identity();
    walk.topLeftCorner<6, 6>() *= sight.walked.kept;
    state = product(walk, state);
    covariance = product(product(walk, covariance), walk.transpose());
    covariance.topLeftCorner<6, 6>() += factor * factor *
                                        (1 - sight.walked.kept * sight.walked.kept) *
                                        sight.walked.stationary_covariance;
    if (!initialized) body = sight.T_world_body;
    initialized = true;
    Seen h;
    h << Matrix6::Identity(), Matrix6::Identity(), sight.by_errors;
    const Gain ph = product(covariance, h.transpose());
    const Matrix6 s = product(h, ph) + sight.covariance;
    const Vector6 innovation = pose_difference(sight.T_world_body, body) - product(h, state);
    const Matrix6 inverse = inverse_of(s);
    const double chi_square = innovation.dot(product(inverse, innovation));
    log_likelihood -=
        0.5 * std::min(chi_square, 38.3) + 0.5 * symmetric_eigen(s).values.array().log().sum();
    if (chi_square > 38.3) {
      if (++refused == 9) reset();
      return;
    }
    refused = 0;
    const Gain gain = product(ph, inverse);
    state += product(gain, innovation);
    covariance = product(Square(Square::Identity() - product(gain, h)), covariance);
  }
  void reset() {
    for (int i = 6; i < 12; ++i) {
      covariance.row(i).setZero();
      covariance.col(i).setZero();
      covariance(i, i) = 1;
      state(i) = 0;
    }
    refused = 0;
    initialized = false;
  }
};

Matrix6 spread(double shift, double turn) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(shift * shift), Vector3::Constant(turn * turn);
  return covariance;
}

Pose moved(const Pose& pose, const Vector3& shift, const Vector3& turn) {
  return {(from_rotation_vector(turn) * pose.rotation).normalized(), pose.translation + shift};
}

void see(const BodyMeasurement& sight, WorldErrors& world,
         std::array<ReferenceFilter, k_head_noise_factors.size()>& plain) {
  ASSERT_TRUE(world.add(sight));
  for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i) {
    EXPECT_FALSE(world.idle());
    world.work();
    plain[i].update(sight, k_head_noise_factors[i]);
  }
  EXPECT_TRUE(world.idle());
}

void expect_same(const WorldErrors& world,
                 const std::array<ReferenceFilter, k_head_noise_factors.size()>& plain, int sight) {
  for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i) {
    const WorldErrorEstimate found = world.of_factor(i);
    EXPECT_LT((found.errors - plain[i].state.tail<k_shared_errors>()).norm(), 1e-7) << sight;
    EXPECT_LT((found.covariance -
               plain[i].covariance.bottomRightCorner<k_shared_errors, k_shared_errors>())
                  .norm(),
              1e-8)
        << sight;
    EXPECT_NEAR(found.log_likelihood, plain[i].log_likelihood, 1e-6) << sight;
  }
}

BodyMeasurement measurement_model(const Pose& body, Random& random, double off_m = 0) {
  BodyMeasurement sight;
  sight.walked = {random.within(0.5, 0.95), spread(0.003, 0.002)};
  sight.covariance = spread(0.0005, 0.003) + 1e-8 * test::random_covariance<6>(random, 1);
  for (int error = 0; error < k_shared_errors; ++error)
    sight.by_errors.col(error) << random.vector(0.004), random.vector(0.002);
  sight.T_world_body =
      moved(body, random.vector(0.003) + Vector3(off_m, 0, 0), random.vector(0.003));
  return sight;
}

// Measurements that pass the chi-square test, single ones that fail, and nine in a row after a
// jump.
TEST(WorldErrors, AreThoseOfTheTextbooksFilterSightBySight) {
  Random random(5);
  WorldErrors world;
  std::array<ReferenceFilter, k_head_noise_factors.size()> plain;
  Pose body{random.rotation(), Vector3(0.4, 0.1, -0.3)};
  expect_same(world, plain, -1);
  int refused = 0, forgotten = 0;
  for (int sight = 0; sight < 90; ++sight) {
    if (sight == 40) body.translation += Vector3(3, 0, 0);
    if (sight == 70) body.translation += Vector3(0, 0.06, 0);
    const bool wrong = sight % 12 == 7;
    const bool initialized = plain[4].initialized;
    see(measurement_model(body, random, wrong ? 2 : 0), world, plain);
    refused += plain[4].refused > 0 ? 1 : 0;
    forgotten += initialized && !plain[4].initialized ? 1 : 0;
    expect_same(world, plain, sight);
    EXPECT_EQ(world.measurement_count(), sight + 1);
    ASSERT_FALSE(HasFailure()) << sight;
  }
  EXPECT_GT(refused, 10);
  EXPECT_EQ(forgotten, 1);
}

// add() refuses a measurement while a factor still has to process the previous one.
TEST(WorldErrors, TakeASightOnlyWhereNoneWaits) {
  Random random(6);
  const Pose body{random.rotation(), Vector3(0.4, 0.1, -0.3)};
  WorldErrors world;
  EXPECT_TRUE(world.idle());
  world.work();
  EXPECT_EQ(world.measurement_count(), 0) << "nothing waits";
  EXPECT_EQ(world.of_factor(0).log_likelihood, 0);
  EXPECT_TRUE(world.add(measurement_model(body, random)));
  for (std::size_t done = 0; done < k_head_noise_factors.size(); ++done) {
    EXPECT_FALSE(world.idle());
    EXPECT_FALSE(world.add(measurement_model(body, random)));
    EXPECT_EQ(world.measurement_count(), 0);
    for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i)
      EXPECT_EQ(world.of_factor(i).log_likelihood != 0, i < done);
    world.work();
  }
  EXPECT_TRUE(world.idle());
  EXPECT_EQ(world.measurement_count(), 1);
  EXPECT_TRUE(world.add(measurement_model(body, random)));
}

// A measurement with an invalid covariance does not change the estimates.
TEST(WorldErrors, LeaveOutASightWithoutACovariance) {
  Random random(7);
  const Pose body{random.rotation(), Vector3(0.4, 0.1, -0.3)};
  WorldErrors world;
  std::array<ReferenceFilter, k_head_noise_factors.size()> plain;
  for (int sight = 0; sight < 5; ++sight) see(measurement_model(body, random), world, plain);
  const WorldErrorEstimate before = world.of_factor(2);
  BodyMeasurement none = measurement_model(body, random);
  none.covariance = -100 * Matrix6::Identity();
  none.walked = {1, Matrix6::Zero()};
  ASSERT_TRUE(world.add(none));
  for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i) world.work();
  EXPECT_EQ(world.of_factor(2).log_likelihood, before.log_likelihood);
  EXPECT_EQ(world.of_factor(2).errors, before.errors);
  EXPECT_EQ(world.measurement_count(), 6);
}

}  // namespace
}  // namespace glint::world_errors_reference_test

#include "kernels/motion/world_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/motion/motion_filter.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::world_errors_test {
namespace {

using test::Random;

constexpr double k_between_s = 0.2;
constexpr double k_kept = 0.9;
constexpr double k_drift_m = 0.002, k_drift_rad = 0.002, k_fit_m = 0.0004, k_fit_rad = 0.003;
using SystematicErrors = Eigen::Matrix<double, k_shared_errors, 1>;

Matrix6 spread(double shift, double turn) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(shift * shift), Vector3::Constant(turn * turn);
  return covariance;
}

Pose moved(const Pose& pose, const Vector6& by) {
  return {(from_rotation_vector(by.tail<3>()) * pose.rotation).normalized(),
          pose.translation + by.head<3>()};
}

// A static body; the headset's error is `drift` times the declared one.
class Body {
 public:
  Body(double drift, const SystematicErrors& errors, std::uint64_t seed)
      : drift_(drift), errors_(errors), random_(seed) {
    body_pose_ = {random_.rotation(), Vector3(0.4, 0.1, -0.3)};
    head_ = drift_ * walked(1);
  }
  BodyMeasurement measurement() {
    head_ = k_kept * head_ + drift_ * walked(std::sqrt(1 - k_kept * k_kept));
    BodyMeasurement measured;
    measured.walked = {first_ ? 0 : k_kept, spread(k_drift_m, k_drift_rad)};
    first_ = false;
    measured.covariance = spread(k_fit_m, k_fit_rad);
    // As for a body that moves across the image: one standard deviation moves it by some
    // millimetres.
    for (int error = 0; error < k_shared_errors; ++error)
      measured.by_errors.col(error) << 0.004 * random_.vector(1), 0.002 * random_.vector(1);
    Vector6 noise;
    noise << k_fit_m * random_.vector(1), k_fit_rad * random_.vector(1);
    measured.T_world_body = moved(body_pose_, head_ + noise + measured.by_errors * errors_);
    return measured;
  }
  void move(const Vector3& by) { body_pose_.translation += by; }

 private:
  Vector6 walked(double share) {
    Vector6 out;
    out << share * k_drift_m * random_.vector(1), share * k_drift_rad * random_.vector(1);
    return out;
  }
  double drift_;
  SystematicErrors errors_;
  Random random_;
  Pose body_pose_;
  Vector6 head_;
  bool first_ = true;
};

void see(const BodyMeasurement& measurement, WorldErrors& world) {
  ASSERT_TRUE(world.add(measurement));
  EXPECT_FALSE(world.add(measurement)) << "one waits";
  for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i) world.work();
  EXPECT_TRUE(world.idle());
}

WorldErrors filtered(Body& body, int count) {
  WorldErrors world;
  for (int i = 0; i < count; ++i) see(body.measurement(), world);
  return world;
}

std::size_t likeliest(const WorldErrors& world) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < k_head_noise_factors.size(); ++i)
    if (world.of_factor(i).log_likelihood > world.of_factor(best).log_likelihood) best = i;
  return best;
}

TEST(WorldErrors, LieWithinTheirCovariance) {
  double squares = 0;
  constexpr int k_runs = 60;
  for (int run = 0; run < k_runs; ++run) {
    Random random(static_cast<std::uint64_t>(run) + 1);
    SystematicErrors errors;
    for (int i = 0; i < k_shared_errors; ++i) errors(i) = random.normal();
    Body body(1, errors, static_cast<std::uint64_t>(run) + 100);
    const WorldErrorEstimate found = filtered(body, 40).of_factor(1);
    const SystematicErrors off = found.errors - errors;
    squares += off.dot(SystematicErrors(solve_symmetric(found.covariance, off))) / k_shared_errors;
    EXPECT_LT(found.covariance.diagonal().maxCoeff(), 0.1);
  }
  EXPECT_GT(squares / k_runs, 0.8);
  EXPECT_LT(squares / k_runs, 1.2);
}

TEST(WorldErrors, LikeliestFactorIsTheHeadsetsOwn) {
  for (std::size_t factor = 0; factor < k_head_noise_factors.size(); ++factor) {
    Body body(k_head_noise_factors[factor], SystematicErrors::Zero(), factor + 1);
    EXPECT_EQ(likeliest(filtered(body, 100)), factor);
  }
}

// A single outlier, for example of a wrong labeling, does not change the estimates.
TEST(WorldErrors, LeaveOutASightThatNothingExplains) {
  SystematicErrors errors = SystematicErrors::Zero();
  errors(4) = 2;
  Body body(1, errors, 3), same(1, errors, 3);
  WorldErrors world = filtered(body, 60), other = filtered(same, 60);
  BodyMeasurement wrong = body.measurement();
  wrong.T_world_body.translation += Vector3(0.1, 0, 0);
  wrong.walked = {1, Matrix6::Zero()};
  see(wrong, world);
  EXPECT_TRUE(world.of_factor(1).errors.isApprox(other.of_factor(1).errors));
  EXPECT_EQ(world.measurement_count(), 61);
}

// After a jump of the headset's world the body's pose is unknown again; the estimated errors stay.
TEST(WorldErrors, BeginAnewWhereTheWorldJumps) {
  SystematicErrors errors = SystematicErrors::Zero();
  errors(5) = 3;
  Body body(1, errors, 4);
  WorldErrors world = filtered(body, 60);
  body.move({0.2, 0, 0});
  for (int i = 0; i < 60; ++i) see(body.measurement(), world);
  EXPECT_NEAR(world.of_factor(1).errors(5), 3, 0.5);
  EXPECT_LT(world.of_factor(1).errors.head<5>().norm(), 0.7);
}

TEST(WorldErrors, GiveTheSameBitsEverywhere) {
  Body body(1, SystematicErrors::Ones(), 5);
  const WorldErrors world = filtered(body, 30);
  test::BitHash hash;
  for (std::size_t i = 0; i < k_head_noise_factors.size(); ++i) {
    const WorldErrorEstimate found = world.of_factor(i);
    for (int k = 0; k < k_shared_errors; ++k) hash.add(found.errors(k));
    hash.add(found.covariance(2, 4));
    hash.add(found.log_likelihood);
  }
  EXPECT_EQ(hash.value(), 11774398144347991861u);
}

}  // namespace
}  // namespace glint::world_errors_test

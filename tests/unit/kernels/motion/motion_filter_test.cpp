#include "kernels/motion/motion_filter.hpp"

#include <gtest/gtest.h>

#include <array>

#include "kernels/motion/singer.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint {
namespace {

using Vector18 = Eigen::Matrix<double, 18, 1>;
constexpr double k_difference = 1e-6;

// Coefficient-wise: Eigen's blocked product takes a second to compile for each pair of sizes.
template <class A, class B>
Eigen::Matrix<double, A::RowsAtCompileTime, B::ColsAtCompileTime> product(const A& a, const B& b) {
  return a.lazyProduct(b);
}

MotionCovariance transition_by_differences(const MotionState& state, Time time) {
  const auto at = [&](const Vector18& error) {
    MotionState later = test::moved(state, error);
    propagate(later, time, {}, {});
    return later;
  };
  MotionCovariance f;
  for (int i = 0; i < k_motion_size; ++i) {
    const Vector18 small = k_difference * Vector18::Unit(i);
    f.col(i) = test::error_between(at(small), at(-small)) / (2 * k_difference);
  }
  return f;
}

TEST(MotionFilter, CarriesItsCovarianceAsItsMeanCarriesErrors) {
  test::Random random(1);
  for (const int ms : {22, 50, 200}) {
    for (int trial = 0; trial < 20; ++trial) {
      const MotionState state = test::random_state(random);
      MotionState later = state;
      propagate(later, Time{ms * 1'000'000LL}, {}, {0, 0});
      const MotionCovariance f = transition_by_differences(state, later.time);
      const MotionCovariance expected = product(product(f, state.covariance), f.transpose());
      // propagate() takes the left Jacobian of half the rotation for that of the rotation.
      const double tolerance = ms < 100 ? 2e-3 : 3e-2;
      EXPECT_LT((later.covariance - expected).norm(), tolerance * expected.norm()) << ms;
      EXPECT_EQ(later.covariance, MotionCovariance(later.covariance.transpose()));
    }
  }
}

TEST(MotionFilter, AddsTheNoiseOfTheModelTimesItsScale) {
  MotionState state, noisy;
  propagate(state, Time{30'000'000}, {}, {0, 0});
  propagate(noisy, Time{30'000'000}, {}, {2, 3});
  const MotionCovariance added = noisy.covariance - state.covariance;
  const MotionSettings s;
  const Matrix3 linear = singer_step(s.linear_damping_1_s, 0.03).noise;
  const Matrix3 angular = singer_step(s.angular_damping_1_s, 0.03).noise;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      EXPECT_DOUBLE_EQ(added(3 * a + 1, 3 * b + 1), 2 * s.linear_noise_m2_s5 * linear(a, b));
      EXPECT_DOUBLE_EQ(added(9 + 3 * a, 9 + 3 * b), 3 * s.angular_noise_rad2_s5 * angular(a, b));
    }
  }
  EXPECT_EQ(added(0, 1), 0);
}

TEST(MotionFilter, CorrectsByAPoseAsTheTextbookDoes) {
  test::Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const MotionState before = test::random_state(random);
    UncertainPose measured;
    measured.pose = {from_rotation_vector(random.vector(0.02)) * before.pose.rotation,
                     before.pose.translation + random.vector(0.01)};
    measured.covariance = test::random_covariance<6>(random, 0.005);
    MotionState after = before;
    const Correction correction = correct_by_pose(after, measured);
    ASSERT_EQ(correction.reason, Reason::none);

    Eigen::Matrix<double, 6, 18> h = Eigen::Matrix<double, 6, 18>::Zero();
    h.block<3, 3>(0, k_position).setIdentity();
    h.block<3, 3>(3, k_rotation).setIdentity();
    const Eigen::Matrix<double, 18, 6> seen = product(before.covariance, h.transpose());
    const Matrix6 s = product(h, seen) + measured.covariance;
    const Matrix6 inverse = inverse_of(s);
    const Eigen::Matrix<double, 18, 6> gain = product(seen, inverse);
    const Vector6 innovation = pose_difference(measured.pose, before.pose);
    EXPECT_LT((test::error_between(after, before) - product(gain, innovation)).norm(), 1e-10);
    const MotionCovariance rest =
        product(MotionCovariance::Identity() - product(gain, h), before.covariance);
    EXPECT_LT((after.covariance - rest).norm(), 1e-10 * before.covariance.norm());
    EXPECT_NEAR(correction.nis, innovation.dot(product(inverse, innovation)), 1e-8);
    EXPECT_NEAR(correction.linear_whitened.squaredNorm(), correction.linear_nis, 1e-12);
    EXPECT_NEAR(
        correction.angular_nis,
        innovation.tail<3>().dot(s.bottomRightCorner<3, 3>().inverse() * innovation.tail<3>()),
        1e-8);
    EXPECT_NEAR(correction.linear_nis,
                innovation.head<3>().dot(s.topLeftCorner<3, 3>().inverse() * innovation.head<3>()),
                1e-8);
  }
}

// Second derivatives of a marker's position, one matrix an axis, by the errors of rotation.
std::array<Matrix3, 3> marker_hessians(const MotionState& state, const Vector3& model_m) {
  constexpr double k_step = 1e-3;
  const auto at = [&](const Vector3& turn) {
    Vector18 error = Vector18::Zero();
    error.segment<3>(k_rotation) = turn;
    return Vector3(test::moved(state, error).pose * model_m);
  };
  std::array<Matrix3, 3> hessians;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const Vector3 u = k_step * Vector3::Unit(a), v = k_step * Vector3::Unit(b);
      const Vector3 second =
          (at(u + v) - at(u - v) - at(v - u) + at(-u - v)) / (4 * k_step * k_step);
      for (std::size_t i = 0; i < 3; ++i) hessians[i](a, b) = second(static_cast<int>(i));
    }
  }
  return hessians;
}

TEST(MotionFilter, CorrectsByAPointAsItsFirstAndSecondDerivativesSay) {
  test::Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const MotionState before = test::random_state(random);
    MeasuredPoint measured;
    measured.model_m = random.vector(0.05);
    measured.measured_m = before.pose * measured.model_m + random.vector(0.002);
    measured.covariance_m2 = test::random_covariance<3>(random, 0.002);
    Eigen::Matrix<double, 3, 18> h;
    for (int i = 0; i < k_motion_size; ++i) {
      const Vector18 small = k_difference * Vector18::Unit(i);
      h.col(i) = (test::moved(before, small).pose * measured.model_m -
                  test::moved(before, -small).pose * measured.model_m) /
                 (2 * k_difference);
    }
    // Bar-Shalom, Li and Kirubarajan 2001, section 10.3.2.
    const Matrix3 turn = before.covariance.block<3, 3>(k_rotation, k_rotation);
    const std::array<Matrix3, 3> hessians = marker_hessians(before, measured.model_m);
    Vector3 mean;
    Matrix3 beyond;
    for (int i = 0; i < 3; ++i) {
      const Matrix3 by_turn = hessians[std::size_t(i)] * turn;
      mean(i) = 0.5 * by_turn.trace();
      for (int j = 0; j < 3; ++j)
        beyond(i, j) = 0.5 * (by_turn * hessians[std::size_t(j)] * turn).trace();
    }
    const Eigen::Matrix<double, 18, 3> seen = product(before.covariance, h.transpose());
    const Matrix3 s = product(h, seen) + measured.covariance_m2 + beyond;
    const Eigen::Matrix<double, 18, 3> gain = product(seen, s.inverse());
    MotionState after = before;
    const Correction correction = correct_by_point(after, measured);
    ASSERT_EQ(correction.reason, Reason::none);
    const Vector3 innovation = measured.measured_m - before.pose * measured.model_m - mean;
    EXPECT_NEAR(correction.nis, innovation.dot(s.inverse() * innovation), 1e-6);
    EXPECT_EQ(correction.linear_nis, correction.nis);
    EXPECT_EQ(correction.angular_nis, 0);
    EXPECT_EQ(correction.linear_whitened, Vector3(0, 0, 0));
    EXPECT_LT((test::error_between(after, before) - product(gain, innovation)).norm(), 1e-8);
    // The axes of the errors have rotated with the tool.
    const Matrix3 by = (after.pose.rotation * before.pose.rotation.conjugate()).toRotationMatrix();
    MotionCovariance axes = MotionCovariance::Zero();
    for (int i = 0; i < k_motion_size; i += 3) axes.block<3, 3>(i, i) = by;
    const MotionCovariance left =
        product(MotionCovariance::Identity() - product(gain, h), before.covariance);
    EXPECT_LT((after.covariance - product(product(axes, left), axes.transpose())).norm(),
              1e-7 * before.covariance.norm());
  }
}

// The first pose sets pose and covariance. Velocities and accelerations start with the declared
// standard deviations of a hand.
TEST(MotionFilter, StartsWithThePosesCovarianceAndWhatAHandMayDo) {
  test::Random random(6);
  UncertainPose first{
      Time{77}, {random.rotation(), random.vector(1)}, test::random_covariance<6>(random, 0.01)};
  const MotionSettings settings{3, 2, 500, 40, 0.7, 4};
  const MotionState state = initial_motion_state(first, settings);
  EXPECT_EQ(state.time, first.time);
  EXPECT_EQ(state.pose.translation, first.pose.translation);
  EXPECT_EQ(state.pose.rotation.coeffs(), first.pose.rotation.coeffs());
  for (const Vector3& still : {state.velocity_m_s, state.acceleration_m_s2,
                               state.angular_velocity_rad_s, state.angular_acceleration_rad_s2})
    EXPECT_EQ(still, Vector3(0, 0, 0));
  EXPECT_EQ(pose_of(state).covariance, first.covariance);
  EXPECT_EQ(pose_of(state).time, first.time);
  MotionCovariance rest = state.covariance;
  rest.block<3, 3>(k_position, k_position).setZero();
  rest.block<3, 3>(k_position, k_rotation).setZero();
  rest.block<3, 3>(k_rotation, k_position).setZero();
  rest.block<3, 3>(k_rotation, k_rotation).setZero();
  Vector18 diagonal = Vector18::Zero();
  diagonal.segment<3>(k_velocity).setConstant(0.7 * 0.7);
  diagonal.segment<3>(k_acceleration).setConstant(5.0 * 5);
  diagonal.segment<3>(k_angular_velocity).setConstant(4.0 * 4);
  diagonal.segment<3>(k_angular_acceleration).setConstant(500.0 / (2 * 40));
  EXPECT_LT((rest - MotionCovariance(diagonal.asDiagonal())).norm(), 1e-12);
}

// The angular acceleration's variance is stationary: damping removes as much as the process noise
// adds. The acceleration of a hand that comes into view decays to its stationary variance.
TEST(MotionFilter, KeepsTheVarianceOfTheAngularAccelerationsThatItStartsWith) {
  MotionState state = initial_motion_state({Time{}, {}, 1e-6 * Matrix6::Identity()}, {});
  const double linear = state.covariance(k_acceleration, k_acceleration);
  const double angular = state.covariance(k_angular_acceleration, k_angular_acceleration);
  propagate(state, Time{10'000'000}, {}, {});
  EXPECT_LT(state.covariance(k_acceleration, k_acceleration), linear);
  EXPECT_NEAR(state.covariance(k_angular_acceleration, k_angular_acceleration) / angular, 1, 1e-4);
}

// Vectors given in the frame rotate with it; the tool's own motion is unchanged.
TEST(MotionFilter, MovesAStateAsItsFrameMoves) {
  test::Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const MotionState state = test::random_state(random);
    const Pose by{random.rotation(), random.vector(1)};
    const MotionState there = transformed_state(state, by);
    EXPECT_EQ(there.time, state.time);
    EXPECT_LT(pose_difference(there.pose, by * state.pose).norm(), 1e-13);
    EXPECT_LT((there.velocity_m_s - by.rotation * state.velocity_m_s).norm(), 1e-14);
    EXPECT_LT((there.acceleration_m_s2 - by.rotation * state.acceleration_m_s2).norm(), 1e-13);
    EXPECT_LT((there.angular_velocity_rad_s - by.rotation * state.angular_velocity_rad_s).norm(),
              1e-13);
    EXPECT_LT((there.angular_acceleration_rad_s2 - by.rotation * state.angular_acceleration_rad_s2)
                  .norm(),
              1e-13);
    // The transformed error has the same variance.
    Vector18 error, moved;
    for (int i = 0; i < k_motion_size; i += 3) {
      error.segment<3>(i) = random.vector(1);
      moved.segment<3>(i) = by.rotation * error.segment<3>(i);
    }
    const double before = error.dot(product(state.covariance, error));
    EXPECT_NEAR(moved.dot(product(there.covariance, moved)) / before, 1, 1e-10);
    const MotionState back = transformed_state(there, by.inverse());
    EXPECT_LT((back.covariance - state.covariance).norm(), 1e-12 * state.covariance.norm());
  }
}

TEST(MotionFilter, HasThePosesShareOfItsCovariance) {
  test::Random random(8);
  MotionState state = test::random_state(random);
  state.time = Time{123};
  const UncertainPose pose = pose_of(state);
  EXPECT_EQ(pose.time, Time{123});
  EXPECT_EQ(pose.pose.translation, state.pose.translation);
  EXPECT_EQ(pose.pose.rotation.coeffs(), state.pose.rotation.coeffs());
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_EQ(pose.covariance(i, j), state.covariance(i < 3 ? i : 6 + i, j < 3 ? j : 6 + j));
}

TEST(MotionFilter, LeavesTheStateWhereAPointsCovarianceIsNone) {
  test::Random random(9);
  const MotionState before = test::random_state(random);
  MotionState state = before;
  const Correction correction =
      correct_by_point(state, {random.vector(0.05), random.vector(0.5), -10 * Matrix3::Identity()});
  EXPECT_EQ(correction.reason, Reason::degenerate);
  EXPECT_EQ(state.covariance, before.covariance);
  EXPECT_EQ(state.pose.rotation.coeffs(), before.pose.rotation.coeffs());
}

TEST(MotionFilter, FollowsConstantVelocityAndTurnWithoutLag) {
  const Vector3 velocity(0.5, -0.2, 0.1), turn(0.3, 1.2, -0.5);
  const auto truth = [&](int frame) {
    const double t = 22'222'222e-9 * frame;
    return Pose{from_rotation_vector(t * turn), t * velocity};
  };
  UncertainPose measured;
  measured.covariance = 1e-6 * Matrix6::Identity();
  MotionState state = initial_motion_state(measured, {});
  for (int frame = 1; frame < 60; ++frame) {
    measured.time = test::frame_time(frame);
    measured.pose = truth(frame);
    propagate(state, measured.time, {}, {});
    ASSERT_EQ(correct_by_pose(state, measured).reason, Reason::none);
  }
  EXPECT_LT(pose_difference(state.pose, truth(59)).norm(), 1e-6);
  EXPECT_LT((state.velocity_m_s - velocity).norm(), 1e-4);
  EXPECT_LT((state.angular_velocity_rad_s - turn).norm(), 1e-3);
}

TEST(MotionFilter, LeavesTheStateWhereACovarianceIsNone) {
  test::Random random(4);
  const MotionState before = test::random_state(random);
  UncertainPose measured;
  measured.covariance = -Matrix6::Identity();
  MotionState state = before;
  EXPECT_EQ(correct_by_pose(state, measured).reason, Reason::degenerate);
  EXPECT_EQ(state.covariance, before.covariance);
  EXPECT_EQ(state.pose.translation, before.pose.translation);
  propagate(state, Time{-5}, {}, {});
  EXPECT_EQ(state.covariance, before.covariance);
}

// Position known, one marker measured far away: the tool rotates towards it. Rotation about the
// line from the tool to the marker stays unobservable, also after the line has rotated.
TEST(MotionFilter, LearnsNothingOfTurnsAboutTheLineToItsOnlyMarker) {
  const double sigma = 0.3;
  MotionState state;
  state.covariance = 1e-10 * MotionCovariance::Identity();
  state.covariance.block<3, 3>(k_rotation, k_rotation) = sigma * sigma * Matrix3::Identity();
  MeasuredPoint point{Vector3(0.05, 0, 0), Vector3::Zero(), 1e-8 * Matrix3::Identity()};
  point.measured_m = from_rotation_vector(Vector3(0, 0.2, 0.4)) * point.model_m;
  for (int sight = 0; sight < 3; ++sight) {
    ASSERT_EQ(correct_by_point(state, point).reason, Reason::none);
    const Vector3 line = (state.pose.rotation * point.model_m).normalized();
    EXPECT_GT(line.y(), 0.3);
    const Matrix3 rotation_covariance = state.covariance.block<3, 3>(k_rotation, k_rotation);
    EXPECT_NEAR(line.dot(rotation_covariance * line), sigma * sigma, 0.01 * sigma * sigma) << sight;
  }
}

TEST(MotionFilter, GivesTheSameBitsEverywhere) {
  test::Random random(5);
  test::BitHash hash;
  MotionState state = test::random_state(random);
  for (int frame = 1; frame < 300; ++frame) {
    propagate(state, test::frame_time(frame), {}, {1.5, 0.7});
    if (frame % 3 == 0) {
      MeasuredPoint point{random.vector(0.05), Vector3::Zero(), 1e-6 * Matrix3::Identity()};
      point.measured_m = state.pose * point.model_m + random.vector(0.001);
      (void)correct_by_point(state, point);
    } else {
      (void)correct_by_pose(state,
                            test::measured_pose(state.pose, state.time, 0.001, 0.005, random));
    }
    test::add_bits(hash, state);
  }
  EXPECT_EQ(hash.value(), 11979747156868678879u);
}

// To first order a marker rotates about its centre along a straight line; the arc is of second
// order.
TEST(MotionFilter, ExpectsOneMarkerWhereALooselyHeldToolCanHaveTurnedIt) {
  test::Random random(11);
  constexpr double k_rotation_sigma_rad = 0.15, k_marker_sigma_m = 0.0002;
  const int n = 4000;
  double squares = 0;
  for (int i = 0; i < n; ++i) {
    MotionState state = initial_motion_state({Time{}, {}, 1e-8 * Matrix6::Identity()}, {});
    state.covariance.block<3, 3>(k_rotation, k_rotation) =
        k_rotation_sigma_rad * k_rotation_sigma_rad * Matrix3::Identity();
    MeasuredPoint point;
    point.model_m = Vector3(0, 0, 0.05);
    point.measured_m = from_rotation_vector(random.vector(k_rotation_sigma_rad)) * point.model_m +
                       random.vector(k_marker_sigma_m);
    point.covariance_m2 = k_marker_sigma_m * k_marker_sigma_m * Matrix3::Identity();
    squares += correct_by_point(state, point).nis / 3;
  }
  EXPECT_NEAR(squares / n, 1, 0.1);
}

}  // namespace
}  // namespace glint

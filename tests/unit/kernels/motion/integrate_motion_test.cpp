#include "kernels/motion/integrate_motion.hpp"

#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cmath>
#include <utility>

#include "kernels/motion/predict_motion.hpp"
#include "kernels/motion/state_vector.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint {
namespace {

// Independent implementation of the equations of motion in another form: accelerations are states,
// rotation is a quaternion product, damping is feedback.
int equations(double, N_Vector y, N_Vector out, void*) {
  const MotionSettings settings;
  const double* s = NV_DATA_S(y);
  double* d = NV_DATA_S(out);
  const Quaternion q(s[9], s[6], s[7], s[8]);
  const Quaternion rate = Quaternion(0, s[10], s[11], s[12]) * q;
  for (int i = 0; i < 3; ++i) {
    d[i] = s[3 + i];
    d[3 + i] = s[13 + i];
    d[10 + i] = s[16 + i];
    d[13 + i] = -settings.linear_damping_1_s * s[13 + i];
    d[16 + i] = -settings.angular_damping_1_s * s[16 + i];
  }
  for (int i = 0; i < 4; ++i) d[6 + i] = 0.5 * rate.coeffs()(i);
  return 0;
}

// CVODE's adaptive Adams method at 1e-12.
Pose by_cvode(const MotionState& state, double seconds) {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(19, context);
  Eigen::Map<Eigen::Matrix<double, 19, 1>> values(NV_DATA_S(y));
  values << state.pose.translation, state.velocity_m_s, state.pose.rotation.coeffs(),
      state.angular_velocity_rad_s, state.acceleration_m_s2, state.angular_acceleration_rad_s2;
  void* memory = CVodeCreate(CV_ADAMS, context);
  CVodeInit(memory, equations, 0, y);
  CVodeSStolerances(memory, 1e-12, 1e-12);
  CVodeSetMaxNumSteps(memory, 100000);
  SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(y, 0, context);
  CVodeSetNonlinearSolver(memory, solver);
  CVodeSetStopTime(memory, seconds);
  double reached = 0;
  EXPECT_GE(CVode(memory, seconds, y, &reached, CV_NORMAL), 0);
  const Pose pose{Quaternion(values(9), values(6), values(7), values(8)).normalized(),
                  values.head<3>()};
  CVodeFree(&memory);
  SUNNonlinSolFree(solver);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return pose;
}

TEST(IntegrateMotion, AgreesWithCvodesAdaptiveSteps) {
  test::Random random(1);
  MotionIntegrator integrator;
  ASSERT_EQ(integrator.prepare({}), Reason::none);
  struct Limit {
    int ms;
    double metres, radians;
  };
  for (const Limit& limit : {Limit{25, 1e-8, 1e-5}, {50, 1e-7, 3e-5}, {250, 1e-4, 2e-3}}) {
    for (int trial = 0; trial < 30; ++trial) {
      const MotionState state = test::random_state(random);
      const Result<MovingPose> later = integrator.after(state, milliseconds(limit.ms));
      ASSERT_TRUE(later);
      const Pose& pose = later.value.pose;
      const Pose truth = by_cvode(state, 1e-3 * limit.ms);
      EXPECT_LT((pose.translation - truth.translation).norm(), limit.metres) << limit.ms;
      EXPECT_LT(test::angle_between(pose.rotation, truth.rotation), limit.radians) << limit.ms;
    }
  }
}

TEST(IntegrateMotion, AgreesWithTheClosedFormAboutOneAxis) {
  MotionIntegrator integrator;
  ASSERT_EQ(integrator.prepare({}), Reason::none);
  MotionState state;
  state.velocity_m_s = {0.3, 0, 0};
  state.acceleration_m_s2 = {0, 4, 0};
  state.angular_velocity_rad_s = {0, 0, 2};
  state.angular_acceleration_rad_s2 = {0, 0, 8};
  const UncertainPose closed = predict_pose(state, Time{50'000'000}, {}, {});
  const Result<MovingPose> later = integrator.after(state, milliseconds(50));
  ASSERT_TRUE(later);
  EXPECT_LT(pose_difference(later.value.pose, closed.pose).norm(), 1e-5);
}

// Each operation against SUNDIALS' own serial vector with the same values.
TEST(StateVector, ComputesWhatSundialsOwnDoes) {
  constexpr int k_count = 4, k_vectors = 3;
  using Vector = StateVector<k_count>;
  const Vector::Values values[k_vectors] = {
      {0.5, -7.25, 3, 1.5}, {2, 0.125, -4, 8}, {-1, 6, 0.75, 0.0625}};
  SUNContext context = nullptr;
  ASSERT_EQ(SUNContext_Create(nullptr, &context), 0);
  N_Vector ours[k_vectors + 1], theirs[k_vectors + 1];  // and one for results
  for (std::size_t v = 0; v <= k_vectors; ++v) {
    ours[v] = Vector::make(context);
    theirs[v] = N_VNew_Serial(k_count, context);
    if (v == k_vectors) break;
    Vector::of(ours[v]) = values[v];
    std::copy(values[v].begin(), values[v].end(), NV_DATA_S(theirs[v]));
  }
  const auto same = [&](const char* name, auto operation) {
    operation(ours, ours[k_vectors]);
    operation(theirs, theirs[k_vectors]);
    for (std::size_t i = 0; i < k_count; ++i) {
      EXPECT_DOUBLE_EQ(Vector::of(ours[k_vectors])[i], NV_DATA_S(theirs[k_vectors])[i])
          << name << " " << i;
    }
  };
  double factors[k_vectors] = {2, -3, 0.5};
  same("sum", [](N_Vector* x, N_Vector z) { N_VLinearSum(2, x[0], -3, x[1], z); });
  same("constant", [](N_Vector*, N_Vector z) { N_VConst(1.25, z); });
  same("product", [](N_Vector* x, N_Vector z) { N_VProd(x[0], x[1], z); });
  same("quotient", [](N_Vector* x, N_Vector z) { N_VDiv(x[0], x[1], z); });
  same("scale", [](N_Vector* x, N_Vector z) { N_VScale(-2, x[0], z); });
  same("absolute", [](N_Vector* x, N_Vector z) { N_VAbs(x[0], z); });
  same("inverse", [](N_Vector* x, N_Vector z) { N_VInv(x[1], z); });
  same("added", [](N_Vector* x, N_Vector z) { N_VAddConst(x[0], 3, z); });
  same("combination", [&](N_Vector* x, N_Vector z) {
    EXPECT_EQ(N_VLinearCombination(k_vectors, factors, x, z), 0);
  });
  EXPECT_EQ(N_VMaxNorm(ours[0]), N_VMaxNorm(theirs[0]));
  EXPECT_EQ(N_VMin(ours[0]), N_VMin(theirs[0]));
  EXPECT_DOUBLE_EQ(N_VWrmsNorm(ours[0], ours[1]), N_VWrmsNorm(theirs[0], theirs[1]));
  EXPECT_EQ(N_VGetLength(ours[0]), k_count);
  EXPECT_EQ(N_VGetVectorID(ours[0]), SUNDIALS_NVEC_CUSTOM);
  sunindextype reals = 0, integers = 0;
  N_VSpace(ours[0], &reals, &integers);
  EXPECT_EQ(reals, k_count);
  EXPECT_EQ(integers, 1);
  N_Vector clone = N_VClone(ours[1]);
  EXPECT_EQ(N_VGetLength(clone), k_count);
  N_VConst(9, clone);
  EXPECT_EQ(Vector::of(ours[1]), values[1]) << "a place of its own";
  N_VDestroy(clone);
  // A linear combination of one vector alone, and one written into its own first input.
  same("one of a combination",
       [&](N_Vector* x, N_Vector z) { EXPECT_EQ(N_VLinearCombination(1, factors, x, z), 0); });
  EXPECT_EQ(N_VLinearCombination(k_vectors, factors, ours, ours[0]), 0);
  EXPECT_EQ(N_VLinearCombination(k_vectors, factors, theirs, theirs[0]), 0);
  for (std::size_t i = 0; i < k_count; ++i)
    EXPECT_DOUBLE_EQ(Vector::of(ours[0])[i], NV_DATA_S(theirs[0])[i]) << i;
  for (std::size_t v = 0; v <= k_vectors; ++v) {
    N_VDestroy(ours[v]);
    N_VDestroy(theirs[v]);
  }
  SUNContext_Free(&context);
}

TEST(IntegrateMotion, GivesTheSpeedsToo) {
  MotionIntegrator integrator;
  const MotionSettings settings;
  ASSERT_EQ(integrator.prepare(settings), Reason::none);
  test::Random random(6);
  for (int trial = 0; trial < 30; ++trial) {
    MotionState state = test::random_state(random), closed = state;
    propagate(closed, state.time + milliseconds(50), settings, {});
    const Result<MovingPose> later = integrator.after(state, milliseconds(50));
    ASSERT_TRUE(later);
    EXPECT_LT((later.value.velocity_m_s - closed.velocity_m_s).norm(), 1e-6);
    EXPECT_LT((later.value.angular_velocity_rad_s - closed.angular_velocity_rad_s).norm(), 1e-3);
  }
}

TEST(IntegrateMotion, KeepsToItsStateAtNoTimeAndBefore) {
  test::Random random(2);
  MotionIntegrator integrator;
  ASSERT_EQ(integrator.prepare({}), Reason::none);
  const MotionState state = test::random_state(random);
  for (const std::int64_t ns : {0LL, -1'000'000LL}) {
    const Result<MovingPose> same = integrator.after(state, Duration{ns});
    ASSERT_TRUE(same);
    EXPECT_EQ(same.value.pose.translation, state.pose.translation);
    EXPECT_EQ(same.value.velocity_m_s, state.velocity_m_s);
  }
}

TEST(IntegrateMotion, RefusesUnprepared) {
  MotionIntegrator integrator;
  EXPECT_EQ(integrator.after({}, milliseconds(10)).reason, Reason::not_prepared);
}

TEST(IntegrateMotion, AsksForNoMemoryOncePrepared) {
  test::Random random(3);
  MotionIntegrator integrator;
  ASSERT_EQ(integrator.prepare({}), Reason::none);
  const MotionState state = test::random_state(random);
  const HeapCount heap;
  for (int i = 1; i < 2000; ++i) (void)integrator.after(state, microseconds(100 * i));
  EXPECT_EQ(heap.count(), 0u);
}

// Heap bytes in use. With a sanitizer the count is zero, and the sanitizer detects leaks itself.
std::size_t bytes_in_use() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

TEST(IntegrateMotion, GivesBackAllItsMemory) {
  std::size_t before = 0;
  for (int round = 0; round < 10; ++round) {
    MotionIntegrator integrator;
    ASSERT_EQ(integrator.prepare({}), Reason::none);
    ASSERT_EQ(integrator.prepare({}), Reason::none) << "another one in its place";
    MotionIntegrator moved = std::move(integrator);
    EXPECT_TRUE(moved.after({}, milliseconds(10)));
    if (round == 1) before = bytes_in_use();
    if (round > 1) {
      EXPECT_EQ(bytes_in_use(), before) << round;
    }
  }
}

TEST(IntegrateMotion, DoesNotRememberWhatItDidBefore) {
  test::Random random(4);
  MotionIntegrator used, fresh;
  ASSERT_EQ(used.prepare({}), Reason::none);
  for (int i = 0; i < 100; ++i) (void)used.after(test::random_state(random), milliseconds(1 + i));
  ASSERT_EQ(fresh.prepare({}), Reason::none);
  const MotionState state = test::random_state(random);
  const Pose a = used.after(state, milliseconds(30)).value.pose;
  const Pose b = fresh.after(state, milliseconds(30)).value.pose;
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

TEST(IntegrateMotion, GivesTheSameBitsEverywhere) {
  test::Random random(5);
  test::BitHash hash;
  MotionIntegrator integrator;
  ASSERT_EQ(integrator.prepare({}), Reason::none);
  for (int trial = 0; trial < 500; ++trial) {
    const MotionState state = test::random_state(random);
    hash.add(integrator.after(state, Duration{1 + random.below(200'000'000)}).value.pose);
  }
  EXPECT_EQ(hash.value(), 15960565719376230231u);
}

}  // namespace
}  // namespace glint

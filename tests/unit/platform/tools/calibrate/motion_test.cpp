#include "platform/tools/calibrate/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "expect_message.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/singer.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/motion_fit.hpp"

namespace glint {
namespace {

// A hand simulated by exact steps of the motion model at 500 Hz, measured with noise.
struct SimulatedHand {
  MotionSettings motion{2.0, 3.0, 300, 12};
  MeasuredNoise noise{0.0005, 0.004};
  double seconds = 30;
  double rate_hz = 45;
  std::uint64_t seed = 1;
};

class SingerAxis {
 public:
  SingerAxis(double noise, double damping, const sim::RandomKey& key)
      : step_(singer_step(damping, 0.002)), key_(key) {
    const Matrix3 q = noise * step_.noise;
    root_ = q.llt().matrixL();
    state_ << 0, 0, std::sqrt(noise / (2 * damping)) * sim::gaussian(key_, next_++);
  }
  Vector3 step() {
    const double x = sim::gaussian(key_, next_), y = sim::gaussian(key_, next_ + 1),
                 z = sim::gaussian(key_, next_ + 2);
    next_ += 3;
    Vector3 next(state_[0] + step_.seconds * state_[1] + step_.position_by_acceleration * state_[2],
                 state_[1] + step_.velocity_by_acceleration * state_[2],
                 step_.acceleration_decay * state_[2]);
    next += root_ * Vector3(x, y, z);
    state_ = next;
    return state_;
  }

 private:
  SingerStep step_;
  sim::RandomKey key_;
  std::uint64_t next_ = 0;
  Matrix3 root_;
  Vector3 state_;
};

Trajectory moved_by(const SimulatedHand& hand) {
  std::vector<SingerAxis> shift, turn;
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    shift.emplace_back(hand.motion.linear_noise_m2_s5, hand.motion.linear_damping_1_s,
                       sim::RandomKey{hand.seed, sim::Stream::hand, axis});
    turn.emplace_back(hand.motion.angular_noise_rad2_s5, hand.motion.angular_damping_1_s,
                      sim::RandomKey{hand.seed, sim::Stream::hand, 10 + axis});
  }
  Trajectory trajectory;
  trajectory.name = "hand";
  const sim::RandomKey off{hand.seed, sim::Stream::reference, 0};
  const sim::RandomKey turned{hand.seed, sim::Stream::reference, 1};
  Pose pose;
  const int every = static_cast<int>(500 / hand.rate_hz);
  for (int i = 0; i < static_cast<int>(500 * hand.seconds); ++i) {
    Vector3 turn_speed;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      pose.translation[axis] = shift[a].step()[0];
      turn_speed[axis] = turn[a].step()[1];
    }
    pose.rotation = (from_rotation_vector(0.002 * turn_speed) * pose.rotation).normalized();
    if (i % every != 0) continue;
    const auto index = static_cast<std::uint64_t>(i);
    trajectory.samples.push_back(
        {Time{} + milliseconds(2 * i),
         {(from_rotation_vector(hand.noise.rotation_sigma_rad *
                                sim::gaussian_vector(turned, index)) *
           pose.rotation)
              .normalized(),
          pose.translation + hand.noise.position_sigma_m * sim::gaussian_vector(off, index)}});
  }
  return trajectory;
}

MotionUnknowns unknowns_of(const MotionSettings& motion, MotionPart part) {
  if (part == MotionPart::shift) return {motion.linear_noise_m2_s5, motion.linear_damping_1_s};
  return {motion.angular_noise_rad2_s5, motion.angular_damping_1_s};
}

constexpr MotionPart k_parts[] = {MotionPart::shift, MotionPart::rotation};

// Log likelihood from the innovations of the kernel's own filter.
double kernel_likelihood(std::span<const TimedPose> measured, MotionPart part,
                         const MotionSettings& motion, const MeasuredNoise& noise) {
  Matrix6 covariance = Matrix6::Zero();
  const double p = noise.position_sigma_m * noise.position_sigma_m;
  const double r = noise.rotation_sigma_rad * noise.rotation_sigma_rad;
  covariance.diagonal() << p, p, p, r, r, r;
  const int block = part == MotionPart::shift ? k_position : k_rotation;
  MotionState state =
      initial_motion_state({measured[0].time, measured[0].pose, covariance}, motion);
  double sum = 0;
  for (const TimedPose& sample : measured.subspan(1)) {
    propagate(state, sample.time, motion, {});
    const Matrix3 s = state.covariance.block<3, 3>(block, block) +
                      (part == MotionPart::shift ? p : r) * Matrix3::Identity();
    const Correction correction = correct_by_pose(state, {sample.time, sample.pose, covariance});
    sum -= 0.5 * ((part == MotionPart::shift ? correction.linear_nis : correction.angular_nis) +
                  std::log(s.determinant()) + 3 * std::log(2 * 3.14159265358979323846));
  }
  return sum;
}

TEST(MotionLikelihood, IsThatOfTheKernelsFilter) {
  const SimulatedHand hand{.seconds = 4};
  const std::vector<TimedPose> measured = moved_by(hand).samples;
  for (const MotionPart part : k_parts) {
    const Likelihood found =
        likelihood_of(measured, part, unknowns_of(hand.motion, part), {hand.noise, {}, 0.5});
    const double expected = kernel_likelihood(measured, part, hand.motion, hand.noise);
    EXPECT_EQ(found.innovations, static_cast<int>(measured.size()) - 1);
    EXPECT_NEAR(found.log_likelihood, expected, 2e-4 * std::abs(expected));
  }
}

TEST(MotionLikelihood, HasTheGradientThatDifferencesHave) {
  const SimulatedHand hand{.seconds = 3};
  const std::vector<TimedPose> measured = moved_by(hand).samples;
  const LikelihoodSettings settings{hand.noise, {}, 0.5};
  for (const MotionPart part : k_parts) {
    // Off the maximum of the likelihood, where the gradient vanishes.
    MotionUnknowns at = unknowns_of(hand.motion, part);
    at.noise *= 2;
    at.damping *= 0.6;
    const Likelihood found = likelihood_of(measured, part, at, settings);
    constexpr double k_step = 0.003;
    for (int i = 0; i < k_motion_unknowns; ++i) {
      const auto shifted = [&](double by) {
        MotionUnknowns other = at;
        (i == 0 ? other.noise : other.damping) *= std::exp(by);
        return likelihood_of(measured, part, other, settings).log_likelihood;
      };
      const double difference = (shifted(k_step) - shifted(-k_step)) / (2 * k_step);
      EXPECT_GT(std::abs(difference), 1);
      EXPECT_NEAR(found.gradient[i], difference, 2e-4 * std::abs(difference)) << "unknown " << i;
    }
    Vector2 sum = Vector2::Zero();
    for (const Vector2& score : found.scores) sum += score;
    EXPECT_LT((sum - found.gradient).norm(), 1e-9 * found.gradient.norm() + 1e-9);
  }
}

TEST(MotionLikelihood, StartsAnewAfterAGap) {
  const SimulatedHand hand{.seconds = 2};
  std::vector<TimedPose> measured = moved_by(hand).samples;
  const int before = static_cast<int>(measured.size());
  measured.erase(measured.begin() + 30, measured.begin() + 60);
  const Likelihood found =
      likelihood_of(measured, MotionPart::shift, {2, 3}, {hand.noise, {}, 0.5});
  EXPECT_EQ(found.innovations, before - 30 - 2);
}

// Mean NEES of the two unknowns over `runs` runs.
double mean_nees(MotionPart part, int runs, double seconds) {
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    const SimulatedHand hand{.seconds = seconds, .seed = static_cast<std::uint64_t>(run + 1)};
    const MotionUnknowns truth = unknowns_of(hand.motion, part);
    const MotionFit fit = maximise_likelihood({moved_by(hand).samples}, part, unknowns_of({}, part),
                                              {hand.noise, {}, 0.5}, {});
    EXPECT_TRUE(fit.determined);
    const Vector2 off(std::log(fit.unknowns.noise / truth.noise),
                      std::log(fit.unknowns.damping / truth.damping));
    EXPECT_LT(off.norm(), 1.2);
    sum += off.dot(fit.covariance.inverse() * off) / (2 * runs);
  }
  std::printf("motion, %s: NEES/2 %.2f\n", part == MotionPart::shift ? "shift" : "rotation", sum);
  return sum;
}

// Tolerances are 2.5 standard deviations of the mean NEES.
TEST(MotionFit, FindsAShiftsNoiseAndDampingAndKnowsHowSureItIs) {
  EXPECT_NEAR(mean_nees(MotionPart::shift, 8, 8), 1, 0.9);
}

TEST(MotionFit, FindsARotationsNoiseAndDampingAndKnowsHowSureItIs) {
  EXPECT_NEAR(mean_nees(MotionPart::rotation, 3, 6), 1, 1.4);
}

TEST(Motion, IsMoreLikelyThanTheBuiltInOneOnWhatWasHeldOut) {
  const SimulatedHand hand{.motion = {0.3, 1.5, 60, 10}, .seconds = 18};
  const Trajectory recording = moved_by(hand);
  MotionCalibrationSettings settings;
  settings.noise = hand.noise;
  const MotionCalibration found = calibrate_motion(std::span(&recording, 1), settings, "hand.tum");
  EXPECT_NEAR(found.held_out, found.samples / 2, 2);
  EXPECT_GT(found.found.log_likelihood, found.built_in.log_likelihood + 0.05);
  EXPECT_LT(found.found.at_25_ms.position_rms_m, 1.02 * found.built_in.at_25_ms.position_rms_m);
  EXPECT_GT(found.found.at_25_ms.n, 150);
  EXPECT_EQ(static_cast<int>(found.errors_m.size()), found.found.at_25_ms.n);
  EXPECT_EQ(found.motion.start_speed_m_s, MotionSettings{}.start_speed_m_s);
}

TEST(Motion, SaysWhatARecordingLeavesOpen) {
  MotionCalibrationSettings settings;
  const Trajectory few = moved_by({.seconds = 5});
  test::expect_input_error([&] { (void)calibrate_motion(std::span(&few, 1), settings, "few.tum"); },
                           {"few.tum", "expected at least 450", "record for longer"});
  const SimulatedHand still{.motion = {1e-12, 3, 1e-9, 12}, .seconds = 12};
  Trajectory rest = moved_by(still);
  settings.noise = still.noise;
  test::expect_input_error(
      [&] { (void)calibrate_motion(std::span(&rest, 1), settings, "rest.tum"); },
      {"rest.tum", "does not determine the shift's noise", "above the declared noise",
       "starts, stops and turns"});
  // Translation only: the rotation is unobservable.
  const SimulatedHand hand{.seconds = 12};
  Trajectory slid = moved_by(hand);
  for (std::size_t i = 0; i < slid.samples.size(); ++i)
    slid.samples[i].pose.rotation = from_rotation_vector(
        hand.noise.rotation_sigma_rad *
        sim::gaussian_vector({7, sim::Stream::reference, 3}, static_cast<std::uint64_t>(i)));
  test::expect_input_error(
      [&] { (void)calibrate_motion(std::span(&slid, 1), settings, "slid.tum"); },
      {"slid.tum", "does not determine the rotation's noise"});
}

}  // namespace
}  // namespace glint

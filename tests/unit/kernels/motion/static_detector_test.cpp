#include "kernels/motion/static_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::static_detector_test {
namespace {

constexpr double k_shift_sigma = 0.0005, k_turn_sigma = 0.005;

// A static window with its own sums.
struct Window {
  StaticDetector at;
  StaticWindowSums sums;
  void add(const UncertainPose& measured) { at.add(measured, {}, StaticDetectorSettings{}, sums); }
  void clear() { at.clear(); }
  [[nodiscard]] bool is_static() const { return at.is_static(); }
  [[nodiscard]] int frames() const { return at.frames(); }
  [[nodiscard]] StaticEstimate rest() const { return at.rest(sums); }
};

UncertainPose seen(const Pose& truth, int frame, test::Random& random) {
  return test::measured_pose(truth, test::frame_time(frame), k_shift_sigma, k_turn_sigma, random);
}

Pose drifted(const Pose& start, const Vector3& by) {
  return {start.rotation, start.translation + by};
}

TEST(RestWindow, GrowsToItsMaximumAtRestAndAverages) {
  test::Random random(1);
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  Vector3 sum = Vector3::Zero();
  for (int frame = 0; frame < 60; ++frame) {
    const UncertainPose measured = seen(truth, frame, random);
    window->add(measured);
    sum += measured.pose.translation;
  }
  ASSERT_EQ(window->frames(), 60);
  const StaticEstimate rest = window->rest();
  EXPECT_LT((rest.pose.pose.translation - sum / 60).norm(), 1e-12);
  EXPECT_EQ(rest.drift_per_s, Vector6(Vector6::Zero()));
  EXPECT_LT(test::angle_between(rest.pose.pose.rotation, truth.rotation), 4 * k_turn_sigma / 7);
  for (int frame = 60; frame < 400; ++frame) window->add(seen(truth, frame, random));
  EXPECT_EQ(window->frames(), k_static_frames_max);
}

TEST(RestWindow, KnowsItsMeansErrorOverManyRests) {
  test::Random random(2);
  const auto window = std::make_unique<Window>();
  double squares = 0;
  const int rests = 300;
  for (int trial = 0; trial < rests; ++trial) {
    window->clear();
    const Pose truth{random.rotation(), random.vector(0.3)};
    for (int frame = 0; frame < 45; ++frame) window->add(seen(truth, frame, random));
    squares += (window->rest().pose.pose.translation - truth.translation).squaredNorm();
  }
  const double best = k_shift_sigma * std::sqrt(3.0 / 45);
  EXPECT_LT(std::sqrt(squares / rests), 1.2 * best);
}

TEST(RestWindow, IsAsSureOfAHandThatTremblesAsItIsRight) {
  test::Random random(4);
  const auto window = std::make_unique<Window>();
  constexpr double k_tremor_hz = 8.3, k_rms_m = 0.00005;
  double squares = 0;
  int n = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    const double phase = 2 * 3.14159265358979323846 * k_tremor_hz * frame / 45.0;
    const Vector3 off = k_rms_m * std::sqrt(2.0) *
                        Vector3(std::sin(phase), std::sin(1.1 * phase), std::sin(0.9 * phase));
    window->add(test::measured_pose({Quaternion::Identity(), off}, test::frame_time(frame), 0.0001,
                                    0.001, random));
    if (window->frames() < 60) continue;
    const StaticEstimate rest = window->rest();
    const Vector3 error = rest.pose.pose.translation - off;
    squares += error.dot(rest.pose.covariance.topLeftCorner<3, 3>().inverse() * error) / 3;
    ++n;
  }
  ASSERT_GT(n, 1000);
  EXPECT_NEAR(squares / n, 1.0, 0.3);
}

TEST(RestWindow, EndsWithTheFirstFrameOfAMove) {
  test::Random random(3);
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  for (int frame = 0; frame < 100; ++frame) window->add(seen(truth, frame, random));
  ASSERT_TRUE(window->is_static());
  window->add(seen(drifted(truth, {0.006, 0, 0}), 100, random));
  EXPECT_FALSE(window->is_static());
  EXPECT_EQ(window->frames(), 1);
}

TEST(RestWindow, NeverHoldsAHandInMotion) {
  test::Random random(4);
  const Pose start{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  for (int frame = 0; frame < 500; ++frame) {
    window->add(seen(drifted(start, {0.1 * frame / 45.0, 0, 0}), frame, random));
    EXPECT_FALSE(window->is_static()) << frame;
  }
}

TEST(RestWindow, FindsARestAgainAfterAStroke) {
  test::Random random(5);
  const Pose start{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  for (int frame = 0; frame < 150; ++frame) {
    const double moved = 0.2 * std::min(frame, 50) / 45.0;
    window->add(seen(drifted(start, {0, moved, 0}), frame, random));
  }
  EXPECT_GE(window->frames(), 90);
  EXPECT_LE(window->frames(), 101);
}

TEST(RestWindow, TellsASlowDriftByItsHalves) {
  test::Random random(6);
  const Vector3 per_s(0.002, 0, 0);
  double drift = 0, still = 0;
  const auto window = std::make_unique<Window>();
  for (int trial = 0; trial < 100; ++trial) {
    const Pose start{random.rotation(), random.vector(0.3)};
    window->clear();
    for (int frame = 0; frame < 30; ++frame)
      window->add(seen(drifted(start, frame / 45.0 * per_s), frame, random));
    drift += window->frames() > 1 ? window->rest().drift_per_s.x() / 100 : 0;
    window->clear();
    for (int frame = 0; frame < 30; ++frame) window->add(seen(start, frame, random));
    still += window->frames() > 1 ? window->rest().drift_per_s.x() / 100 : 0;
  }
  EXPECT_GT(drift, 0.0003);
  EXPECT_LT(std::abs(still), 0.0001);
}

TEST(RestWindow, EndsInALongSilence) {
  test::Random random(7);
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  for (int frame = 0; frame < 20; ++frame) window->add(seen(truth, frame, random));
  UncertainPose late = seen(truth, 20, random);
  late.time = late.time + milliseconds(300);
  window->add(late);
  EXPECT_EQ(window->frames(), 1);
}

TEST(RestWindow, StaysFiniteForDegenerateCovariances) {
  const auto window = std::make_unique<Window>();
  UncertainPose measured;
  for (int frame = 0; frame < 300; ++frame) {
    measured.time = test::frame_time(frame);
    window->add(measured);  // zero covariance
    EXPECT_LE(window->frames(), 1);
  }
}

// State written by an undone frame has no effect on the next: each frame is preceded by another one
// that is undone.
TEST(RestWindow, HoldsAfterAFrameThatIsUndone) {
  test::Random random(9), other(10);
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto plain = std::make_unique<Window>(), undone = std::make_unique<Window>();
  for (int frame = 0; frame < 600; ++frame) {
    const double moved = frame % 200 < 180 ? 0 : 0.002 * (frame % 200 - 180);
    const UncertainPose measured = seen(drifted(truth, {moved, 0, 0}), frame, random);
    plain->add(measured);
    const StaticDetector before = undone->at;
    const Vector3 aside(frame % 2 == 0 ? 0.5 : 0.003, 0, 0);  // starts or ends a window
    undone->add(seen(drifted(truth, aside), frame, other));
    undone->at = before;
    undone->add(measured);
    ASSERT_EQ(undone->frames(), plain->frames()) << frame;
    if (plain->frames() < 2) continue;
    ASSERT_EQ(undone->rest().pose.pose.translation, plain->rest().pose.pose.translation) << frame;
    ASSERT_EQ(undone->rest().pose.covariance, plain->rest().pose.covariance) << frame;
  }
}

TEST(RestWindow, TestsItsHalvesAtMostOnceALevel) {
  test::Random random(11);
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  int most = 0;
  for (int frame = 0; frame < 200; ++frame)
    most = std::max(most, window->at.add(seen(truth, frame, random), {}, StaticDetectorSettings{},
                                         window->sums));
  EXPECT_EQ(most, k_static_window_levels);
}

TEST(RestWindow, GivesTheSameBitsEverywhere) {
  test::Random random(8);
  test::BitHash hash;
  const Pose truth{random.rotation(), random.vector(0.3)};
  const auto window = std::make_unique<Window>();
  for (int frame = 0; frame < 400; ++frame) {
    const double moved = frame % 100 < 80 ? 0 : 0.002 * (frame % 100 - 80);
    window->add(seen(drifted(truth, {moved, 0, 0}), frame, random));
    hash.add(window->frames());
    if (window->frames() < 2) continue;
    const StaticEstimate rest = window->rest();
    hash.add(rest.pose.pose);
    for (int i = 0; i < 6; ++i) hash.add(rest.drift_per_s(i));
    for (int i = 0; i < 6; ++i) hash.add(rest.pose.covariance(i, 5 - i));
  }
  EXPECT_EQ(hash.value(), 11347793838259545098u);
}

}  // namespace
}  // namespace glint::static_detector_test

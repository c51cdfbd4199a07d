// Static detector against a reference that stores all poses, frame by frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/static_detector.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::static_detector_plain_test {
namespace {

using test::Random;

// All frames of the possible static window, oldest first; rules as in static_detector.hpp.
class ReferenceWindow {
 public:
  int add(const UncertainPose& measured, const CorrelatedErrors& correlated,
          const StaticDetectorSettings& settings) {
    settings_ = settings;
    correlated_ = correlated;
    const Vector6 off =
        kept_.empty() ? Vector6(Vector6::Zero()) : pose_difference(measured.pose, anchor_);
    const bool near = off.head<3>().norm() <= 0.2 && off.tail<3>().norm() <= 0.35;
    frames_ = 1;
    if (kept_.empty() || !near || measured.time - kept_.back().time > settings.gap_max) {
      kept_ = {measured};
      anchor_ = measured.pose;
      return 0;
    }
    kept_.push_back(measured);
    if (kept_.size() > k_static_frames_max) kept_.erase(kept_.begin());
    const int n = static_cast<int>(kept_.size());
    // Windows of the newest n, 3/4 n, 1/2 n, 3/8 n .. frames, the shortest first.
    std::vector<int> lengths;
    for (int level = 0; level < k_static_window_levels; ++level) {
      const int power = 1 << level / 2;
      lengths.push_back(level % 2 == 0 ? n / power : 3 * n / (4 * power));
    }
    int tests = 0;
    for (auto frames = lengths.rbegin(); frames != lengths.rend(); ++frames) {
      if (*frames < 2) continue;
      ++tests;
      const bool is_short = *frames <= settings.frames_min;
      const double limit = is_short ? settings.short_chi_square_max : settings.long_chi_square_max;
      if (!(halves(*frames).chi_square <= limit)) {
        const int left = is_short ? frames_ : n - n / 8;
        kept_.erase(kept_.begin(), kept_.end() - left);
        break;
      }
      frames_ = *frames;
    }
    if (kept_.size() == 1) anchor_ = measured.pose;
    return tests;
  }
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] double seconds(int frames) const {
    return (kept_.back().time - kept_[kept_.size() - static_cast<std::size_t>(frames)].time)
        .seconds();
  }
  struct Halves {
    Vector6 difference;
    double chi_square;
  };
  [[nodiscard]] Halves halves(int frames) const {
    const int newer = frames / 2, older = frames - newer;
    const Vector6 apart = mean(newer, 0) - mean(older, newer);
    const Matrix6 covariance =
        mean_covariance(newer, 0) + mean_covariance(older, newer) +
        halves_covariance(correlated_, settings_.correlation, seconds(frames));
    return {apart, apart.dot(Matrix6(inverse_of(covariance)) * apart)};
  }
  [[nodiscard]] StaticEstimate rest() const {
    const Halves cut = halves(frames_);
    const double drift = cut.chi_square > settings_.drift_chi_square
                             ? 1 - settings_.drift_chi_square / cut.chi_square
                             : 0;
    const double unseen = cut.chi_square > 6 ? 1 - 6 / cut.chi_square : 0;
    const Vector6 place = mean(frames_, 0) + drift * cut.difference;
    StaticEstimate rest;
    rest.pose.time = kept_.back().time;
    rest.pose.pose = {from_rotation_vector(place.tail<3>()) * anchor_.rotation,
                      anchor_.translation + place.head<3>()};
    const Matrix6 covariance = mean_covariance(frames_, 0);
    rest.pose.covariance = (1 + 4 * drift * drift) * covariance + (1 - drift) * (1 - drift) *
                                                                      unseen * cut.difference *
                                                                      cut.difference.transpose();
    for (int i = 0; i < 6; ++i) rest.pose.covariance(i, i) += std::pow(i < 3 ? 5e-5 : 5e-4, 2);
    const double per_s = 2 / seconds(frames_);
    rest.drift_per_s = drift * per_s * cut.difference;
    rest.drift_covariance = 4 * per_s * per_s * covariance;
    return rest;
  }
  [[nodiscard]] Matrix6 correlated() const {
    return covariance_of_mean(correlated_, settings_.correlation,
                              frames_ >= settings_.frames_min ? seconds(frames_) : 0);
  }

 private:
  // Mean over `frames` frames, the newest of which is `behind` frames before the last.
  [[nodiscard]] Vector6 mean(int frames, int behind) const {
    Vector6 sum = Vector6::Zero();
    for (int i = 0; i < frames; ++i)
      sum += pose_difference(kept_[kept_.size() - 1 - std::size_t(i + behind)].pose, anchor_);
    return sum / frames;
  }
  [[nodiscard]] Matrix6 mean_covariance(int frames, int behind) const {
    Matrix6 sum = Matrix6::Zero();
    for (int i = 0; i < frames; ++i)
      sum += kept_[kept_.size() - 1 - std::size_t(i + behind)].covariance;
    return sum / (frames * frames);
  }
  std::vector<UncertainPose> kept_;
  Pose anchor_;
  int frames_ = 0;
  StaticDetectorSettings settings_;
  CorrelatedErrors correlated_;
};

// Static phases of all lengths, drifts, movements, gaps and jumps, with varying settings and
// errors.
TEST(RestWindow, IsThatOfThePlainVersionFrameByFrame) {
  Random random(31);
  int resting = 0, drifting = 0, full = 0;
  for (int run = 0; run < 12; ++run) {
    auto window = std::make_unique<StaticDetector>();
    auto sums = std::make_unique<StaticWindowSums>();
    ReferenceWindow plain;
    StaticDetectorSettings settings;
    settings.frames_min = run % 3 == 0 ? 5 : 8;
    settings.drift_chi_square = run % 2 == 0 ? 12.6 : 4;
    settings.correlation = {0.3, 5};
    CorrelatedErrors correlated;
    if (run % 4 == 3) {
      correlated.fast = test::random_covariance<6>(random, 0.0002);
      correlated.slow = test::random_covariance<6>(random, 0.0002);
    }
    Pose truth{random.rotation(), random.vector(0.3)};
    Vector3 drift = Vector3::Zero();
    Time time;
    for (int frame = 0; frame < 420; ++frame) {
      time = time + milliseconds(22 + frame % 3);
      if (frame % 150 == 149) time = time + milliseconds(run % 2 == 0 ? 227 : 400);
      if (frame % 60 == 0) drift = run % 2 == 0 ? Vector3(0, 0, 0) : random.vector(0.00004);
      truth.translation += drift;
      if (frame == 200) truth.translation += random.vector(0.002);
      if (frame == 360) truth.translation += Vector3(0.5, 0, 0);
      UncertainPose measured = test::measured_pose(truth, time, 0.0005, 0.005, random);
      measured.covariance += test::random_covariance<6>(random, 0.0001);
      const int tests = window->add(measured, correlated, settings, *sums);
      ASSERT_EQ(tests, plain.add(measured, correlated, settings)) << run << " " << frame;
      ASSERT_EQ(window->frames(), plain.frames()) << run << " " << frame;
      EXPECT_EQ(window->is_static(), plain.frames() >= settings.frames_min);
      EXPECT_LT((window->correlated(*sums) - plain.correlated()).norm(), 1e-12);
      if (plain.frames() < 2) continue;
      const StaticEstimate found = window->rest(*sums), expected = plain.rest();
      EXPECT_EQ(found.pose.time, time);
      EXPECT_LT(pose_difference(found.pose.pose, expected.pose.pose).norm(), 1e-9);
      EXPECT_LT((found.pose.covariance - expected.pose.covariance).norm(),
                1e-7 * expected.pose.covariance.norm());
      EXPECT_LT((found.drift_per_s - expected.drift_per_s).norm(),
                1e-6 * (1e-3 + expected.drift_per_s.norm()));
      EXPECT_LT((found.drift_covariance - expected.drift_covariance).norm(),
                1e-7 * expected.drift_covariance.norm());
      resting += window->is_static() ? 1 : 0;
      drifting += expected.drift_per_s.isZero() ? 0 : 1;
      full += plain.frames() == k_static_frames_max ? 1 : 0;
      ASSERT_FALSE(HasFailure()) << run << " " << frame;
    }
  }
  EXPECT_GT(resting, 1000);
  EXPECT_GT(drifting, 100);
  EXPECT_GT(full, 50);
}

UncertainPose pose_at(const Vector3& place, const Vector3& turn, Time time) {
  UncertainPose pose{time, {from_rotation_vector(turn), place}, Matrix6::Zero()};
  pose.covariance.diagonal().setConstant(1);  // large enough that no halves differ
  return pose;
}

// A frame at the limit continues the static window; just beyond it starts a new one.
TEST(RestWindow, EndsBeyondEachLimitAlone) {
  const Time second = Time{} + StaticDetectorSettings{}.gap_max;
  const auto frames_after = [](const UncertainPose& next) {
    StaticDetector window;
    auto sums = std::make_unique<StaticWindowSums>();
    window.add(pose_at({0, 0, 0}, {0, 0, 0}, Time{}), {}, {}, *sums);
    window.add(next, {}, {}, *sums);
    return window.frames();
  };
  EXPECT_EQ(frames_after(pose_at({0, 0, 0}, {0, 0, 0}, second)), 2);
  EXPECT_EQ(frames_after(pose_at({0, 0, 0}, {0, 0, 0}, second + Duration{1})), 1);
  EXPECT_EQ(frames_after(pose_at({k_window_translation_max_m, 0, 0}, {0, 0, 0}, second)), 2);
  EXPECT_EQ(frames_after(pose_at({0, -1.0001 * k_window_translation_max_m, 0}, {0, 0, 0}, second)),
            1);
  EXPECT_EQ(frames_after(pose_at({0, 0, 0}, {0, 0, 0.9999 * k_window_rotation_max_rad}, second)),
            2);
  EXPECT_EQ(frames_after(pose_at({0, 0, 0}, {0, 1.0001 * k_window_rotation_max_rad, 0}, second)),
            1);
}

// After move() the window equals one whose poses were all measured in the moved frame.
TEST(RestWindow, MovesAlongWithItsFrame) {
  Random random(32);
  const Pose truth{random.rotation(), random.vector(0.1)};
  const Pose by{from_rotation_vector({0.002, -0.001, 0.003}), {0.03, -0.02, 0.01}};
  auto moved = std::make_unique<StaticDetector>(), there = std::make_unique<StaticDetector>();
  auto moved_sums = std::make_unique<StaticWindowSums>(),
       there_sums = std::make_unique<StaticWindowSums>();
  for (int frame = 0; frame < 40; ++frame) {
    UncertainPose pose = test::measured_pose(truth, test::frame_time(frame), 1e-5, 1e-5, random);
    if (frame == 30) moved->move(by);
    UncertainPose beyond = pose;
    beyond.pose = by * pose.pose;
    moved->add(frame < 30 ? pose : beyond, {}, {}, *moved_sums);
    there->add(beyond, {}, {}, *there_sums);
  }
  ASSERT_EQ(moved->frames(), 40);
  ASSERT_EQ(there->frames(), 40);
  const Pose a = moved->rest(*moved_sums).pose.pose, b = there->rest(*there_sums).pose.pose;
  EXPECT_LT((a.translation - b.translation).norm(), 1e-6);
  EXPECT_LT(test::angle_between(a.rotation, b.rotation), 1e-6);
}

}  // namespace
}  // namespace glint::static_detector_plain_test

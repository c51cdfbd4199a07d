#include "kernels/path/smooth_stroke.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

constexpr double k_frame_sigma_m = 0.0007, k_frame_sigma_rad = 0.006;

struct Smoothed {
  std::vector<StrokeFrame> frames;
  std::vector<SmoothedFrame> memory;
  StrokeSmoother smoother;
  Reason reason = Reason::none;

  explicit Smoothed(std::vector<StrokeFrame> given)
      : frames(std::move(given)), memory(frames.size()) {
    reason = smoother.smooth(frames, {}, memory);
  }
  [[nodiscard]] Result<MotionState> at(Time time) const { return smoother.at(time, frames); }
};

StrokeFrame frame_at(double seconds, const Vector3& place, const Quaternion& rotation) {
  StrokeFrame frame;
  frame.measured.time = Time{std::llround(1e9 * seconds)};
  frame.measured.pose = {rotation, place};
  for (int i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? k_frame_sigma_m : k_frame_sigma_rad;
    frame.measured.covariance(i, i) = sigma * sigma;
  }
  return frame;
}

// A curved stroke that turns about all axes, with noise, at irregular times around 45 Hz and 5 Hz.
std::vector<StrokeFrame> noisy_stroke(int count, std::uint64_t seed, double period_s = 0.022) {
  test::Random random(seed);
  std::vector<StrokeFrame> frames;
  double t = 3;
  for (int i = 0; i < count; ++i) {
    t += period_s * (1 + 0.2 * std::sin(1.7 * i));
    const Vector3 place(0.08 * std::sin(2 * t), 0.06 * std::cos(3 * t), 0.1 * t);
    const Vector3 turn(0.3 * std::sin(t), 0.4 * std::cos(2 * t), 0.2);
    const Quaternion rotation =
        from_rotation_vector(random.vector(k_frame_sigma_rad)) * from_rotation_vector(turn);
    frames.push_back(frame_at(t, place + random.vector(k_frame_sigma_m), rotation.normalized()));
    frames.back().noise = {1 + 0.5 * std::sin(0.3 * i), 2 + std::cos(0.4 * i)};
  }
  return frames;
}

// Batch least squares of one axis: states (x, v, a) at given times; a Gaussian prior for the first,
// process noise between them, some of them measured. Shares no code with the kernel. In extended
// precision: the information of a short step is nearly singular.
class Batch {
  using Real = long double;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  using States = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Information = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

 public:
  Batch(double damping, double density) : damping_(damping), density_(density) {}

  void add(double time, double noise_factor, const double* measured, double variance) {
    times_.push_back(time);
    factors_.push_back(noise_factor);
    measured_.push_back(measured != nullptr ? *measured : std::nan(""));
    variances_.push_back(variance);
  }
  void solve(const Eigen::Vector3d& prior_variance) {
    const auto n = static_cast<Eigen::Index>(3 * times_.size());
    Information information = Information::Zero(n, n);
    States right = States::Zero(n);
    information.topLeftCorner<3, 3>() = prior_variance.cast<Real>().cwiseInverse().asDiagonal();
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      if (!std::isnan(measured_[i]) && i > 0) {
        information(at, at) += 1 / variances_[i];
        right(at) += measured_[i] / variances_[i];
      }
      if (i == 0) {
        right(0) += measured_[0] / prior_variance(0);
        continue;
      }
      const Real step = Real(times_[i]) - times_[i - 1];
      Eigen::Matrix<Real, 3, 6> residual;
      residual << -transition(step), Matrix::Identity();
      const Matrix weight = (factors_[i] * noise(step)).inverse();
      information.block<6, 6>(at - 3, at - 3) += residual.transpose() * weight * residual;
    }
    covariance_ = information.inverse();
    states_ = covariance_ * right;
  }
  [[nodiscard]] Eigen::Vector3d state(std::size_t i) const {
    return states_.segment<3>(static_cast<Eigen::Index>(3 * i)).cast<double>();
  }
  [[nodiscard]] Eigen::Matrix3d covariance(std::size_t i) const {
    const auto at = static_cast<Eigen::Index>(3 * i);
    return covariance_.block<3, 3>(at, at).cast<double>();
  }

 private:
  [[nodiscard]] Matrix transition(Real t) const {
    const Real left = std::exp(-damping_ * t);
    Matrix f;
    f << 1, t, (damping_ * t - 1 + left) / (damping_ * damping_),  //
        0, 1, (1 - left) / damping_,                               //
        0, 0, left;
    return f;
  }
  // Simpson's rule with 2,000 steps.
  [[nodiscard]] Matrix noise(Real t) const {
    Matrix sum = Matrix::Zero();
    constexpr int steps = 2000;
    for (int i = 0; i <= steps; ++i) {
      const Real weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
      const Vector g = transition(t * i / steps).col(2);
      sum += weight * g * g.transpose();
    }
    return density_ * t / (3 * steps) * sum;
  }

  Real damping_, density_;
  std::vector<double> times_, factors_, measured_, variances_;
  States states_;
  Information covariance_;
};

// One axis of translation, or a rotation about one fixed axis: there the model is linear.
void expect_equal_to_batch(int axis, bool rotation, double period_s, double tolerance) {
  const MotionSettings settings;
  const double sigma = rotation ? k_frame_sigma_rad : k_frame_sigma_m;
  const double damping = rotation ? settings.angular_damping_1_s : settings.linear_damping_1_s;
  const double density = rotation ? settings.angular_noise_rad2_s5 : settings.linear_noise_m2_s5;
  const double speed = rotation ? settings.start_angular_speed_rad_s : settings.start_speed_m_s;
  test::Random random(41);
  Batch batch(damping, density);
  std::vector<StrokeFrame> frames;
  std::vector<double> between;  // unmeasured times, one after each frame but the last
  constexpr int count = 12;
  double t = 1;
  for (int i = 0; i < count; ++i) {
    t += period_s * (1 + 0.2 * std::sin(1.7 * i));
    const double value = 0.05 * std::sin(4 * t) + sigma * random.normal();
    const Vector3 on_axis = value * Vector3::Unit(axis);
    frames.push_back(frame_at(t, rotation ? Vector3::Zero() : on_axis,
                              rotation ? from_rotation_vector(on_axis) : Quaternion::Identity()));
    const double factor = 1 + 0.4 * std::sin(0.9 * i);
    (rotation ? frames.back().noise.angular : frames.back().noise.linear) = factor;
    if (i > 0) {
      const Time middle = frames[static_cast<std::size_t>(i) - 1].measured.time +
                          Duration{std::llround(0.3e9 * period_s)};
      between.push_back(static_cast<double>(middle.nanoseconds) * 1e-9);
      batch.add(between.back(), factor, nullptr, 0);
    }
    batch.add(static_cast<double>(frames.back().measured.time.nanoseconds) * 1e-9, factor, &value,
              sigma * sigma);
  }
  const double acceleration = rotation ? density / (2 * damping) : 25;  // (5 m/s^2)^2
  batch.solve({sigma * sigma, speed * speed, acceleration});
  const Smoothed smoothed(frames);
  ASSERT_EQ(smoothed.reason, Reason::none);
  const int at = (rotation ? k_rotation : k_position) + axis;
  for (std::size_t i = 0; i + 1 < 2 * count; ++i) {
    const Time time =
        i % 2 == 0 ? frames[i / 2].measured.time : Time{std::llround(1e9 * between[i / 2])};
    const Result<MotionState> state = smoothed.at(time);
    ASSERT_TRUE(state);
    MotionState zero;
    const MotionStateError values = motion_difference(state.value, zero);
    for (int a = 0; a < 3; ++a) {
      const double stated = std::sqrt(batch.covariance(i)(a, a));
      EXPECT_NEAR(values(at + 3 * a), batch.state(i)(a), tolerance * stated) << i << ' ' << a;
      for (int b = 0; b < 3; ++b) {
        const double other = std::sqrt(batch.covariance(i)(b, b));
        EXPECT_NEAR(state.value.covariance(at + 3 * a, at + 3 * b), batch.covariance(i)(a, b),
                    tolerance * stated * other)
            << i << ' ' << a << ' ' << b;
      }
    }
  }
}

TEST(SmoothStroke, EqualsBatchLeastSquaresForATranslation) {
  expect_equal_to_batch(0, false, 0.022, 1e-5);
  expect_equal_to_batch(2, false, 0.2, 1e-4);
}

// The process noise of a strongly damped axis is a quadrature of 1e-5 at 45 Hz.
TEST(SmoothStroke, EqualsBatchLeastSquaresForARotationAboutOneAxis) {
  expect_equal_to_batch(1, true, 0.022, 1e-3);
}

TEST(SmoothStroke, IsNeverLessCertainThanTheFilter) {
  for (const double period_s : {0.022, 0.2}) {
    const Smoothed smoothed(noisy_stroke(60, 7, period_s));
    ASSERT_EQ(smoothed.reason, Reason::none);
    const auto& frames = smoothed.frames;
    MotionState filtered = initial_motion_state(frames.front().measured, {});
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (i > 0) {
        propagate(filtered, frames[i].measured.time, {}, frames[i].noise);
        ASSERT_EQ(correct_by_pose(filtered, frames[i].measured).reason, Reason::none);
      }
      const Matrix6 filter = pose_of(filtered).covariance;
      const Matrix6 smoother = pose_of(smoothed.at(frames[i].measured.time).value).covariance;
      const Matrix6 scale = filter.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
      const Eigen::SelfAdjointEigenSolver<Matrix6> more(scale * (filter - smoother) * scale);
      EXPECT_GE(more.eigenvalues().minCoeff(), -1e-6) << "frame " << i;
      EXPECT_GT(
          Eigen::SelfAdjointEigenSolver<Matrix6>(scale * smoother * scale).eigenvalues().minCoeff(),
          0)
          << "frame " << i;
      if (period_s < 0.1 && i + 10 < frames.size()) {
        EXPECT_LT(smoother.trace(), 0.9 * filter.trace()) << "frame " << i;
      }
    }
  }
}

TEST(SmoothStroke, ReturnsTheOnlyFrame) {
  const Smoothed smoothed(noisy_stroke(1, 3));
  ASSERT_EQ(smoothed.reason, Reason::none);
  const UncertainPose& only = smoothed.frames.front().measured;
  const Result<MotionState> state = smoothed.at(only.time);
  ASSERT_TRUE(state);
  EXPECT_EQ(state.value.pose.translation, only.pose.translation);
  EXPECT_EQ(pose_of(state.value).covariance, only.covariance);
  EXPECT_EQ(smoothed.at(only.time + Duration{1}).reason, Reason::out_of_range);
  EXPECT_EQ(smoothed.at(only.time - Duration{1}).reason, Reason::out_of_range);
}

TEST(SmoothStroke, RefusesBadFramesByTheirReason) {
  const std::vector<StrokeFrame> good = noisy_stroke(5, 3);
  const auto reason_of = [](const std::vector<StrokeFrame>& frames) {
    const Smoothed smoothed(frames);
    EXPECT_EQ(smoothed.at(Time{3'100'000'000}).reason, Reason::no_frame_yet);
    return smoothed.reason;
  };
  EXPECT_EQ(reason_of({}), Reason::no_frame_yet);
  EXPECT_EQ(reason_of(noisy_stroke(static_cast<int>(k_stroke_frames_max) + 1, 3)),
            Reason::out_of_range);
  std::vector<StrokeFrame> frames = good;
  std::swap(frames[2], frames[3]);
  EXPECT_EQ(reason_of(frames), Reason::frame_late);
  frames = good;
  frames[3].measured.time = frames[2].measured.time;
  EXPECT_EQ(reason_of(frames), Reason::frame_duplicate);
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](auto change) {
    frames = good;
    change(frames[2]);
    return reason_of(frames);
  };
  EXPECT_EQ(with([](StrokeFrame& f) { f.measured.pose.translation.y() = k_nan; }),
            Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.measured.pose.rotation.w() = k_nan; }),
            Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.measured.covariance(1, 2) = k_nan; }),
            Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.noise.linear = k_nan; }), Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.noise.angular = -1; }), Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.parent_noise(0, 0) = k_nan; }), Reason::out_of_range);
  EXPECT_EQ(with([](StrokeFrame& f) { f.measured.covariance(1, 1) = 0; }), Reason::degenerate);
  StrokeSmoother smoother;
  std::vector<SmoothedFrame> memory(4);
  EXPECT_EQ(smoother.smooth(good, {}, memory), Reason::not_prepared);
}

TEST(SmoothStroke, TakesTheLargestStroke) {
  const Smoothed smoothed(noisy_stroke(static_cast<int>(k_stroke_frames_max), 3));
  EXPECT_EQ(smoothed.reason, Reason::none);
  EXPECT_TRUE(smoothed.at(smoothed.frames.back().measured.time));
}

// The world is corrected by a step between two frames: the poses on both sides are those of the
// same motion without the step, each in its own world.
TEST(SmoothStroke, FollowsAStepOfTheParentFrame) {
  constexpr std::size_t step = 20;
  const std::vector<StrokeFrame> steady = noisy_stroke(40, 9);
  std::vector<StrokeFrame> stepped = steady;
  const Pose moved{from_rotation_vector(Vector3(0.02, -0.05, 0.1)), Vector3(0.03, 0.01, -0.02)};
  for (std::size_t i = step; i < stepped.size(); ++i) {
    UncertainPose& pose = stepped[i].measured;
    pose.pose = moved * pose.pose;
  }
  stepped[step].parent_moved = moved;
  const Smoothed a(steady), b(stepped);
  ASSERT_EQ(b.reason, Reason::none);
  for (std::size_t i = 0; i < steady.size(); ++i) {
    const Time time = steady[i].measured.time;
    const Pose without = a.at(time).value.pose, with = b.at(time).value.pose;
    const Vector6 off = pose_difference(with, i < step ? without : moved * without);
    EXPECT_LT(off.norm(), 1e-6) << i;
  }
  const Time between = steady[step].measured.time - milliseconds(5);
  EXPECT_LT(pose_difference(b.at(between).value.pose, moved * a.at(between).value.pose).norm(),
            1e-6);
}

// Frames on both sides of a gap in which the world may have drifted do not vouch for each other.
TEST(SmoothStroke, GrowsByTheParentFramesNoise) {
  std::vector<StrokeFrame> frames = noisy_stroke(40, 9);
  const Smoothed steady(frames);
  frames[20].parent_noise = Matrix6::Identity() * 1e-2;
  const Smoothed drifted(frames);
  const Time time = frames[19].measured.time;
  EXPECT_GT(pose_of(drifted.at(time).value).covariance(0, 0),
            1.3 * pose_of(steady.at(time).value).covariance(0, 0));
}

TEST(SmoothStroke, AllocatesNothing) {
  const std::vector<StrokeFrame> frames = noisy_stroke(30, 5);
  std::vector<SmoothedFrame> memory(frames.size());
  StrokeSmoother smoother;
  const HeapCount heap;
  EXPECT_EQ(smoother.smooth(frames, {}, memory), Reason::none);
  EXPECT_TRUE(smoother.at(frames[3].measured.time + milliseconds(3), frames));
  EXPECT_EQ(heap.count(), 0u);
}

TEST(SmoothStroke, GivesTheSameBitsAgain) {
  const auto hash_of = [](const Smoothed& smoothed) {
    test::BitHash hash;
    for (int i = 0; i < 300; ++i) {
      const Result<MotionState> state =
          smoothed.at(smoothed.frames.front().measured.time + milliseconds(4) * i);
      if (!state) continue;
      hash.add(state.value.pose);
      for (int j = 0; j < k_motion_size; ++j) hash.add(state.value.covariance(j, j));
    }
    return hash.value();
  };
  const Smoothed first(noisy_stroke(50, 5));
  EXPECT_EQ(hash_of(first), hash_of(Smoothed(noisy_stroke(50, 5))));
  EXPECT_NE(hash_of(first), hash_of(Smoothed(noisy_stroke(50, 6))));
}

}  // namespace
}  // namespace glint

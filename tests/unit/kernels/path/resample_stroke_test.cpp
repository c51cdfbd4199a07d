#include "kernels/path/resample_stroke.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

using Next = StrokeResampler::Next;
constexpr double k_sigma_m = 0.0005, k_sigma_rad = 0.005;

Matrix6 declared_noise() {
  Matrix6 covariance = Matrix6::Zero();
  for (int i = 0; i < 6; ++i) {
    covariance(i, i) = i < 3 ? k_sigma_m * k_sigma_m : k_sigma_rad * k_sigma_rad;
  }
  covariance(0, 1) = covariance(1, 0) = 0.5 * k_sigma_m * k_sigma_m;
  return covariance;
}

UncertainPose at(double seconds, const Vector3& place, const Quaternion& rotation) {
  return {Time{std::llround(seconds * 1e9)}, {rotation, place}, declared_noise()};
}
UncertainPose at(double seconds, const Vector3& place) {
  return at(seconds, place, Quaternion::Identity());
}

// Ground truth: a circle of 60 mm radius drawn at this speed while the pen's tilt oscillates.
UncertainPose on_a_ring(double seconds, double speed_m_s) {
  const double radius = 0.06, angle = seconds * speed_m_s / radius;
  const SineCosine s = sine_cosine(angle);
  return at(seconds, Vector3(radius * s.cosine, radius * s.sine, 0.1 + 0.02 * s.sine * s.cosine),
            from_rotation_vector(Vector3(0.5 * s.sine, 0.3 * s.cosine, 0.2)));
}

std::vector<UncertainPose> resampled(const std::vector<UncertainPose>& samples,
                                     const StrokeSettings& settings) {
  StrokeResampler resampler;
  EXPECT_EQ(resampler.begin(settings), Reason::none);
  std::vector<UncertainPose> points;
  const auto take = [&] {
    UncertainPose point;
    for (Next next = resampler.next(point); next != Next::none; next = resampler.next(point)) {
      if (next == Next::replace_last) points.pop_back();
      points.push_back(point);
    }
  };
  for (const UncertainPose& sample : samples) {
    EXPECT_EQ(resampler.add(sample), Reason::none);
    take();
  }
  resampler.end();
  take();
  return points;
}

double step(const UncertainPose& a, const UncertainPose& b) {
  return (a.pose.translation - b.pose.translation).norm();
}

TEST(ResampleStroke, PutsPointsTheDeclaredSpacingApartAlongALine) {
  std::vector<UncertainPose> line;
  for (int i = 0; i <= 250; ++i) line.push_back(at(0.004 * i, Vector3(0.0004 * i, 0, 0.3)));
  const auto points = resampled(line, {.spacing_m = 0.003});
  ASSERT_EQ(points.size(), 34u);  // 0, 3, .. 96 mm; the end at 100 mm replaces 99
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    EXPECT_NEAR(points[i].pose.translation.x(), 0.003 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(static_cast<double>(points[i].time.nanoseconds), 3e7 * static_cast<double>(i), 1);
  }
  EXPECT_EQ(points.back().pose.translation.x(), line.back().pose.translation.x());
}

TEST(ResampleStroke, FillsTheWayBetweenSamplesOfAFastStroke) {
  const std::vector<UncertainPose> fast = {at(0, {0, 0, 0}), at(0.03, {0.02, 0, 0}),
                                           at(0.06, {0.04, 0, 0}), at(0.09, {0.04, 0.02, 0})};
  const auto points = resampled(fast, {.spacing_m = 0.001});
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    EXPECT_NEAR(step(points[i], points[i + 1]), 0.001, 1e-12) << i;
  }
  EXPECT_EQ(points.back().pose.translation, fast.back().pose.translation);
}

TEST(ResampleStroke, KeepsAPointForEachTurnOnTheSpot) {
  std::vector<UncertainPose> turning;
  for (int i = 0; i <= 100; ++i) {
    turning.push_back(at(0.01 * i, Vector3(0, 0, 0.1), from_rotation_vector({0, 0.01 * i, 0})));
  }
  const auto points = resampled(turning, {.turn_rad = 0.0999});
  ASSERT_EQ(points.size(), 11u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(rotation_vector(points[i].pose.rotation).y(), 0.1 * static_cast<double>(i), 2e-3);
  }
}

// A static tip adds no points, however long it jitters.
TEST(ResampleStroke, DoesNotGrowWhileTheTipTrembles) {
  test::Random random(3);
  std::vector<UncertainPose> still;
  for (int i = 0; i < 2000; ++i) still.push_back(at(0.004 * i, random.vector(0.0003)));
  EXPECT_LE(resampled(still, {}).size(), 2u);
}

TEST(ResampleStroke, LetsANearEndTakeTheLastPointsPlace) {
  std::vector<UncertainPose> line;
  for (int i = 0; i <= 24; ++i) line.push_back(at(0.01 * i, Vector3(0.0001 * i, 0, 0)));
  const auto points = resampled(line, {.spacing_m = 0.001});
  ASSERT_EQ(points.size(), 3u);  // 0 and 1 mm; the end at 2.4 mm replaces 2
  EXPECT_EQ(points.back().pose.translation.x(), line.back().pose.translation.x());
}

// Mean squared Mahalanobis distance of the points from the ground truth at their time, by the
// stated covariance; 6 if it is consistent.
enum class Noise { white, common, gauss_markov };
double normalised_error(double speed_m_s, Noise noise) {
  test::Random random(17);
  const Eigen::Matrix<double, 6, 6> factor = declared_noise().llt().matrixL();
  const auto drawn = [&] {
    Eigen::Matrix<double, 6, 1> unit;
    for (int i = 0; i < 6; ++i) unit(i) = random.normal();
    return unit;
  };
  double sum = 0;
  std::int64_t count = 0;
  for (int stroke = 0; stroke < test::repetitions(100, 25); ++stroke) {
    std::vector<UncertainPose> samples;
    Eigen::Matrix<double, 6, 1> unit_error = drawn();
    const double seconds = 0.1 / speed_m_s;
    for (double t = 0; t < seconds; t += 0.004) {
      if (noise == Noise::white) unit_error = drawn();
      if (noise == Noise::gauss_markov)
        unit_error = 0.95 * unit_error + std::sqrt(1 - 0.95 * 0.95) * drawn();
      const Eigen::Matrix<double, 6, 1> error = factor * unit_error;
      UncertainPose sample = on_a_ring(t, speed_m_s);
      sample.pose.translation += error.head<3>();
      sample.pose.rotation =
          (from_rotation_vector(error.tail<3>()) * sample.pose.rotation).normalized();
      samples.push_back(sample);
    }
    for (const UncertainPose& point : resampled(samples, {})) {
      const Pose truth = on_a_ring(point.time.nanoseconds * 1e-9, speed_m_s).pose;
      Eigen::Matrix<double, 6, 1> error;
      error << point.pose.translation - truth.translation,
          rotation_vector(point.pose.rotation * truth.rotation.conjugate());
      sum += error.dot(point.covariance.llt().solve(error));
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

TEST(ResampleStroke, ComesBackWithinItsCovarianceHoweverTheNoiseIsCorrelated) {
  for (const double speed : {0.01, 0.05, 0.2, 0.8}) {
    // One error for the whole stroke: the covariance (1 - u) Ca + u Cb is exact. Standard deviation
    // of the mean of 100 chi-squares: 0.35.
    EXPECT_NEAR(normalised_error(speed, Noise::common), 6, test::repetitions(11, 22) / 10.0)
        << speed;
    EXPECT_LT(normalised_error(speed, Noise::gauss_markov), 6.5) << speed;
    // For white noise the covariance between two samples is conservative, at most by a factor of 2.
    const double white = normalised_error(speed, Noise::white);
    EXPECT_LT(white, 6) << speed;
    EXPECT_GT(white, 3) << speed;
  }
}

TEST(ResampleStroke, AddsWhatAHandMayHaveDoneBetweenSamplesFarApart) {
  const std::vector<UncertainPose> apart = {at(0, {0, 0, 0}), at(0.09, {0.004, 0, 0})};
  const auto points = resampled(apart, {.spacing_m = 0.002});
  ASSERT_EQ(points.size(), 3u);
  const double acceleration_offset_m = 2.3 * 0.25 * 0.09 * 0.09 / 2;
  EXPECT_NEAR(points[1].covariance(0, 0),
              k_sigma_m * k_sigma_m + acceleration_offset_m * acceleration_offset_m, 1e-15);
  EXPECT_EQ(points[0].covariance, declared_noise());
}

TEST(ResampleStroke, RefusesWhatCannotBeOfTheStrokeAndGoesOn) {
  StrokeResampler resampler;
  ASSERT_EQ(resampler.begin({}), Reason::none);
  EXPECT_EQ(resampler.add(at(1, {0, 0, 0})), Reason::none);
  EXPECT_EQ(resampler.add(at(1, {0, 0, 0})), Reason::frame_late);
  EXPECT_EQ(resampler.add(at(0.9, {0, 0, 0})), Reason::frame_late);
  EXPECT_EQ(resampler.add(at(1.2, {0, 0, 0})), Reason::too_old);
  EXPECT_EQ(resampler.add(at(1.01, {1.1, 0, 0})), Reason::out_of_range);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(resampler.add(at(1.01, {nan, 0, 0})), Reason::out_of_range);
  EXPECT_EQ(resampler.add(at(1.01, {0, 0, 0}, Quaternion(2, 0, 0, 0))), Reason::out_of_range);
  UncertainPose unsure = at(1.01, {0, 0, 0});
  unsure.covariance(5, 5) = nan;
  EXPECT_EQ(resampler.add(unsure), Reason::out_of_range);
  EXPECT_EQ(resampler.add(at(1.01, {0.001, 0, 0})), Reason::none);
}

TEST(ResampleStroke, RefusesSettingsThatNoStrokeCanHave) {
  StrokeResampler resampler;
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(resampler.begin({.spacing_m = wrong}), Reason::out_of_range);
    EXPECT_EQ(resampler.begin({.turn_rad = wrong}), Reason::out_of_range);
    EXPECT_EQ(resampler.begin({.acceleration_m_s2 = wrong}), Reason::out_of_range);
  }
  EXPECT_EQ(resampler.begin({.turn_rad = 3.2}), Reason::out_of_range);
  EXPECT_EQ(resampler.begin({.gap_max = {}}), Reason::out_of_range);
  EXPECT_EQ(resampler.begin({.gap_max = Duration{1}}), Reason::none);
}

TEST(ResampleStroke, EndsAfterTheDeclaredPointsOfTheWorstSample) {
  const StrokeSettings settings{.spacing_m = 0.001, .turn_rad = 0.05};
  const std::vector<UncertainPose> worst = {
      at(0, {0, 0, 0}),
      at(0.1, {0.001 * k_stroke_step_max, 0, 0}, from_rotation_vector({3.1, 0, 0}))};
  const auto points = resampled(worst, settings);
  EXPECT_LE(points.size(), static_cast<std::size_t>(k_stroke_step_max + 63 + 2));
  EXPECT_GE(points.size(), static_cast<std::size_t>(k_stroke_step_max));
}

TEST(ResampleStroke, GivesNothingWithoutSamplesAndOnePointOfOne) {
  EXPECT_TRUE(resampled({}, {}).empty());
  EXPECT_EQ(resampled({at(0, {0, 0, 0})}, {}).size(), 1u);
}

TEST(ResampleStroke, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  StrokeResampler resampler;
  const auto reason_of = [&](auto change) {
    StrokeSettings settings;
    change(settings);
    return resampler.begin(settings);
  };
  using S = StrokeSettings;
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  for (double S::*setting :
       {&S::spacing_m, &S::turn_rad, &S::acceleration_m_s2, &S::angular_acceleration_rad_s2}) {
    EXPECT_EQ(reason_of([&](S& s) { s.*setting = 1e-9; }), Reason::none);
    for (const double wrong : {0.0, -1e-9, k_nan, k_infinity}) {
      EXPECT_EQ(reason_of([&](S& s) { s.*setting = wrong; }), Reason::out_of_range) << wrong;
    }
  }
  EXPECT_EQ(reason_of([](S& s) { s.turn_rad = M_PI; }), Reason::none);
  EXPECT_EQ(reason_of([](S& s) { s.turn_rad = std::nextafter(M_PI, 4); }), Reason::out_of_range);
  EXPECT_EQ(reason_of([](S& s) { s.gap_max = Duration{1}; }), Reason::none);
  EXPECT_EQ(reason_of([](S& s) { s.gap_max = Duration{0}; }), Reason::out_of_range);
  EXPECT_EQ(reason_of([](S& s) { s.gap_max = Duration{-1}; }), Reason::out_of_range);
}

TEST(ResampleStroke, TakesASampleUpToEachLimitAndNotBeyond) {
  const auto reason_of = [](UncertainPose second) {
    StrokeResampler resampler;
    EXPECT_EQ(resampler.begin({.spacing_m = 0.0009765625}), Reason::none);  // 2^-10
    EXPECT_EQ(resampler.add(at(1, {0, 0, 0})), Reason::none);
    return resampler.add(second);
  };
  UncertainPose sample = at(1.1, {0, 0, 0});
  EXPECT_EQ(reason_of(sample), Reason::none);
  ++sample.time.nanoseconds;
  EXPECT_EQ(reason_of(sample), Reason::too_old);
  sample = at(1, {0, 0, 0});
  EXPECT_EQ(reason_of(sample), Reason::frame_late);
  ++sample.time.nanoseconds;
  EXPECT_EQ(reason_of(sample), Reason::none);
  EXPECT_EQ(reason_of(at(1.01, {0, 0.5, 0})), Reason::none) << "512 spacings";
  EXPECT_EQ(reason_of(at(1.01, {0, std::nextafter(0.5, 1), 0})), Reason::out_of_range);
  for (const double scale : {1 + 4e-7, 1 - 4e-7}) {
    EXPECT_EQ(reason_of(at(1.01, {0, 0, 0}, Quaternion(scale, 0, 0, 0))), Reason::none);
  }
  for (const double scale : {1 + 6e-7, 1 - 6e-7, 0.0, std::nan("")}) {
    EXPECT_EQ(reason_of(at(1.01, {0, 0, 0}, Quaternion(scale, 0, 0, 0))), Reason::out_of_range);
  }
}

// Halfway between two samples, along and about each axis.
TEST(ResampleStroke, AddsAHandsAccelerationAlongAndAboutEachAxis) {
  std::vector<UncertainPose> apart = {at(0, {0, 0, 0}), at(0.09, {0.004, 0, 0})};
  ++apart[1].time.nanoseconds;  // half of it is rounded up
  apart[1].covariance = 3 * declared_noise();
  const auto points = resampled(
      apart, {.spacing_m = 0.002, .acceleration_m_s2 = 3, .angular_acceleration_rad_s2 = 20});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[1].time.nanoseconds, 45'000'001);
  const double deviation_s2 = 0.5 * 0.25 * 0.090000001 * 0.090000001;
  Matrix6 expected = 2 * declared_noise();
  for (int i = 0; i < 6; ++i) {
    const double off = deviation_s2 * (i < 3 ? 3 : 20);
    expected(i, i) += off * off;
  }
  EXPECT_LT((points[1].covariance - expected).norm(), 1e-12 * expected.norm());
}

// After a stroke that was interrupted, and one that ended.
TEST(ResampleStroke, BegunAgainGivesThePointsOfANewOne) {
  StrokeResampler used, fresh;
  ASSERT_EQ(fresh.begin({}), Reason::none);
  UncertainPose point;
  for (const bool ended : {false, true}) {
    ASSERT_EQ(used.begin({.spacing_m = 0.001}), Reason::none);
    for (int i = 0; i < 40; ++i) {
      ASSERT_EQ(used.add(at(0.004 * i, Vector3(0.001 * i, 0, 0))), Reason::none);
      while (used.next(point) != Next::none) {
      }
    }
    if (ended) {
      used.end();
      while (used.next(point) != Next::none) {
      }
      EXPECT_EQ(used.next(point), Next::none) << "it has ended";
    }
    ASSERT_EQ(used.begin({}), Reason::none);
    ASSERT_EQ(fresh.begin({}), Reason::none);
    EXPECT_EQ(used.next(point), Next::none);
    for (int i = 0; i < 60; ++i) {
      const UncertainPose sample = on_a_ring(0.004 * i, 0.2);
      ASSERT_EQ(used.add(sample), Reason::none);
      ASSERT_EQ(fresh.add(sample), Reason::none);
      if (i == 59) used.end(), fresh.end();
      for (Next next = Next::point; next != Next::none;) {
        UncertainPose a, b;
        next = used.next(a);
        ASSERT_EQ(next, fresh.next(b)) << i;
        ASSERT_EQ(a.time, b.time);
        ASSERT_EQ(a.pose.translation, b.pose.translation);
        ASSERT_EQ(a.covariance, b.covariance);
      }
    }
  }
}

// The end is a separate point if it is half a spacing or half a rotation step beyond the last one.
TEST(ResampleStroke, EndsWithAPointWhereItIsFarEnoughFromTheLast) {
  const auto count = [](double way, double turn) {
    std::vector<UncertainPose> line;
    for (int i = 0; i <= 50; ++i) {
      line.push_back(at(0.01 * i, Vector3(0.02 * way * i, 0, 0),
                        from_rotation_vector(Vector3(0, 0.02 * turn * i, 0))));
    }
    const auto points = resampled(line, {.spacing_m = 0.01, .turn_rad = 0.1});
    EXPECT_EQ(points.back().time, line.back().time);
    EXPECT_EQ(points.back().pose.translation, line.back().pose.translation);
    return points.size();
  };
  EXPECT_EQ(count(0.0248, 0), 3u);  // 0, 10 mm; the end replaces 20 mm
  EXPECT_EQ(count(0.0252, 0), 4u);
  EXPECT_EQ(count(0.021, 0.248 - 0.2), 3u);
  EXPECT_EQ(count(0, 0.245), 3u);
  EXPECT_EQ(count(0, 0.255), 4u);
  EXPECT_EQ(count(0.0052, 0), 2u) << "the end alone, beside the first";
}

// Only its first point, which an end nearby does not replace.
TEST(ResampleStroke, OfAStrokeThatGoesNowhereIsItsBeginning) {
  for (const double way : {0.0, 0.0004, 0.0009}) {
    std::vector<UncertainPose> line;
    for (int i = 0; i <= 20; ++i) line.push_back(at(0.01 * i, Vector3(0.05 * way * i, 0, 0)));
    const auto points = resampled(line, {.spacing_m = 0.002});
    ASSERT_EQ(points.size(), 1u) << way;
    EXPECT_EQ(points[0].time, line[0].time);
    EXPECT_EQ(points[0].pose.translation, line[0].pose.translation);
  }
}

TEST(ResampleStroke, AsksForNoMemory) {
  StrokeResampler resampler;
  const HeapCount heap;
  (void)resampler.begin({});
  UncertainPose point;
  int points = 0;
  for (int i = 0; i < 500; ++i) {
    (void)resampler.add(on_a_ring(0.004 * i, 0.1));
    while (resampler.next(point) != Next::none) ++points;
  }
  EXPECT_EQ(heap.count(), 0u);
  EXPECT_GT(points, 90);
}

TEST(ResampleStroke, GivesTheSameBitsEverywhere) {
  test::Random random(5);
  std::vector<UncertainPose> samples;
  for (int i = 0; i < 2000; ++i) {
    UncertainPose sample = on_a_ring(0.004 * i, 0.1);
    sample.pose.translation += random.vector(k_sigma_m);
    sample.pose.rotation =
        (from_rotation_vector(random.vector(k_sigma_rad)) * sample.pose.rotation).normalized();
    samples.push_back(sample);
  }
  test::BitHash hash;
  for (const UncertainPose& point : resampled(samples, {})) {
    hash.add(point.pose);
    for (int i = 0; i < 6; ++i) hash.add(point.covariance(i, i));
  }
  EXPECT_EQ(hash.value(), 16660717631346544731u);
}

}  // namespace
}  // namespace glint

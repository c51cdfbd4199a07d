// Lines, arcs and corners of strokes made from shapes that are known, with noise of their
// covariance.
#include "platform/tools/programming/stroke_moves.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

constexpr double k_shape_spacing_m = 0.002;

// Points every 2 mm along a curve of arc length, in a random frame, with noise of `sigma`, whose
// axes differ by a factor of 3.
struct NoisyShape {
  NoisyShape(const std::function<Vector3(double)>& curve, double length_m, double sigma_m,
             std::uint64_t random_seed) {
    test::Random random(random_seed);
    frame = {random.rotation(), random.in_box(1)};
    const Matrix3 axes = random.rotation().toRotationMatrix();
    const Vector3 sigmas = sigma_m * Vector3(0.5, 1, 1.5);
    Matrix6 covariance = Matrix6::Identity() * 1e-6;
    covariance.topLeftCorner<3, 3>() = axes * sigmas.cwiseAbs2().asDiagonal() * axes.transpose();
    const Quaternion grip = random.rotation();
    for (double s = 0; s <= length_m + 1e-9; s += k_shape_spacing_m) {
      const Vector3 noise(sigmas.x() * random.normal(), sigmas.y() * random.normal(),
                          sigmas.z() * random.normal());
      points.push_back({Time{static_cast<std::int64_t>(1e9 * s)},
                        {grip, frame * curve(s) + axes * noise},
                        covariance});
    }
  }
  Pose frame;
  std::vector<UncertainPose> points;
};

Vector3 straight(double s) { return {s, 0, 0}; }
Vector3 corner_shape(double s) { return s < 0.1 ? Vector3(s, 0, 0) : Vector3(0.1, s - 0.1, 0); }
Vector3 round_shape(double s) { return 0.05 * Vector3(std::cos(s / 0.05), std::sin(s / 0.05), 0); }
// 80 mm, a quarter circle of 40 mm radius, 80 mm.
Vector3 rounded_corner(double s) {
  const double quarter = 0.04 * std::numbers::pi / 2;
  if (s < 0.08) return {s, 0, 0};
  if (s < 0.08 + quarter) {
    const double angle = (s - 0.08) / 0.04;
    return {0.08 + 0.04 * std::sin(angle), 0.04 * (1 - std::cos(angle)), 0};
  }
  return {0.12, 0.04 + s - 0.08 - quarter, 0};
}

std::string kinds_of(const std::vector<StrokeSegment>& segments) {
  std::string kinds;
  for (const StrokeSegment& segment : segments)
    kinds += segment.kind == SegmentKind::line ? 'L' : segment.kind == SegmentKind::arc ? 'A' : 'F';
  return kinds;
}

TEST(StrokeSegments, ALineIsOneLineInNoiseOfItsCovariance) {
  const int strokes = test::repetitions(200, 20);
  int one = 0;
  for (int seed = 1; seed <= strokes; ++seed) {
    const NoisyShape shape(straight, 0.2, 0.0005, static_cast<std::uint64_t>(seed));
    one += kinds_of(stroke_segments(shape.points, {})) == "L" ? 1 : 0;
  }
  EXPECT_GE(one, 98 * strokes / 100);  // 99.9 % of a single test; a stroke needs several
}

TEST(StrokeSegments, ACornerIsFoundWhereItIs) {
  const int strokes = test::repetitions(60, 4);
  int right = 0;
  double worst_m = 0;
  for (int seed = 1; seed <= strokes; ++seed) {
    const NoisyShape shape(corner_shape, 0.2, 0.0003, 1000 + static_cast<std::uint64_t>(seed));
    if (kinds_of(stroke_segments(shape.points, {})) != "LL") continue;
    ++right;
    const auto moves = stroke_moves(shape.points, SegmentSettings{});
    ASSERT_EQ(moves.size(), 3u);
    EXPECT_FALSE(moves[1].via || moves[2].via);
    const Vector3 corner = shape.frame * Vector3(0.1, 0, 0);
    worst_m = std::max(worst_m, (moves[1].pose.translation - corner).norm());
  }
  EXPECT_GE(right, 95 * strokes / 100);
  EXPECT_LT(worst_m, 0.0006);
  std::printf("%d of %d corners, at most %.2f mm off\n", right, strokes, 1e3 * worst_m);
}

TEST(StrokeSegments, AnArcHasItsCentreAndRadius) {
  const auto strokes = static_cast<std::uint64_t>(test::repetitions(40, 8));
  for (std::uint64_t seed = 1; seed <= strokes; ++seed) {
    const NoisyShape shape(round_shape, 0.05 * 1.5 * std::numbers::pi, 0.0003, 2000 + seed);
    const auto segments = stroke_segments(shape.points, {});
    ASSERT_EQ(kinds_of(segments), "A") << seed;
    EXPECT_NEAR(segments[0].radius_m, 0.05, 0.0003);
    EXPECT_LT((segments[0].point - shape.frame.translation).norm(), 0.0004);
    EXPECT_GT(segments[0].direction.dot(shape.frame.rotation * Vector3::UnitZ()), 0.999);
    // 270 degrees are two moves, through the circle's points.
    const auto moves = stroke_moves(shape.points, SegmentSettings{});
    ASSERT_EQ(moves.size(), 3u);
    for (const std::size_t i : {1, 2}) {
      ASSERT_TRUE(moves[i].via.has_value());
      // The stroke's end is up to a spacing before three quarters of the circle.
      const double angle = (i == 1 ? 0.375 : 1.125) * std::numbers::pi;
      const Vector3 local = shape.frame.inverse() * moves[i].via->translation;
      EXPECT_LT(std::hypot(local.head<2>().norm() - 0.05, local.z()), 0.0006);
      EXPECT_LT((moves[i].via->translation - shape.frame * round_shape(0.05 * angle)).norm(),
                0.003);
    }
  }
}

TEST(StrokeSegments, ATangentArcIsBetweenItsLines) {
  const int strokes = test::repetitions(40, 4);
  int right = 0;
  for (int seed = 1; seed <= strokes; ++seed) {
    const NoisyShape shape(rounded_corner, 0.16 + 0.02 * std::numbers::pi, 0.0002,
                           3000 + static_cast<std::uint64_t>(seed));
    const auto segments = stroke_segments(shape.points, {});
    if (kinds_of(segments) != "LAL") continue;
    ++right;
    EXPECT_NEAR(segments[1].radius_m, 0.04, 0.004);
  }
  EXPECT_GE(right, 80 * strokes / 100);
  std::printf("%d of %d rounded corners\n", right, strokes);
}

// The same points: a line for a large covariance, none for a small one.
TEST(StrokeSegments, TheCovarianceDecides) {
  const auto wave = [](double s) { return Vector3(s, 0.002 * std::sin(60 * s), 0); };
  NoisyShape shape(wave, 0.2, 1e-6, 7);
  const auto with_sigma = [&](double sigma_m) {
    for (UncertainPose& point : shape.points)
      point.covariance = Matrix6::Identity() * sigma_m * sigma_m;
    return kinds_of(stroke_segments(shape.points, {}));
  };
  EXPECT_EQ(with_sigma(0.002), "L");
  EXPECT_GT(with_sigma(0.0002).size(), 2u);
  EXPECT_EQ(with_sigma(1e-9), "F");
}

TEST(StrokeSegments, ATurnOfTheToolEndsALine) {
  NoisyShape shape(straight, 0.2, 0.0003, 5);
  for (std::size_t i = 50; i < shape.points.size(); ++i)
    shape.points[i].pose.rotation =
        Quaternion(Eigen::AngleAxisd(0.01 * static_cast<double>(i - 50), Vector3::UnitX())) *
        shape.points[i].pose.rotation;
  const auto segments = stroke_segments(shape.points, {});
  EXPECT_EQ(kinds_of(segments), "LL");
  EXPECT_NEAR(static_cast<double>(segments[0].last), 50, 20);
}

TEST(StrokeSegments, KeepEveryPointOfAShortStroke) {
  for (const int count : {1, 2, 3, 5}) {
    NoisyShape shape(straight, 0.2, 0.0003, 5);
    shape.points.resize(static_cast<std::size_t>(count));
    EXPECT_EQ(stroke_moves(shape.points, SegmentSettings{}).size(), shape.points.size());
    EXPECT_EQ(stroke_moves(shape.points, {}).size(), shape.points.size());
  }
}

}  // namespace
}  // namespace glint

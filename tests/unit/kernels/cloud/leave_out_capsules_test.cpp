#include "kernels/cloud/leave_out_capsules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "clouds.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

// Reference: smallest distance to 2,001 samples on the capsule's axis.
double plain_distance(const ExclusionCapsule& capsule, const Vector3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2000; ++i) {
    const Vector3 place = capsule.from + (capsule.to - capsule.from) * (i / 2000.0);
    least = std::min(least, (point - place).norm());
  }
  return least;
}

TEST(LeaveOutCapsules, TakesOffWhatIsWithinTheirRadiusAndKeepsTheOrder) {
  test::Random random(4);
  const std::vector<ExclusionCapsule> capsules = {{{0, 0, 0}, {0.5, 0.1, 0}, 0.15},
                                                  {{-0.3, 0.2, 0.1}, {-0.3, 0.2, 0.1}, 0.2}};
  TestCloud cloud(3000);
  std::vector<Point> expected;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = random.in_box(1.6);
    const Point point = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z())};
    const Vector3 rounded(point[0], point[1], point[2]);
    double least = 1;  // upper bound of the distance to the nearest capsule's surface
    for (const ExclusionCapsule& capsule : capsules) {
      least = std::min(least, plain_distance(capsule, rounded) - capsule.radius_m);
    }
    if (std::abs(least) < 1e-3) continue;
    ASSERT_TRUE(cloud.points.add(point[0], point[1], point[2]));
    if (least > 0) expected.push_back(point);
  }
  const int count = cloud.points.count;
  const int gone = leave_out_capsules(capsules, 0, cloud.points);
  EXPECT_EQ(cloud.all(), expected);
  EXPECT_EQ(gone, count - static_cast<int>(expected.size()));
  EXPECT_GT(gone, 20);
}

TEST(LeaveOutCapsules, LeavesWhatStandsBeforeTheFirst) {
  TestCloud cloud(3);
  for (const float x : {0.0f, 0.1f, 5.0f}) ASSERT_TRUE(cloud.points.add(x, 0, 0));
  const std::vector<ExclusionCapsule> ball = {{{0, 0, 0}, {0, 0, 0}, 1}};
  EXPECT_EQ(leave_out_capsules(ball, 1, cloud.points), 1);
  ASSERT_EQ(cloud.points.count, 2);
  EXPECT_EQ(cloud.points.x[0], 0.0f);
  EXPECT_EQ(cloud.points.x[1], 5.0f);
  EXPECT_EQ(leave_out_capsules(ball, 7, cloud.points), 0);
  EXPECT_EQ(cloud.points.count, 2);
}

TEST(LeaveOutCapsules, TakesNothingOffByWhatIsNoCapsule) {
  TestCloud cloud(2);
  ASSERT_TRUE(cloud.points.add(0, 0, 0));
  ASSERT_TRUE(cloud.points.add(std::nanf(""), 0, 0));
  const Vector3 zero = Vector3::Zero(), none(k_nan, 0, 0);
  const std::vector<ExclusionCapsule> wrong = {
      {zero, zero, 0}, {zero, zero, -1}, {zero, zero, k_nan}, {none, zero, 1}, {zero, none, 1}};
  EXPECT_EQ(leave_out_capsules(wrong, 0, cloud.points), 0);
  EXPECT_EQ(leave_out_capsules({}, 0, cloud.points), 0);
}

TEST(LeaveOutCapsules, LooksAtTheFirstOnesOnly) {
  TestCloud cloud(1);
  ASSERT_TRUE(cloud.points.add(0, 0, 0));
  std::vector<ExclusionCapsule> many(k_exclusion_capsules_max,
                                     {Vector3(9, 9, 9), Vector3(9, 9, 9), 1});
  many.push_back({Vector3::Zero(), Vector3::Zero(), 1});
  EXPECT_EQ(leave_out_capsules(many, 0, cloud.points), 0);
  EXPECT_EQ(leave_out_capsules(std::span(many).last(1), 0, cloud.points), 1);
}

TEST(LeaveOutCapsules, TakesOffAPointAtExactlyTheirRadius) {
  TestCloud cloud(5);
  const std::vector<ExclusionCapsule> line = {{{0, 0, 0}, {2, 0, 0}, 0.5}};
  const float beyond = std::nextafter(0.5f, 1.0f);
  for (const Point& p : std::vector<Point>{
           {1, 0.5f, 0}, {1, beyond, 0}, {-0.5f, 0, 0}, {-beyond, 0, 0}, {2.5f, 0, 0}}) {
    ASSERT_TRUE(cloud.points.add(p[0], p[1], p[2]));
  }
  EXPECT_EQ(leave_out_capsules(line, 0, cloud.points), 3);
  EXPECT_EQ(cloud.all(), (std::vector<Point>{{1, beyond, 0}, {-beyond, 0, 0}}));
}

// Position, normal and weight.
TEST(LeaveOutCapsules, MovesUpAllOfAPoint) {
  TestCloud cloud(3);
  PointCloud& points = cloud.points;
  for (const float x : {0.0f, 5.0f, 6.0f}) {
    const int i = points.count;
    ASSERT_TRUE(points.add(x, x + 1, x + 2, x + 3));
    points.normal_x[i] = x + 4, points.normal_y[i] = x + 5, points.normal_z[i] = x + 6;
  }
  const std::vector<ExclusionCapsule> ball = {{{0, 1, 2}, {0, 1, 2}, 1}};
  EXPECT_EQ(leave_out_capsules(ball, -7, points), 1) << "there is none before the first";
  ASSERT_EQ(points.count, 2);
  for (int i = 0; i < 2; ++i) {
    const float x = 5.0f + static_cast<float>(i);
    const Column<float>* columns[] = {&points.x,       &points.y,        &points.z,
                                      &points.weight,  &points.normal_x, &points.normal_y,
                                      &points.normal_z};
    for (int c = 0; c < 7; ++c) EXPECT_EQ((*columns[c])[i], x + static_cast<float>(c)) << c;
  }
}

TEST(LeaveOutCapsules, CountTheLastOneThatMayBe) {
  TestCloud cloud(1);
  ASSERT_TRUE(cloud.points.add(0, 0, 0));
  std::vector<ExclusionCapsule> many(k_exclusion_capsules_max - 1,
                                     {Vector3(9, 9, 9), Vector3(9, 9, 9), 1});
  many.push_back({Vector3::Zero(), Vector3::Zero(), 1});
  EXPECT_EQ(leave_out_capsules(many, 0, cloud.points), 1);
}

}  // namespace
}  // namespace glint

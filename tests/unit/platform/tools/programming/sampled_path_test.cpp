// Poses along the moves that a program writes: their distance from the known line and circle, and
// faults between the drawn points.
#include "platform/tools/programming/sampled_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"
#include "tests/unit/platform/tools/programming/arm_strokes.hpp"

namespace glint {
namespace {

using namespace test::arm_strokes;

constexpr double k_arc_radius_m = 0.05;

// An arc of 2.8 rad in the plane of `frame`, symmetrical about its x axis, with points every 20 mm.
// No point is at the middle: the circle passes the points next to it by 1 mm along x.
PathElement coarse_arc(const Pose& frame, const Quaternion& grip) {
  PathElement arc{PathKind::stroke, {}, "arc"};
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.4 * (i - 3.5);
    const Vector3 at = k_arc_radius_m * Vector3(std::cos(angle), std::sin(angle), 0);
    arc.points.push_back({Time{i}, {grip, frame * at}, Matrix6::Identity() * 1e-10});
  }
  return arc;
}

double largest_x(const PathElement& element) {
  double most = -1e9;
  for (const UncertainPose& point : element.points)
    most = std::max(most, point.pose.translation.x());
  return most;
}

TEST(SampledPath, LiesOnTheLineAndTheCircleAtTheDeclaredStep) {
  test::Random random(12);
  for (int n = 0; n < 40; ++n) {
    const Pose frame{random.rotation(), random.in_box(1)};
    PathElement stroke = coarse_arc(frame, random.rotation());
    // The arc's tangent goes on for 0.2 m.
    const Vector3 end = k_arc_radius_m * Vector3(std::cos(1.4), std::sin(1.4), 0);
    const Vector3 along(-std::sin(1.4), std::cos(1.4), 0);
    for (int i = 1; i <= 10; ++i) {
      UncertainPose point = stroke.points.front();
      point.pose.translation = frame * Vector3(end + 0.02 * i * along);
      stroke.points.push_back(point);
    }
    const MotionSteps steps{0.003, 0.05};
    const DrawnPath sampled = sampled_path({stroke}, SegmentSettings{}, steps);
    ASSERT_EQ(sampled.size(), 1u);
    const auto& points = sampled[0].points;
    EXPECT_GT(points.size(), 110u);
    const Pose back = frame.inverse();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 local = back * points[i].pose.translation;
      const double off_circle = std::hypot(local.head<2>().norm() - k_arc_radius_m, local.z());
      const Vector3 from_end = local - end;
      const double off_line = (from_end - from_end.dot(along) * along).norm();
      EXPECT_LT(std::min(off_circle, off_line), 2e-4) << n << ' ' << i;
      if (i == 0) continue;
      const double step_m = (points[i].pose.translation - points[i - 1].pose.translation).norm();
      EXPECT_LE(step_m, steps.distance_m + 1e-9);
      EXPECT_GT(step_m, 0.5 * steps.distance_m);
    }
    EXPECT_LT((points.back().pose.translation - stroke.points.back().pose.translation).norm(),
              1e-4);
  }
}

TEST(SampledPath, KeepsWaypointsAndRefusesTooManySteps) {
  const PathElement start{PathKind::waypoint, {point_at(Pose{})}, "start"};
  const DrawnPath path{start, coarse_arc({}, Quaternion::Identity())};
  const DrawnPath sampled = sampled_path(path, {}, {});
  EXPECT_EQ(sampled[0].points.size(), 1u);
  EXPECT_EQ(sampled[0].name, "start");
  EXPECT_EQ(sampled[1].kind, PathKind::stroke);
  EXPECT_THROW((void)sampled_path(path, {}, {1e-6, 0.05}), InputError);
}

// The workspace ends between the drawn points' largest x and the circle's.
TEST(SampledPath, FindsAnArcThatLeavesTheWorkspaceBetweenItsDrawnPoints) {
  const Arm arm;
  const Robot robot(arm);
  const Pose tip = Arm::forward({0.2, 0.6, 1.2, 0.3, 0.8, 0.2});
  const DrawnPath path{coarse_arc(
      {Quaternion::Identity(), tip.translation - Vector3(k_arc_radius_m, 0, 0)}, tip.rotation)};
  const DrawnPath sampled = sampled_path(path, SegmentSettings{}, MotionSteps{});
  EXPECT_NEAR(largest_x(sampled[0]) - largest_x(path[0]), 0.001, 2e-4);
  PathCheckSettings settings;
  settings.workspace_m = {-2, -2, -2, largest_x(path[0]) + 5e-4, 2, 2};
  EXPECT_TRUE(check_reach(path, robot.chain, settings).empty());
  const std::vector<ReachFailure> failures = check_reach(sampled, robot.chain, settings);
  ASSERT_FALSE(failures.empty());
  for (const ReachFailure& one : failures)
    EXPECT_EQ(one.fault, ReachFault::outside_workspace) << failure_text(sampled, one);
  EXPECT_LT(failures.size(), sampled[0].points.size() / 2);
}

}  // namespace
}  // namespace glint

#include "platform/lab/baseline/baseline_match.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "painted_frame.hpp"

namespace glint::baseline_match_test {
namespace {

std::vector<Vector3> placed(const Tool& tool, const Pose& pose) {
  std::vector<Vector3> points;
  for (int i = 0; i < tool.marker_count; ++i)
    points.push_back(pose * tool.markers_m[static_cast<std::size_t>(i)]);
  return points;
}

const Pose k_pose = turned(0.4, -0.3, 1.1, {0.05, -0.02, 0.5});

TEST(SeedMatch, FindsTheToolAmongStrays) {
  const Tool tool = small_tool();
  std::vector<Vector3> points = {{0.2, 0.1, 0.6}, {-0.1, 0.1, 0.4}};
  for (const Vector3& point : placed(tool, k_pose)) points.insert(points.begin() + 1, point);
  const BaselineMatch match = match_tool(points, tool, {});
  ASSERT_EQ(match.reason, Reason::none);
  EXPECT_EQ(match.count, 5);
  EXPECT_LT(match.rms_m, 1e-12);
  EXPECT_LT((match.T_camera_tool.translation - k_pose.translation).norm(), 1e-12);
  EXPECT_LT(match.T_camera_tool.rotation.angularDistance(k_pose.rotation), 1e-7);
  EXPECT_EQ(match.point[0], 5);  // inserted in reverse order
}

TEST(SeedMatch, IsContentWithThreeOfTheMarkers) {
  const Tool tool = small_tool();
  std::vector<Vector3> points = placed(tool, k_pose);
  points.erase(points.begin() + 1, points.begin() + 3);
  const BaselineMatch match = match_tool(points, tool, {});
  ASSERT_EQ(match.reason, Reason::none);
  EXPECT_EQ(match.count, 3);
  EXPECT_EQ(match.point[1], -1);
  EXPECT_LT((match.T_camera_tool * tool.tip_m - k_pose * tool.tip_m).norm(), 1e-9);
}

TEST(SeedMatch, RefusesTheMirrorImage) {
  Tool tool = small_tool();
  std::vector<Vector3> points = placed(tool, k_pose);
  for (Vector3& point : points) point.x() = -point.x();
  BaselineSettings settings;
  settings.min_markers = 5;  // any three points match their mirror image
  EXPECT_EQ(match_tool(points, tool, settings).reason, Reason::bad_fit);
}

TEST(SeedMatch, SaysWhyThereIsNone) {
  const Tool tool = small_tool();
  std::vector<Vector3> points = placed(tool, k_pose);
  EXPECT_EQ(match_tool(std::span(points).first(2), tool, {}).reason, Reason::too_few_markers);
  for (Vector3& point : points) point *= 2;
  EXPECT_EQ(match_tool(points, tool, {}).reason, Reason::no_labeling);
}

TEST(SeedMatch, FitsFlatSetsWithARotationNeverAReflection) {
  Tool tool = small_tool();
  for (Vector3& marker : tool.markers_m) marker.z() = 0;
  ASSERT_EQ(prepare_tool(tool), Reason::none);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = turned(0.5 * i, 0.3 * i, 0.2 * i, {0.01, 0.02, 0.5});
    const BaselineMatch match = match_tool(placed(tool, pose), tool, {});
    ASSERT_EQ(match.reason, Reason::none) << i;
    EXPECT_LT(match.T_camera_tool.rotation.angularDistance(pose.rotation), 1e-6) << i;
  }
}

TEST(SeedMatch, GivesNoPointToTwoMarkers) {
  Tool tool = small_tool();
  tool.markers_m[4] = tool.markers_m[0] + Vector3(0, 0, 0.004);  // closer than delta
  ASSERT_EQ(prepare_tool(tool), Reason::none);
  std::vector<Vector3> points = placed(tool, k_pose);
  points.pop_back();
  EXPECT_EQ(match_tool(points, tool, {}).count, 4);
}

TEST(SeedMatch, StopsAtItsBudget) {
  const Tool tool = small_tool();
  std::vector<Vector3> points;
  for (int i = 0; i < 12; ++i)
    points.push_back(Vector3(0.03 * (i % 4), 0.03 * (i / 4), 0.5 + 0.01 * (i % 3)));
  BaselineSettings settings;
  settings.delta_m = 0.05;
  settings.max_rms_m = 1;
  EXPECT_GT(match_tool(points, tool, settings).hypotheses, 50);
  settings.hypotheses_max = 50;
  EXPECT_EQ(match_tool(points, tool, settings).hypotheses, 50);
}

}  // namespace
}  // namespace glint::baseline_match_test

#include "kernels/cloud/snap_to_planes.hpp"

#include "oriented_clouds.hpp"

namespace glint::snap_to_planes_test {
namespace {

TEST(SnapToPlanes, MakesTheirPointsFlatAndMovesNoOther) {
  const std::vector<PointWithNormal> points = scene_points(2);
  TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points);
  for (int at = 0; at < cloud.points.count;)
    at = snap_to_planes(test.search, test.support, at, 7, cloud.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t on = test.support.plane_of(static_cast<int>(i));
    const Point now = cloud.at(static_cast<int>(i));
    const double moved = std::sqrt(squared_distance(now, points[i].point));
    if (on == PlaneSearch::k_no_plane) {
      ASSERT_EQ(moved, 0);
      continue;
    }
    ASSERT_LE(moved, 0.010001);
    const Plane& plane = test.search.plane(on);
    const Vector3 place(static_cast<double>(now[0]), static_cast<double>(now[1]),
                        static_cast<double>(now[2]));
    ASSERT_NEAR(plane.normal.dot(place), plane.offset_m, 2e-7);
    ASSERT_EQ(cloud.points.normal_z[static_cast<int>(i)], static_cast<float>(plane.normal.z()));
  }
}

// A point keeps its component along the plane and receives the plane's normal.
TEST(SnapToPlanes, MovesAlongTheNormalAndGivesItToThePoint) {
  const std::vector<PointWithNormal> points = scene_points(3);
  TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points);
  EXPECT_EQ(snap_to_planes(test.search, test.support, 0, 1 << 20, cloud.points),
            cloud.points.count);
  int moved = 0;
  for (int i = 0; i < cloud.points.count; ++i) {
    const PointWithNormal& before = points[static_cast<std::size_t>(i)];
    const Point normal{cloud.points.normal_x[i], cloud.points.normal_y[i],
                       cloud.points.normal_z[i]};
    const std::uint8_t on = test.support.plane_of(i);
    if (on == PlaneSearch::k_no_plane) {
      ASSERT_EQ(normal, before.normal);
      ASSERT_EQ(cloud.at(i), before.point);
      continue;
    }
    const Vector3& n = test.search.plane(on).normal;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(normal[k], static_cast<float>(n[static_cast<Eigen::Index>(k)]));
    }
    const Point now = cloud.at(i);
    const Vector3 way(static_cast<double>(now[0]) - static_cast<double>(before.point[0]),
                      static_cast<double>(now[1]) - static_cast<double>(before.point[1]),
                      static_cast<double>(now[2]) - static_cast<double>(before.point[2]));
    ASSERT_LT(way.cross(n).norm(), 2e-7);
    ++moved;
  }
  EXPECT_GT(moved, 8'000);
}

TEST(SnapToPlanes, LooksAtThePointsThatItIsAskedTo) {
  const std::vector<PointWithNormal> points = scene_points(4);
  TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points);
  for (const int most : {0, -4}) {
    EXPECT_EQ(snap_to_planes(test.search, test.support, 10, most, cloud.points), 10);
  }
  EXPECT_EQ(snap_to_planes(test.search, test.support, 10, 5, cloud.points), 15);
  for (int i = 0; i < 30; ++i) {
    const bool on = test.support.plane_of(i) != PlaneSearch::k_no_plane;
    const bool same = cloud.at(i) == points[static_cast<std::size_t>(i)].point;
    EXPECT_EQ(same, !on || i < 10 || i >= 15) << i;
  }
}

}  // namespace
}  // namespace glint::snap_to_planes_test

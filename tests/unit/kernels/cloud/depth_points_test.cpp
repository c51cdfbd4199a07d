#include "kernels/cloud/depth_points.hpp"

#include <cmath>

#include "clouds.hpp"

namespace glint {
namespace {

CameraModel small_pinhole() {
  CameraModel camera;
  camera.width = 8, camera.height = 6;
  camera.fx = camera.fy = 10, camera.cx = 4, camera.cy = 3;
  return camera;
}

std::vector<Point> points_of(const std::vector<float>& depth, const DepthPointSettings& settings,
                             const Pose& pose, int slice, int room, int& dropped) {
  const DepthPicture picture{8, 6, depth};
  TestCloud cloud(room);
  for (int at = 0; at < pixels_of(picture, settings.stride);) {
    at = add_depth_points(picture, small_pinhole(), pose, settings, at, slice, cloud.points,
                          dropped);
  }
  return cloud.all();
}

TEST(DepthPoints, StandWhereThePinholePutsThem) {
  std::vector<float> depth(48, 0.0f);
  depth[2 * 8 + 7] = 2.0f;  // pixel centre (7.5, 2.5): 3.5 right of the axis, 0.5 above
  int dropped = 0;
  const std::vector<Point> axis = points_of(depth, {}, {}, 100, 10, dropped);
  ASSERT_EQ(axis.size(), 1u);
  EXPECT_FLOAT_EQ(axis[0][0], 0.7f);
  EXPECT_FLOAT_EQ(axis[0][1], -0.1f);
  EXPECT_FLOAT_EQ(axis[0][2], 2.0f);
  DepthPointSettings radial;
  radial.along = DepthAlong::ray;
  const std::vector<Point> ray = points_of(depth, radial, {}, 100, 10, dropped);
  ASSERT_EQ(ray.size(), 1u);
  EXPECT_NEAR(std::sqrt(squared_distance(ray[0], {0, 0, 0})), 2.0, 1e-6);
  Pose pose;
  pose.translation = Vector3(1, 2, 3);
  pose.rotation = Quaternion(0, 0, 0, 1);  // half a turn about z
  const std::vector<Point> moved = points_of(depth, {}, pose, 100, 10, dropped);
  EXPECT_FLOAT_EQ(moved[0][0], 1 - 0.7f);
  EXPECT_FLOAT_EQ(moved[0][1], 2 + 0.1f);
  EXPECT_FLOAT_EQ(moved[0][2], 5.0f);
}

TEST(DepthPoints, AreTheSameInSlicesAndEveryStridethPixel) {
  std::vector<float> depth;
  for (int i = 0; i < 48; ++i) depth.push_back(0.5f + 0.01f * static_cast<float>(i));
  DepthPointSettings third;
  third.stride = 3;
  int dropped = 0;
  const std::vector<Point> whole = points_of(depth, third, {}, 100, 100, dropped);
  EXPECT_EQ(whole.size(), 6u);
  EXPECT_FLOAT_EQ(whole[1][2], depth[3]);
  EXPECT_FLOAT_EQ(whole[3][2], depth[24]);
  EXPECT_EQ(points_of(depth, third, {}, 1, 100, dropped), whole);
}

TEST(DepthPoints, LeaveOutWhatIsNoDepthAndCountWhatDoesNotFit) {
  std::vector<float> depth(48, 1.0f);
  depth[0] = k_not_a_number;
  depth[1] = 0;
  depth[2] = -1;
  depth[3] = 1e9f;
  int dropped = 0;
  EXPECT_EQ(points_of(depth, {}, {}, 5, 40, dropped).size(), 40u);
  EXPECT_EQ(dropped, 4);
}

}  // namespace
}  // namespace glint

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
  const DepthImageView picture{8, 6, depth};
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
  pose.rotation = Quaternion(0, 0, 0, 1);  // 180 degrees about z
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

TEST(DepthPoints, NumberThePixelsThatAStrideTakes) {
  const struct {
    int width, height, stride, pixels;
  } cases[] = {{8, 6, 1, 48}, {8, 6, 2, 12}, {8, 6, 3, 6}, {8, 6, 4, 4},
               {8, 6, 8, 1},  {9, 7, 8, 2},  {9, 9, 8, 4}, {0, 6, 1, 0}};
  for (const auto& [width, height, stride, pixels] : cases) {
    EXPECT_EQ(pixels_of({width, height, {}}, stride), pixels) << width << ' ' << stride;
  }
}

// Every point is on the ray of its own pixel, for any stride and slice size.
TEST(DepthPoints, StandOnTheRaysOfTheirPixels) {
  const std::vector<float> depth(48, 2.0f);
  for (const int stride : {1, 2, 3, 5}) {
    DepthPointSettings settings;
    settings.stride = stride;
    int dropped = 0;
    std::vector<Point> expected;
    for (int v = 0; v < 6; v += stride) {
      for (int u = 0; u < 8; u += stride) {
        expected.push_back({2 * (static_cast<float>(u) - 3.5f) / 10,
                            2 * (static_cast<float>(v) - 2.5f) / 10, 2.0f});
      }
    }
    const std::vector<Point> found = points_of(depth, settings, {}, 4, 48, dropped);
    ASSERT_EQ(found.size(), expected.size()) << stride;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_LT(squared_distance(found[i], expected[i]), 1e-12) << stride << ' ' << i;
    }
    EXPECT_EQ(dropped, 0);
  }
}

TEST(DepthPoints, AreTakenAtBothLimitsAndNotBeyond) {
  const DepthPointSettings settings;
  const float near = settings.depth_min_m, far = settings.depth_max_m;
  std::vector<float> depth(48, 0.0f);
  depth[0] = near, depth[1] = far;
  depth[2] = std::nextafter(near, 0.0f), depth[3] = std::nextafter(far, 9.0f);
  int dropped = 0;
  const std::vector<Point> points = points_of(depth, settings, {}, 48, 48, dropped);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_FLOAT_EQ(points[0][2], near);
  EXPECT_FLOAT_EQ(points[1][2], far);
}

TEST(DepthPoints, LeaveOutPixelsWithoutARay) {
  const std::vector<float> depth(48, 1.0f);
  CameraModel camera = small_pinhole();
  camera.fx = 1e-3;  // a ray is valid only if |x / z| is below 1,000
  camera.cx = 3.5;
  TestCloud cloud(48);
  int dropped = 0;
  const DepthImageView picture{8, 6, depth};
  EXPECT_EQ(add_depth_points(picture, camera, {}, {}, 0, 100, cloud.points, dropped), 48);
  EXPECT_EQ(cloud.points.count, 6);  // the column of the optical axis
  for (const Point& point : cloud.all()) EXPECT_EQ(point[0], 0);
}

TEST(DepthPoints, LookAtNoPixelWhereNoneIsAskedFor) {
  const std::vector<float> depth(48, 1.0f);
  TestCloud cloud(48);
  int dropped = 0;
  for (const int most : {0, -3}) {
    EXPECT_EQ(
        add_depth_points({8, 6, depth}, small_pinhole(), {}, {}, 5, most, cloud.points, dropped),
        5);
  }
  EXPECT_EQ(cloud.points.count, 0);
}

}  // namespace
}  // namespace glint

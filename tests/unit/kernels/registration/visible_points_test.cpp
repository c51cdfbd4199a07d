#include "kernels/registration/visible_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/kernels/registration/wall_depth_buffers.hpp"

namespace glint::visible_points_test {
namespace {

using test::DepthBuffers;
using test::k_wall;
using test::k_wall_faces;

struct SeenPointsRun {
  DepthBuffers picture;
  std::vector<Vector3f> corners = k_wall;
  std::vector<Face> faces = k_wall_faces;
  std::vector<VisiblePoint> points = std::vector<VisiblePoint>(64 * 48 + 1);
  int count = 0;

  int look(int step, const Pose& pose = {}) {
    SceneView view;
    view.camera = picture.camera;
    view.model = {corners, faces};
    const auto pixels = static_cast<std::size_t>(view.camera.width * view.camera.height);
    // Entries behind the image's end would be visible points if they were read.
    picture.z.assign(pixels + 64, 1), picture.face.assign(pixels + 64, 0);
    count = visible_points(view, pose, step,
                           {std::span(picture.z).first(pixels),
                            std::span(picture.face).first(pixels), picture.corners},
                           points);
    return count;
  }
};

TEST(SeenPoints, AreNoMoreThanThereIsRoomFor) {
  DepthBuffers picture;
  SceneView view;
  view.camera = picture.camera;
  view.model = {k_wall, k_wall_faces};
  const DepthBuffer buffer{picture.z, picture.face, picture.corners};
  std::vector<VisiblePoint> all(64 * 48);
  const int count = visible_points(view, {}, 4, buffer, all);
  EXPECT_GT(count, 100);
  std::vector<VisiblePoint> few(50);
  few[40].pixel = -7;
  EXPECT_EQ(visible_points(view, {}, 4, buffer, std::span(few).first(40)), 40);
  EXPECT_EQ(few[40].pixel, -7);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(few[i].pixel, all[i].pixel);
}

// Also where a step ends at the image's edge.
TEST(SeenPoints, AreThePixelsOfTheRasterInTheirOrder) {
  for (const int step : {1, 2, 3, 4, 7, 31, 32, 47, 95, 96, 200}) {
    SeenPointsRun seen;
    seen.corners = {{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}};
    std::vector<int> expected;
    for (int y = step / 2; y < 48; y += step) {
      for (int x = step / 2; x < 64; x += step) expected.push_back(y * 64 + x);
    }
    ASSERT_EQ(seen.look(step), static_cast<int>(expected.size())) << step;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(seen.points[i].pixel, expected[i]);
    }
  }
  for (const int step : {0, -1}) EXPECT_EQ(SeenPointsRun().look(step), 0);
}

TEST(SeenPoints, LieOnTheModelAndHaveItsNormalsTowardsTheCamera) {
  const Pose pose{Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, -2, 0.5).normalized())),
                  {0.1, -0.2, 0.6}};
  const Vector3f up = (k_wall[1] - k_wall[0]).cross(k_wall[3] - k_wall[0]).normalized();
  const Vector3 normal = pose.rotation * up.cast<double>();
  const double offset = normal.dot(pose * k_wall[0].cast<double>());
  const Vector3 towards = offset > 0 ? Vector3(-normal) : normal;
  for (const bool turned : {false, true}) {
    SeenPointsRun seen;
    if (turned) seen.faces = {{0, 2, 1}, {0, 3, 2}};
    ASSERT_GT(seen.look(2, pose), 200);
    for (int i = 0; i < seen.count; ++i) {
      const VisiblePoint& point = seen.points[static_cast<std::size_t>(i)];
      const Vector3 p = point.point.cast<double>();
      ASSERT_LT((point.normal.cast<double>() - towards).norm(), 2e-6);
      ASSERT_NEAR(normal.dot(p), offset, 1e-5);
      ASSERT_NEAR(60 * p.x() / p.z() + 32, point.pixel % 64 + 0.5, 1e-3);
      ASSERT_NEAR(60 * p.y() / p.z() + 24, point.pixel / 64 + 0.5, 1e-3);
    }
  }
}

// At such a long focal length the face covers pixels, but its cross product underflows to zero.
TEST(SeenPoints, LeaveOutAFaceTooSmallForANormal) {
  SeenPointsRun seen;
  seen.corners = {{-1e-25f, -1e-25f, 1}, {1e-25f, -1e-25f, 1}, {0, 1e-25f, 1}};
  seen.faces = {{0, 1, 2}};
  seen.picture.camera.fx = seen.picture.camera.fy = 2e26;
  EXPECT_EQ(seen.look(1), 0);
  int drawn = 0;
  for (std::size_t i = 0; i < 64 * 48; ++i) drawn += seen.picture.face[i] >= 0 ? 1 : 0;
  EXPECT_GT(drawn, 200);
}

TEST(SeenPoints, AreNoneWhereTheModelIsNotRendered) {
  SeenPointsRun seen;
  seen.faces = {{0, 1, 4}};
  EXPECT_EQ(seen.look(1), 0);
}

}  // namespace
}  // namespace glint::visible_points_test

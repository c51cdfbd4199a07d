#include "kernels/registration/render_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <limits>
#include <vector>

#include "kernels/registration/seen_points.hpp"

namespace glint::render_depth_test {
namespace {

struct Picture {
  Pinhole camera{64, 48, 60, 60, 32, 24};
  std::vector<float> z = std::vector<float>(64 * 48);
  std::vector<std::int32_t> face = std::vector<std::int32_t>(64 * 48);
  std::vector<ProjectedCorner> corners = std::vector<ProjectedCorner>(64);

  Reason render(const std::vector<Vector3f>& points, const std::vector<Face>& faces,
                const Pose& pose = {}) {
    return render_depth({points, faces}, pose, camera, {z, face, corners});
  }
  [[nodiscard]] std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * 64 + x); }
};

// A wall that leans: z = 1 + x / 2.
const std::vector<Vector3f> k_wall = {{-1, -2, 0.5f}, {1, -2, 1.5f}, {1, 2, 1.5f}, {-1, 2, 0.5f}};
const std::vector<Face> k_two = {{0, 1, 2}, {0, 2, 3}};

TEST(RenderDepth, GivesAPlanesDepthAtEachPixelsCentre) {
  Picture picture;
  ASSERT_EQ(picture.render(k_wall, k_two), Reason::none);
  for (const int x : {5, 20, 32, 50}) {
    const double slope = (x + 0.5 - 32) / 60;  // x / z along the ray
    EXPECT_NEAR(picture.z[picture.at(x, 10)], 1 / (1 - 0.5 * slope), 1e-6) << x;
  }
}

TEST(RenderDepth, LeavesNoSeamAndNoHoleBetweenNeighbours) {
  Picture picture;
  ASSERT_EQ(picture.render(k_wall, k_two), Reason::none);
  for (int y = 2; y < 46; ++y) {
    for (int x = 2; x < 60; ++x) EXPECT_GE(picture.face[picture.at(x, y)], 0) << x << " " << y;
  }
}

TEST(RenderDepth, CoversThePixelsWhoseCentresLieOnItsOutline) {
  Picture picture;
  picture.camera.fx = picture.camera.fy = 64;
  // From 10.5 to 18.5 across and from 8.5 to 16.5 down; an area that divides without rounding.
  const float left = -21.5f / 64, right = -13.5f / 64, top = -15.5f / 64, bottom = -7.5f / 64;
  ASSERT_EQ(picture.render({{left, top, 1}, {right, top, 1}, {right, bottom, 1}, {left, bottom, 1}},
                           {{0, 1, 2}, {0, 2, 3}}),
            Reason::none);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool inside = x >= 10 && x <= 18 && y >= 8 && y <= 16;
      EXPECT_EQ(picture.face[picture.at(x, y)] >= 0, inside) << x << " " << y;
    }
  }
}

TEST(RenderDepth, KeepsWhatIsNearerWhicheverCameFirst) {
  std::vector<Vector3f> points = {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2},
                                  {-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};
  for (const std::vector<Face>& faces :
       {std::vector<Face>{{0, 1, 2}, {3, 4, 5}}, std::vector<Face>{{3, 4, 5}, {0, 1, 2}}}) {
    Picture picture;
    ASSERT_EQ(picture.render(points, faces), Reason::none);
    EXPECT_FLOAT_EQ(picture.z[picture.at(32, 20)], 1);
    EXPECT_EQ(picture.face[picture.at(32, 20)], faces[0].a == 0 ? 1 : 0);
  }
}

// Its pixels are more than an integer can number.
TEST(RenderDepth, LeavesOutWhatLiesFarBesideThePicture) {
  for (const float far : {1e12f, -1e12f}) {
    Picture picture;
    ASSERT_EQ(picture.render({{far, -1, 1}, {2 * far, -1, 1}, {far, 1, 1}}, {{0, 1, 2}}),
              Reason::none);
    for (const std::int32_t face : picture.face) EXPECT_EQ(face, -1);
  }
}

TEST(RenderDepth, LeavesOutWhatIsBehindOrNotANumber) {
  Picture picture;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_EQ(
      picture.render({{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {-1, -1, 1}, {1, -1, nan}, {0, 1, 1}},
                     {{0, 1, 2}, {3, 4, 5}}),
      Reason::none);
  for (const std::int32_t face : picture.face) EXPECT_EQ(face, -1);
}

TEST(RenderDepth, RefusesWrongSizesAndFacesWithoutCorners) {
  Picture picture;
  EXPECT_EQ(picture.render(k_wall, {{0, 1, 4}}), Reason::out_of_range);
  EXPECT_EQ(picture.render(k_wall, {{0, -1, 2}}), Reason::out_of_range);
  picture.z.pop_back();
  EXPECT_EQ(picture.render(k_wall, k_two), Reason::out_of_range);
}

TEST(RenderDepth, EndsAfterItsBudgetOfTests) {
  Picture picture;
  const std::vector<Face> many(5000, Face{0, 1, 2});
  EXPECT_EQ(picture.render(k_wall, many), Reason::search_full);
  EXPECT_GT(picture.z[picture.at(50, 10)], 0);
}

TEST(SeenPoints, AreNoMoreThanThereIsRoomFor) {
  Picture picture;
  SceneView view;
  view.camera = picture.camera;
  view.model = {k_wall, k_two};
  const DepthBuffer buffer{picture.z, picture.face, picture.corners};
  std::vector<SeenPoint> all(64 * 48);
  const int count = seen_points(view, {}, 4, buffer, all);
  EXPECT_GT(count, 100);
  std::vector<SeenPoint> few(50);
  few[40].pixel = -7;
  EXPECT_EQ(seen_points(view, {}, 4, buffer, std::span(few).first(40)), 40);
  EXPECT_EQ(few[40].pixel, -7);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(few[i].pixel, all[i].pixel);
}

// Far beyond what an integer holds, on each side.
TEST(RenderDepth, DrawsNothingOfATriangleFarOutsideThePicture) {
  for (const float far : {1e11f, -1e11f}) {
    Picture picture;
    const float more = 2 * far;
    EXPECT_EQ(picture.render({{far, -1, 1}, {more, -1, 1}, {more, 1, 1}}, {{0, 1, 2}}),
              Reason::none);
    EXPECT_EQ(picture.render({{-1, far, 1}, {-1, more, 1}, {1, more, 1}}, {{0, 1, 2}}),
              Reason::none);
    for (const std::int32_t face : picture.face) ASSERT_LT(face, 0);
  }
}

}  // namespace
}  // namespace glint::render_depth_test

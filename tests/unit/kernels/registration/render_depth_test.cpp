#include "kernels/registration/render_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/unit/kernels/registration/wall_depth_buffers.hpp"

namespace glint::render_depth_test {
namespace {

using test::DepthBuffers;
using test::k_wall;
using test::k_wall_faces;

TEST(RenderDepth, GivesAPlanesDepthAtEachPixelsCentre) {
  DepthBuffers picture;
  ASSERT_EQ(picture.render(k_wall, k_wall_faces), Reason::none);
  for (const int x : {5, 20, 32, 50}) {
    const double slope = (x + 0.5 - 32) / 60;  // x / z along the ray
    EXPECT_NEAR(picture.z[picture.at(x, 10)], 1 / (1 - 0.5 * slope), 1e-6) << x;
  }
}

TEST(RenderDepth, LeavesNoSeamAndNoHoleBetweenNeighbours) {
  DepthBuffers picture;
  ASSERT_EQ(picture.render(k_wall, k_wall_faces), Reason::none);
  for (int y = 2; y < 46; ++y) {
    for (int x = 2; x < 60; ++x) EXPECT_GE(picture.face[picture.at(x, y)], 0) << x << " " << y;
  }
}

TEST(RenderDepth, CoversThePixelsWhoseCentresLieOnItsOutline) {
  DepthBuffers picture;
  picture.camera.fx = picture.camera.fy = 64;
  // Columns 10.5 to 18.5 and rows 8.5 to 16.5; the area divides without rounding.
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
    DepthBuffers picture;
    ASSERT_EQ(picture.render(points, faces), Reason::none);
    EXPECT_FLOAT_EQ(picture.z[picture.at(32, 20)], 1);
    EXPECT_EQ(picture.face[picture.at(32, 20)], faces[0].a == 0 ? 1 : 0);
  }
}

// Its pixel coordinates exceed the range of an integer.
TEST(RenderDepth, LeavesOutWhatLiesFarBesideThePicture) {
  for (const float far : {1e12f, -1e12f}) {
    DepthBuffers picture;
    ASSERT_EQ(picture.render({{far, -1, 1}, {2 * far, -1, 1}, {far, 1, 1}}, {{0, 1, 2}}),
              Reason::none);
    for (const std::int32_t face : picture.face) EXPECT_EQ(face, -1);
  }
}

TEST(RenderDepth, LeavesOutWhatIsBehindOrNotANumber) {
  DepthBuffers picture;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_EQ(
      picture.render({{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {-1, -1, 1}, {1, -1, nan}, {0, 1, 1}},
                     {{0, 1, 2}, {3, 4, 5}}),
      Reason::none);
  for (const std::int32_t face : picture.face) EXPECT_EQ(face, -1);
}

TEST(RenderDepth, RefusesWrongSizesAndFacesWithoutCorners) {
  DepthBuffers picture;
  EXPECT_EQ(picture.render(k_wall, {{0, 1, 4}}), Reason::out_of_range);
  EXPECT_EQ(picture.render(k_wall, {{0, -1, 2}}), Reason::out_of_range);
  picture.z.pop_back();
  EXPECT_EQ(picture.render(k_wall, k_wall_faces), Reason::out_of_range);
}

TEST(RenderDepth, EndsAfterItsBudgetOfTests) {
  DepthBuffers picture;
  const std::vector<Face> many(5000, Face{0, 1, 2});
  EXPECT_EQ(picture.render(k_wall, many), Reason::search_full);
  EXPECT_GT(picture.z[picture.at(50, 10)], 0);
}

// Far beyond the range of an integer, on each side.
TEST(RenderDepth, DrawsNothingOfATriangleFarOutsideThePicture) {
  for (const float far : {1e11f, -1e11f}) {
    DepthBuffers picture;
    const float more = 2 * far;
    EXPECT_EQ(picture.render({{far, -1, 1}, {more, -1, 1}, {more, 1, 1}}, {{0, 1, 2}}),
              Reason::none);
    EXPECT_EQ(picture.render({{-1, far, 1}, {-1, more, 1}, {1, more, 1}}, {{0, 1, 2}}),
              Reason::none);
    for (const std::int32_t face : picture.face) ASSERT_LT(face, 0);
  }
}

// Equal to a rendering of corners that were transformed before.
TEST(RenderDepth, TakesTheModelWhereItsPoseHasIt) {
  const Pose pose{Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, -2, 0.5).normalized())),
                  {0.1, -0.2, 0.6}};
  std::vector<Vector3f> moved;
  for (const Vector3f& corner : k_wall) {
    moved.emplace_back((pose * corner.cast<double>()).cast<float>());
  }
  DepthBuffers a, b;
  ASSERT_EQ(a.render(k_wall, k_wall_faces, pose), Reason::none);
  ASSERT_EQ(b.render(moved, k_wall_faces), Reason::none);
  int both = 0;
  for (std::size_t i = 0; i < a.z.size(); ++i) {
    if (a.face[i] < 0 || b.face[i] < 0) continue;
    EXPECT_NEAR(a.z[i], b.z[i], 1e-5);
    ++both;
  }
  EXPECT_GT(both, 500);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vector3 p = moved[i].cast<double>();
    EXPECT_NEAR(a.corners[i].u, 60 * p.x() / p.z() + 32, 1e-3);
    EXPECT_NEAR(a.corners[i].v, 60 * p.y() / p.z() + 24, 1e-3);
    EXPECT_NEAR(a.corners[i].inverse_z, 1 / p.z(), 1e-5);
  }
}

TEST(RenderDepth, SeesBothSidesOfAFaceAndKeepsTheFirstOfTwoInOnePlace) {
  const std::vector<Vector3f> points = {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
  for (const std::vector<Face>& faces : {std::vector<Face>{{0, 1, 2}}, std::vector<Face>{{0, 2, 1}},
                                         std::vector<Face>{{0, 1, 2}, {2, 1, 0}, {1, 2, 0}}}) {
    DepthBuffers picture;
    ASSERT_EQ(picture.render(points, faces), Reason::none);
    EXPECT_FLOAT_EQ(picture.z[picture.at(32, 20)], 2);
    EXPECT_EQ(picture.face[picture.at(32, 20)], 0);
    for (std::size_t i = 0; i < picture.z.size(); ++i) {
      EXPECT_EQ(picture.face[i] >= 0, picture.z[i] > 0);
      EXPECT_LE(picture.face[i], 0);
    }
  }
}

TEST(RenderDepth, LeavesOutAFaceWithAnyCornerThatIsNotAhead) {
  for (std::size_t behind = 0; behind < 4; ++behind) {
    std::vector<Vector3f> points = {{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};
    if (behind < 3) points[behind].z() = 0.04f;
    DepthBuffers picture;
    ASSERT_EQ(picture.render(points, {{0, 1, 2}}), Reason::none);
    int drawn = 0;
    for (const std::int32_t face : picture.face) drawn += face >= 0 ? 1 : 0;
    EXPECT_EQ(drawn > 0, behind == 3) << behind;
  }
}

// A face whose bounding box has 48 pixels: 256 tests a pixel are sufficient for 16,384 faces.
TEST(RenderDepth, DrawsWhatItsTestsSufficeForAndNoFaceMore) {
  const auto corner = [](int x, int y, float z) {
    return Vector3f((static_cast<float>(x) - 32) / 60 * z, (static_cast<float>(y) - 24) / 60 * z,
                    z);
  };
  // Columns 8 to 16 and rows 6 to 12; the last face is nearer.
  const std::vector<Vector3f> points = {corner(8, 6, 2), corner(16, 6, 2), corner(8, 12, 2),
                                        corner(8, 6, 1), corner(16, 6, 1), corner(8, 12, 1)};
  constexpr int k_faces = 64 * 48 * k_render_tests_per_pixel / 48;
  for (const int faces : {k_faces, k_faces + 1}) {
    std::vector<Face> many(static_cast<std::size_t>(faces), Face{0, 1, 2});
    many.back() = {3, 4, 5};
    DepthBuffers picture;
    EXPECT_EQ(picture.render(points, many), faces == k_faces ? Reason::none : Reason::search_full);
    EXPECT_EQ(picture.face[picture.at(9, 7)], faces == k_faces ? faces - 1 : 0);
  }
}

TEST(RenderDepth, TakesEachSizeAtItsLimitAndRefusesItBeyond) {
  std::vector<float> z(13);
  std::vector<std::int32_t> face(13);
  std::vector<ProjectedCorner> corners(5);
  std::vector<Face> faces = {{0, 1, 2}};
  const auto reason = [&](int width, int height, std::size_t zs, std::size_t numbers,
                          std::size_t corner_count) {
    return render_depth({k_wall, faces}, {}, {width, height, 2, 2, 2, 1},
                        {std::span(z).first(zs), std::span(face).first(numbers),
                         std::span(corners).first(corner_count)});
  };
  EXPECT_EQ(reason(4, 3, 12, 12, 4), Reason::none);
  EXPECT_EQ(reason(4, 3, 12, 12, 5), Reason::none);
  EXPECT_EQ(reason(4, 3, 12, 12, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 11, 11, 4), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 13, 13, 4), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 12, 11, 4), Reason::out_of_range);
  EXPECT_EQ(reason(0, 3, 0, 0, 4), Reason::out_of_range);
  EXPECT_EQ(reason(4, 0, 0, 0, 4), Reason::out_of_range);
  EXPECT_EQ(reason(-4, -3, 12, 12, 4), Reason::out_of_range);
  EXPECT_EQ(reason(1, 1, 1, 1, 4), Reason::none);
  for (const std::int32_t wrong : {-1, 4}) {
    for (const Face& with : {Face{wrong, 1, 2}, Face{0, wrong, 2}, Face{0, 1, wrong}}) {
      faces = {with};
      EXPECT_EQ(reason(4, 3, 12, 12, 5), Reason::out_of_range) << wrong;
    }
  }
}

}  // namespace
}  // namespace glint::render_depth_test

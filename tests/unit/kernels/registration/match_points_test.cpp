// Single point pairs: residual and gradient of each matching, and the conditions for a pair.
#include "kernels/registration/match_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace glint::match_points_test {
namespace {

constexpr int k_width = 32, k_height = 24;

// An image of constant depth, and the scene's points.
struct Scene {
  Pinhole camera{k_width, k_height, 64, 64, 16, 12};
  std::vector<float> depth;
  std::vector<std::uint8_t> mask;
  std::vector<Vector3f> points;
  PointGrid grid;
  double gate_m = 0.25;
  Pose T_moved;
  Quaternion turn = Quaternion::Identity();
  Vector3 centroid = Vector3::Zero();

  explicit Scene(float depth_m, const std::vector<Vector3f>& of_points = {})
      : depth(k_width * k_height, depth_m), points(of_points) {
    EXPECT_EQ(grid.prepare(8), Reason::none);
    EXPECT_EQ(grid.build(points, gate_m), Reason::none);
  }
  [[nodiscard]] AlignmentSums pairs(Matching matching, const Vector3f& point,
                                    const Vector3f& normal) const {
    const VisiblePoint seen{point, normal, 0};
    AlignmentSums sums;
    add_pairs({&seen, 1}, T_moved, matching, gate_m, {camera, depth, mask, {}, {}}, {&grid, points},
              turn, centroid, sums);
    return sums;
  }
  [[nodiscard]] int count(Matching matching, const Vector3f& point,
                          const Vector3f& normal = {0, 0, -1}) const {
    return pairs(matching, point, normal).count;
  }
};

// Translation and rotation of a small motion, in the frame of the sums.
const Vector3 k_shift(1e-6, -2e-6, 3e-6), k_turn(4e-6, 1e-6, -2e-6);

// A point of the camera's frame after that motion about the scene's `centroid`.
Vector3 moved_point(const Scene& scene, const Vector3& p) {
  const Vector3 shift = scene.turn.conjugate() * k_shift, turn = scene.turn.conjugate() * k_turn;
  return p + shift + turn.cross(p - scene.centroid);
}

Scene tilted_frame(float depth_m, const std::vector<Vector3f>& points = {}) {
  Scene scene(depth_m, points);
  scene.turn = Quaternion(Eigen::AngleAxisd(0.8, Vector3(1, 2, -1).normalized()));
  scene.centroid = Vector3(0.2, -0.1, 1.7);
  return scene;
}

// Residual along the pixel's ray: how far the model's plane is behind the scene.
TEST(MatchPoints, ProjectivePairsPullAlongTheRayToTheModelsPlane) {
  const Scene scene = tilted_frame(2.1f);
  const Vector3f point(0.3f, 0.2f, 2.0f);
  const Vector3f normal = Vector3f(0.5f, -0.3f, -0.8f).normalized();
  const AlignmentSums sums = scene.pairs(Matching::projective, point, normal);
  ASSERT_EQ(sums.count, 1);
  const Vector3 p = point.cast<double>(), n = normal.cast<double>();
  const Vector3 ray = p.normalized();
  const double residual = p.norm() - static_cast<double>(2.1f) / ray.z();
  EXPECT_NEAR(sums.squares, residual * residual, 1e-12);
  // Reference change of the residual: the ray's intersection with the moved plane.
  const Vector3 moved_normal = n + (scene.turn.conjugate() * k_turn).cross(n);
  const double met = moved_normal.dot(moved_point(scene, p)) / moved_normal.dot(ray);
  const Vector6 derivative = sums.slope / residual;
  const double change = derivative.head<3>().dot(k_shift) + derivative.tail<3>().dot(k_turn);
  EXPECT_NEAR(change, met - p.norm(), 1e-10);
  EXPECT_GT(std::abs(change), 1e-6);
}

TEST(MatchPoints, PlanePairsPullAlongTheModelsNormal) {
  const Vector3f other(0.27f, 0.23f, 2.04f), point(0.3f, 0.2f, 2.0f);
  const Scene scene = tilted_frame(2.1f, {{1, 1, 1}, other});
  const Vector3f normal = Vector3f(0.5f, -0.3f, -0.8f).normalized();
  const AlignmentSums sums = scene.pairs(Matching::plane, point, normal);
  ASSERT_EQ(sums.count, 1);
  const Vector3 p = point.cast<double>(), n = normal.cast<double>();
  const double residual = n.dot(p - other.cast<double>());
  EXPECT_NEAR(sums.squares, residual * residual, 1e-15);
  const Vector6 derivative = sums.slope / residual;
  const double change = derivative.head<3>().dot(k_shift) + derivative.tail<3>().dot(k_turn);
  EXPECT_NEAR(change, n.dot(moved_point(scene, p) - p), 1e-14);
}

TEST(MatchPoints, PointPairsPullAlongAllAxes) {
  const Vector3f other(0.27f, 0.23f, 2.04f), point(0.3f, 0.2f, 2.0f);
  const Scene scene = tilted_frame(2.1f, {{1, 1, 1}, other});
  const AlignmentSums sums = scene.pairs(Matching::point, point, {0, 0, -1});
  ASSERT_EQ(sums.count, 3);
  const Vector3 p = point.cast<double>(), apart = p - other.cast<double>();
  EXPECT_NEAR(sums.squares, apart.squaredNorm(), 1e-15);
  EXPECT_LT((sums.slope.head<3>() - scene.turn * apart).norm(), 1e-15);
  // The slope is the gradient of half the sum of squares.
  const Vector3 after = moved_point(scene, p) - other.cast<double>();
  const double change = sums.slope.head<3>().dot(k_shift) + sums.slope.tail<3>().dot(k_turn);
  EXPECT_NEAR(change, (after.squaredNorm() - apart.squaredNorm()) / 2, 1e-10);
}

// Equal to the pairs of points seen at their moved positions.
TEST(MatchPoints, TakesPointsAndNormalsWhereTheModelMovedTo) {
  const Vector3f other(0.27f, 0.23f, 2.04f);
  for (const Matching matching : {Matching::point, Matching::plane, Matching::projective}) {
    Scene still = tilted_frame(2.1f, {other}), moved = tilted_frame(2.1f, {other});
    // 90 degrees about z: (x, y) becomes (-y, x).
    moved.T_moved = {Quaternion(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ())), {0.5, 0.25, -0.5}};
    const AlignmentSums a = still.pairs(matching, {0.25f, 0.1875f, 2}, {0.6f, 0, -0.8f});
    const AlignmentSums b = moved.pairs(matching, {-0.0625f, 0.25f, 2.5f}, {0, -0.6f, -0.8f});
    ASSERT_GT(a.count, 0);
    EXPECT_EQ(a.count, b.count);
    EXPECT_NEAR(a.squares, b.squares, 1e-12);
    EXPECT_LT((a.slope - b.slope).norm(), 1e-12);
    EXPECT_LT((a.matrix - b.matrix).norm(), 1e-12);
  }
}

TEST(MatchPoints, ProjectivePairsAreAtMostTheGateApart) {
  const Vector3f ahead(0.01f, 0.01f, 2);
  const auto count = [&](float depth) { return Scene(depth).count(Matching::projective, ahead); };
  EXPECT_EQ(count(1.75f), 1);
  EXPECT_EQ(count(std::nextafter(1.75f, 0.0f)), 0);
  EXPECT_EQ(count(2.25f), 1);
  EXPECT_EQ(count(std::nextafter(2.25f, 3.0f)), 0);
  for (const float none : {0.0f, -2.0f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(count(none), 0) << none;
  }
  Scene wide(0.0f);
  wide.gate_m = 5;
  EXPECT_EQ(wide.count(Matching::projective, ahead), 0) << "not measured, however wide the gate";
  Scene masked(2.0f);
  masked.mask.assign(masked.depth.size(), 1);
  EXPECT_EQ(masked.count(Matching::projective, ahead), 1);
  masked.mask.assign(masked.depth.size(), 0);
  EXPECT_EQ(masked.count(Matching::projective, ahead), 0);
}

TEST(MatchPoints, ProjectivePairsNeedASurfaceThatFacesTheCamera) {
  const Scene scene(2.0f);
  const Vector3f ahead(0, 0, 2);
  const auto least = static_cast<float>(k_cosine_min);
  EXPECT_EQ(scene.count(Matching::projective, ahead, {0.98f, 0, -least}), 1);
  EXPECT_EQ(scene.count(Matching::projective, ahead, {0.98f, 0, -0.1999f}), 0);
  EXPECT_EQ(scene.count(Matching::projective, ahead, {0, 0, 1}), 0);
}

// A pixel contains its left and upper boundary but not the other two; so does the image.
TEST(MatchPoints, ProjectivePairsAreOfThePixelInWhichAPointLies) {
  const auto pixel_of = [](const Vector3f& point) {
    Scene scene(0.0f);
    for (std::size_t i = 0; i < scene.depth.size(); ++i) {
      scene.depth[i] = point.z();
      const int count = scene.count(Matching::projective, point);
      scene.depth[i] = 0;
      if (count > 0) return static_cast<int>(i);
    }
    return -1;
  };
  const float z = 2;
  EXPECT_EQ(pixel_of({0, 0, z}), 12 * k_width + 16);
  EXPECT_EQ(pixel_of({-1e-3f, 0, z}), 12 * k_width + 15);
  EXPECT_EQ(pixel_of({0, -1e-3f, z}), 11 * k_width + 16);
  EXPECT_EQ(pixel_of({-0.5f, 0, z}), 12 * k_width);
  EXPECT_EQ(pixel_of({std::nextafter(-0.5f, -1.0f), 0, z}), -1);
  EXPECT_EQ(pixel_of({std::nextafter(0.5f, 0.0f), 0, z}), 12 * k_width + 31);
  EXPECT_EQ(pixel_of({0.5f, 0, z}), -1);
  EXPECT_EQ(pixel_of({0, -0.375f, z}), 16);
  EXPECT_EQ(pixel_of({0, std::nextafter(-0.375f, -1.0f), z}), -1);
  EXPECT_EQ(pixel_of({0, std::nextafter(0.375f, 0.0f), z}), 23 * k_width + 16);
  EXPECT_EQ(pixel_of({0, 0.375f, z}), -1);
  EXPECT_EQ(pixel_of({-0.5f, -0.375f, z}), 0);
  EXPECT_EQ(pixel_of({0, 0, 0.04f}), -1) << "nearer than anything is rendered";
}

TEST(MatchPoints, NearestPairsLeaveOutWhatIsHiddenByMoreThanTheGate) {
  for (const Matching matching : {Matching::plane, Matching::point}) {
    const int all = matching == Matching::plane ? 1 : 3;
    const auto count = [&](float depth, const Vector3f& point = {0.01f, 0.01f, 2}) {
      return Scene(depth, {point + Vector3f(0.05f, 0, 0)}).count(matching, point);
    };
    EXPECT_EQ(count(2.0f), all);
    EXPECT_EQ(count(1.75f), all);
    EXPECT_EQ(count(std::nextafter(1.75f, 0.0f)), 0);
    EXPECT_EQ(count(5.0f), all) << "what is behind hides nothing";
    EXPECT_EQ(count(0.0f), all) << "nor what was not measured";
    EXPECT_EQ(count(1.0f, {3, 0, 2}), all) << "nor what is outside of the picture";
    EXPECT_EQ(Scene(2.0f, {{0.3f, 0, 2}}).count(matching, {0, 0, 2}), 0) << "too far";
    EXPECT_EQ(Scene(2.0f).count(matching, {0, 0, 2}), 0) << "there is none";
  }
}

}  // namespace
}  // namespace glint::match_points_test

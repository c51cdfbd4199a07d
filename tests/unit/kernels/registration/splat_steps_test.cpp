// Splatting of a point cloud: step counts, and discs and visible pixels compared with plain loops.
#include "kernels/registration/splat_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace glint::splat_steps_test {
namespace {

constexpr int k_side = 16;

struct Splat {
  Pinhole camera{k_side, k_side, 10, 10, k_side / 2, k_side / 2};
  std::vector<Vector3f> points, normals;
  float spacing_m = 0.1f;
  int raster = 0;  // no visible points are gathered
  std::vector<float> z;
  std::vector<std::int32_t> number;
  std::vector<ProjectedCorner> corners;
  std::vector<VisiblePoint> seen;
  CloudSplat run;
  int calls = 0;

  // Points whose normals face the camera.
  explicit Splat(const std::vector<Vector3f>& of_points = {}) : points(of_points) {
    normals.assign(points.size(), Vector3f(0, 0, -1));
  }
  [[nodiscard]] Reason start(std::size_t capacity = 1'000) {
    const auto pixels = static_cast<std::size_t>(camera.width * camera.height);
    z.assign(pixels, -1), number.assign(pixels, 77);
    corners.assign(points.size(), ProjectedCorner{9, 9, 9});
    seen.assign(capacity + 1, VisiblePoint{{}, {}, -7});
    calls = 0;
    return run.start({points, normals, spacing_m}, {}, camera, raster, {z, number, corners},
                     std::span(seen).first(capacity));
  }
  // Sum of the steps of all calls.
  int steps(int budget = SliceSize::k_steps_max, std::size_t capacity = 1'000) {
    EXPECT_EQ(start(capacity), Reason::none);
    int sum = 0;
    for (bool done = false; !done; ++calls) {
      StepBudget left(budget);
      done = run.step(left);
      sum += budget - left.left();
      EXPECT_LT(budget - left.left(), budget + k_splat_item_steps_max + k_splat_visible_steps);
    }
    return sum;
  }
  [[nodiscard]] int drawn() const {
    int count = 0;
    for (const std::int32_t n : number) count += n >= 0 ? 1 : 0;
    return count;
  }
};

// Clearing in one call.
constexpr int k_clear_steps = 1 + k_side * k_side / k_splat_cleared_per_step;

int steps_of_tests(int reach) { return (2 * reach + 1) * (2 * reach + 1) * k_splat_test_steps; }

TEST(SplatSteps, OfAPointAreThoseOfThePixelsThatItsDiscMayReach) {
  const struct {
    float spacing, z;
    double fx, fy;
    int reach;
  } cases[] = {{0, 1, 10, 10, 1},     {0.1f, 1, 10, 10, 2},  {0.2f, 1, 10, 10, 4},
               {0.2f, 2, 10, 10, 2},  {0.1f, 1, 10, 20, 4},  {0.1f, 1, 20, 10, 4},
               {0.33f, 1, 10, 10, 5}, {0.34f, 1, 10, 10, 6}, {100, 1, 10, 10, k_splat_reach}};
  for (const auto& c : cases) {
    Splat splat({Vector3f(0, 0, c.z)});
    splat.spacing_m = c.spacing;
    splat.camera.fx = c.fx, splat.camera.fy = c.fy;
    EXPECT_EQ(splat.steps(), k_clear_steps + k_splat_point_steps + steps_of_tests(c.reach))
        << c.spacing << ' ' << c.fx;
    EXPECT_EQ(splat.calls, 2);
  }
}

TEST(SplatSteps, AddUpInSlicesOfAnySize) {
  std::vector<Vector3f> points(20, Vector3f(0, 0, 1));
  for (int i = 0; i < 5; ++i) points.emplace_back(0.0f, 0.0f, -1.0f);
  Splat splat(points);
  splat.raster = 1;
  const int whole = splat.steps();
  const int drawn = splat.drawn();
  EXPECT_GT(drawn, 3);
  EXPECT_EQ(whole, k_clear_steps + 25 * k_splat_point_steps + 20 * steps_of_tests(2) +
                       k_side * k_side * k_splat_pixel_steps + drawn * k_splat_visible_steps);
  const int count = splat.run.count();
  for (const int budget : {1, 16, 100, 5'000}) {
    // Each call that clears takes one additional step.
    const int cleared = budget * k_splat_cleared_per_step;
    const int clears = (k_side * k_side + cleared - 1) / cleared;
    EXPECT_EQ(splat.steps(budget), whole + clears - 1) << budget;
    EXPECT_EQ(splat.run.count(), count);
    if (budget == 1) {
      EXPECT_EQ(splat.calls, clears + 25 + k_side * k_side) << "one at a time";
    }
  }
}

// Points outside the image are not tested if their discs do not reach into it.
TEST(SplatSteps, LeaveOutPointsWhoseDiscsEndBeforeThePicture) {
  const auto tests_of = [](float x, float y) {
    Splat splat({Vector3f(x, y, 1)});  // the disc reaches 2 pixels
    return (splat.steps() - k_clear_steps - k_splat_point_steps) / k_splat_test_steps;
  };
  EXPECT_EQ(tests_of(0, 0), 25);
  EXPECT_EQ(tests_of(-1, 0), 25) << "two pixels before the picture";
  EXPECT_EQ(tests_of(0, -1), 25);
  EXPECT_EQ(tests_of(std::nextafter(-1.0f, -2.0f), 0), 0);
  EXPECT_EQ(tests_of(0, std::nextafter(-1.0f, -2.0f)), 0);
  EXPECT_EQ(tests_of(std::nextafter(1.0f, 0.0f), 0), 25);
  EXPECT_EQ(tests_of(0, std::nextafter(1.0f, 0.0f)), 25);
  EXPECT_EQ(tests_of(1, 0), 0) << "two pixels behind it";
  EXPECT_EQ(tests_of(0, 1), 0);
}

TEST(SplatCloud, ProjectsEachPointThatLiesAhead) {
  Splat splat({{0.25f, -0.5f, 2}, {0.25f, -0.5f, -2}, {0, 0, 0.04f}, {-0.5f, 0.125f, 1}});
  splat.camera.fx = 12, splat.camera.cx = 7;
  (void)splat.steps();
  EXPECT_EQ(splat.corners[0].u, 12 * 0.125 + 7);
  EXPECT_EQ(splat.corners[0].v, 10 * -0.25 + 8);
  EXPECT_EQ(splat.corners[0].inverse_z, 0.5);
  for (const std::size_t behind : {1, 2}) {
    EXPECT_EQ(splat.corners[behind].u, 0);
    EXPECT_EQ(splat.corners[behind].v, 0);
    EXPECT_EQ(splat.corners[behind].inverse_z, 0);
  }
  EXPECT_EQ(splat.corners[3].u, 12 * -0.5 + 7);
  EXPECT_EQ(splat.corners[3].v, 10 * 0.125 + 8);
  EXPECT_EQ(splat.corners[3].inverse_z, 1);
}

// Reference: each disc in turn over the pixels around it, in double.
struct PlainPicture {
  std::vector<double> z;
  std::vector<std::int32_t> number;
  std::vector<bool> seen;
};
PlainPicture plain_picture(const Splat& splat) {
  const Pinhole& camera = splat.camera;
  const auto pixels = static_cast<std::size_t>(camera.width * camera.height);
  PlainPicture picture{std::vector<double>(pixels), std::vector<std::int32_t>(pixels, -1),
                       std::vector<bool>(pixels)};
  const double spacing = static_cast<double>(splat.spacing_m);
  for (std::size_t i = 0; i < splat.points.size(); ++i) {
    const Vector3 p = splat.points[i].cast<double>(), n = splat.normals[i].cast<double>();
    const Vector2 at(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
    const int reach =
        1 + static_cast<int>(std::min(1.5 * spacing * std::max(camera.fx, camera.fy) / p.z(), 5.0));
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        if (std::abs(x - static_cast<int>(at.x())) > reach) continue;
        if (std::abs(y - static_cast<int>(at.y())) > reach) continue;
        const Vector3 ray((x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy, 1);
        const double z = n.dot(p) / n.dot(ray), away = (z * ray - p).norm();
        if (!(z > k_render_near_m) || !(away <= 1.5 * spacing)) continue;
        const auto pixel = static_cast<std::size_t>(y * camera.width + x);
        const Vector2 middle(x + 0.5, y + 0.5);
        if (picture.number[pixel] >= 0) {
          const double had = picture.z[pixel];
          const auto other = static_cast<std::size_t>(picture.number[pixel]);
          const Vector2 there(splat.corners[other].u, splat.corners[other].v);
          const bool nearer = std::abs(z - had) > spacing
                                  ? z < had
                                  : (at - middle).norm() < (there - middle).norm();
          if (!nearer) continue;
        }
        picture.z[pixel] = z;
        picture.number[pixel] = static_cast<std::int32_t>(i);
        picture.seen[pixel] = away <= 0.75 * spacing;
      }
    }
  }
  return picture;
}

TEST(SplatCloud, IsThatOfPlainLoopsOverDiscsAndPixels) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(-1, 1);
    Splat splat;
    splat.camera = {40, 30, 40, 36, 19, 16};
    splat.spacing_m = 0.06f;
    splat.raster = 1;
    for (int i = 0; i < 250; ++i) {
      const float x = 0.5f * any(random), y = 0.4f * any(random);
      splat.points.emplace_back(x, y, 1 + 0.2f * any(random));
      const float nx = any(random), ny = any(random);
      splat.normals.push_back(Vector3f(nx, ny, any(random)).normalized());
    }
    (void)splat.steps(SliceSize::k_steps_max, 1'200);
    const PlainPicture plain = plain_picture(splat);
    int different = 0, drawn = 0;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < plain.number.size(); ++i) {
      drawn += plain.number[i] >= 0 ? 1 : 0;
      if (plain.seen[i]) seen.push_back(i);
      if (plain.number[i] != splat.number[i]) {
        ++different;  // rounding at a disc's edge
      } else if (plain.number[i] >= 0) {
        EXPECT_NEAR(splat.z[i], plain.z[i], 1e-4) << i;
      } else {
        EXPECT_EQ(splat.z[i], 0) << i;
      }
    }
    EXPECT_GT(drawn, 600);
    EXPECT_LE(different, 2) << seed;
    EXPECT_GT(seen.size(), 100u);
    EXPECT_NEAR(splat.run.count(), static_cast<int>(seen.size()), 2);
    if (splat.run.count() != static_cast<int>(seen.size())) continue;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const VisiblePoint& point = splat.seen[i];
      EXPECT_EQ(point.pixel, static_cast<int>(seen[i]));
      const Vector3f expected =
          pixel_point(splat.camera, point.pixel % 40, point.pixel / 40, splat.z[seen[i]]);
      EXPECT_LT((point.point - expected).norm(), 1e-6f);
      EXPECT_LT(point.normal.dot(point.point), 0);
      const Vector3f& normal = splat.normals[static_cast<std::size_t>(splat.number[seen[i]])];
      EXPECT_LT(normal.cross(point.normal).norm(), 1e-6f);
      EXPECT_NEAR(point.normal.norm(), 1, 1e-5);
    }
  }
}

// The pixel pitch is 1/8 m: the disc's radius is six pixels, that of its visible part three.
TEST(SplatCloud, DrawsAndSeesPixelsAtExactlyItsRadii) {
  Splat splat({Vector3f(0.0625f, 0.0625f, 1)});
  splat.camera.fx = splat.camera.fy = 8;
  splat.spacing_m = 0.5f;
  splat.raster = 1;
  (void)splat.steps();
  std::size_t seen = 0;
  for (int i = 0; i < k_side * k_side; ++i) {
    const int x = i % k_side - 8, y = i / k_side - 8;
    EXPECT_EQ(splat.number[static_cast<std::size_t>(i)] >= 0, x * x + y * y <= 36) << i;
    if (x * x + y * y > 9) continue;
    EXPECT_EQ(splat.seen[seen++].pixel, i);
  }
  EXPECT_EQ(splat.run.count(), static_cast<int>(seen));
}

// A call always makes progress, even if its budget is spent.
TEST(SplatCloud, ClearsWithoutABudget) {
  Splat splat({Vector3f(0, 0, 1)});
  ASSERT_EQ(splat.start(), Reason::none);
  for (int i = 0; i < k_side * k_side / k_splat_cleared_per_step; ++i) {
    EXPECT_EQ(splat.z.back(), -1);
    StepBudget spent(0);
    EXPECT_FALSE(splat.run.step(spent));
    EXPECT_EQ(spent.left(), -2);
  }
  for (const float z : splat.z) EXPECT_EQ(z, 0);
  EXPECT_EQ(splat.drawn(), 0);
}

TEST(SplatCloud, KeepsTheFirstOfDiscsInOnePlace) {
  Splat splat(std::vector<Vector3f>(3, Vector3f(0.02f, 0.01f, 1)));
  (void)splat.steps();
  EXPECT_GT(splat.drawn(), 3);
  for (const std::int32_t number : splat.number) EXPECT_LE(number, 0);
}

// One disc fills the image: every pixel of the raster is visible, and no other.
TEST(SplatCloud, GathersThePixelsOfTheRasterInTheirOrder) {
  for (const int raster : {-1, 0, 1, 2, 3, 5, 7, 9, 12, 19, 20, 21, 23, 24, 30}) {
    Splat splat({Vector3f(0, 0, 1)});
    splat.camera = {12, 10, 10, 10, 6, 6};
    splat.spacing_m = 100;
    splat.raster = raster;
    std::vector<int> expected;
    for (int y = raster / 2; raster > 0 && y < 10; y += raster) {
      for (int x = raster / 2; x < 12; x += raster) expected.push_back(y * 12 + x);
    }
    const auto all = expected.size();
    const int before = 1 + 120 / k_splat_cleared_per_step + k_splat_point_steps + steps_of_tests(6);
    for (const std::size_t capacity : {std::size_t{0}, std::size_t{1}, all, std::size_t{200}}) {
      const int steps = splat.steps(SliceSize::k_steps_max, capacity);
      const std::size_t count = std::min(capacity, all);
      ASSERT_EQ(splat.run.count(), static_cast<int>(count)) << raster;
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(splat.seen[i].pixel, expected[i]);
      EXPECT_EQ(splat.seen[capacity].pixel, -7) << "behind the room";
      // If the output is full, one more pixel is read.
      const int more = capacity > 0 && capacity < all ? k_splat_pixel_steps : 0;
      EXPECT_EQ(
          steps,
          before + static_cast<int>(count) * (k_splat_pixel_steps + k_splat_visible_steps) + more)
          << raster << ' ' << capacity;
    }
  }
}

// 12 x 12 pixels are sufficient for 4,096 points of nine tests each.
TEST(SplatCloud, DrawsWhatItsTestsSufficeForAndNoPointMore) {
  const Vector3f left(-0.35f, -0.35f, 1), right(0.35f, 0.35f, 1);
  for (const std::size_t points : {4'096, 4'097}) {
    Splat splat(std::vector<Vector3f>(points, left));
    splat.points.back() = right;
    splat.camera = {12, 12, 10, 10, 6, 6};
    splat.spacing_m = 0.01f;
    (void)splat.steps();
    const bool fits = points == 4'096;
    EXPECT_EQ(splat.run.reason(), fits ? Reason::none : Reason::search_full);
    EXPECT_EQ(splat.number[2 * 12 + 2], 0);
    EXPECT_EQ(splat.number[9 * 12 + 9], fits ? 4'095 : -1);
  }
}

TEST(SplatCloud, StartedAgainIsAsNew) {
  Splat splat(std::vector<Vector3f>(50, Vector3f(0, 0, 1)));
  splat.raster = 1;
  const int steps = splat.steps();
  const int count = splat.run.count();
  for (const int left_after : {1, 40, 60}) {
    EXPECT_EQ(splat.start(), Reason::none);
    for (int i = 0; i < left_after; ++i) {
      StepBudget budget(10);
      if (splat.run.step(budget)) break;
    }
    EXPECT_EQ(splat.steps(), steps);
    EXPECT_EQ(splat.run.count(), count);
  }
}

TEST(SplatCloud, TakesEachSizeAtItsLimitAndRefusesItBeyond) {
  std::vector<Vector3f> points(3, Vector3f(0, 0, 1)), normals(3, Vector3f(0, 0, -1));
  std::vector<float> z(13, 0);
  std::vector<std::int32_t> number(13);
  std::vector<ProjectedCorner> corners(4);
  std::vector<VisiblePoint> seen(20);
  const auto reason = [&](int width, int height, std::size_t zs, std::size_t numbers,
                          std::size_t corner_count, std::size_t normal_count) {
    CloudSplat run;
    const ModelCloud cloud{points, std::span(normals).first(normal_count), 0.1f};
    const Pinhole camera{width, height, 10, 10, 2, 2};
    const Reason found = run.start(cloud, {}, camera, 1,
                                   {std::span(z).first(zs), std::span(number).first(numbers),
                                    std::span(corners).first(corner_count)},
                                   seen);
    EXPECT_EQ(run.reason(), found);
    if (found == Reason::none) return found;
    StepBudget budget;
    EXPECT_TRUE(run.step(budget)) << "at once";
    EXPECT_EQ(budget.left(), SliceSize::k_steps_max);
    EXPECT_EQ(run.count(), 0);
    return found;
  };
  EXPECT_EQ(reason(4, 3, 12, 12, 3, 3), Reason::none);
  EXPECT_EQ(reason(4, 3, 12, 12, 4, 3), Reason::none);
  EXPECT_EQ(reason(1, 1, 1, 1, 3, 3), Reason::none);
  EXPECT_EQ(reason(4, 3, 11, 11, 3, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 13, 13, 3, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 12, 11, 3, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 12, 12, 2, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 3, 12, 12, 3, 2), Reason::out_of_range);
  EXPECT_EQ(reason(0, 3, 0, 0, 3, 3), Reason::out_of_range);
  EXPECT_EQ(reason(4, 0, 0, 0, 3, 3), Reason::out_of_range);
  EXPECT_EQ(reason(-4, -3, 12, 12, 3, 3), Reason::out_of_range);
  points.assign(k_model_points_max, Vector3f(0, 0, 1));
  normals = points;
  corners.resize(points.size());
  EXPECT_EQ(reason(4, 3, 12, 12, points.size(), points.size()), Reason::none);
  points.push_back(points[0]);
  normals = points;
  corners.resize(points.size());
  EXPECT_EQ(reason(4, 3, 12, 12, points.size(), points.size()), Reason::out_of_range);
  SceneView wrong;
  wrong.camera = {4, 3, 10, 10, 2, 2};
  wrong.cloud = {points, normals, 0.1f};
  EXPECT_EQ(visible_cloud_points(wrong, {}, 1, {std::span(z).first(12), number, corners}, seen), 0);
}

}  // namespace
}  // namespace glint::splat_steps_test

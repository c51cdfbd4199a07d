#include "kernels/cloud/local_surface.hpp"

#include "reference_surface.hpp"

namespace glint {
namespace {

constexpr float k_radius = 0.03f;

SurfacePoint surface_of(const std::vector<Point>& relative, std::vector<float> weights = {}) {
  weights.resize(relative.size(), 1);
  weights.resize(relative.size() + k_four_padding, 3);
  std::array<std::vector<float>, 3> columns;
  for (const Point& p : relative) {
    for (std::size_t i = 0; i < 3; ++i) columns[i].push_back(p[i]);
  }
  // The padding entries must not count as neighbours.
  for (auto& column : columns) column.resize(relative.size() + k_four_padding, 0.02f);
  // Entries behind the padding are not read.
  for (auto& column : columns) column.resize(column.size() + 4, k_not_a_number);
  weights.resize(weights.size() + 4, k_not_a_number);
  const Neighbours near{columns[0].data(), columns[1].data(), columns[2].data(), weights.data(),
                        static_cast<int>(relative.size())};
  return local_surface(near, k_radius);
}

std::vector<Point> noisy_patch(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> side(-0.021f, 0.021f), noise(-0.004f, 0.004f);
  std::vector<Point> points{{0, 0, 0}};
  while (static_cast<int>(points.size()) < count) {
    const float x = side(random), y = side(random);
    points.push_back({x, y, 0.3f * x + 5 * x * x - 4 * x * y + noise(random)});
  }
  return points;
}

TEST(LocalSurface, IsThatOfATextbookInDouble) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const std::vector<Point> near = noisy_patch(12 + static_cast<int>(seed % 40), seed);
    const SurfacePoint fast = surface_of(near);
    const ReferenceSurface plain =
        reference_surface({0, 0, 0}, near, static_cast<double>(k_radius));
    ASSERT_TRUE(fast.on_polynomial);
    ASSERT_LT((fast.offset_m - plain.point).norm(), 2e-6) << seed;
    ASSERT_GT(std::abs(fast.normal.dot(plain.normal)), 1 - 1e-7) << seed;
    ASSERT_GE(fast.normal.z(), 0);
  }
}

// For upright walls, the first non-zero component in the order z, y, x is positive.
TEST(LocalSurface, TurnsItsNormalByTheLastAxisThatIsNotZero) {
  for (const int axis : {0, 1}) {
    for (const float lean : {-1.0f, 0.0f, 1.0f}) {
      std::vector<Point> near;
      for (int i = 0; i < 25; ++i) {
        const float along = 0.004f * static_cast<float>(i % 5 - 2);
        const float up = 0.004f * static_cast<float>(i / 5 - 2);
        near.push_back({0, lean * along, up});
        near.back()[axis == 0 ? 1 : 0] = along;
        near.back()[static_cast<std::size_t>(axis)] = lean * along;
      }
      const Vector3 normal = surface_of(near).normal;
      EXPECT_NEAR(normal.z(), 0, 1e-6);
      const double decides = std::abs(normal.y()) > 1e-6 ? normal.y() : normal.x();
      EXPECT_TRUE(normal.z() != 0 || decides > 0) << axis << ' ' << lean;
    }
  }
}

TEST(LocalSurface, TakesANeighbourOfWeightThreeAsThreeNeighbours) {
  std::vector<Point> near = noisy_patch(15, 1), thrice = near;
  std::vector<float> weights(15, 1);
  for (const std::size_t i : {2, 5, 11}) {
    weights[i] = 3;
    thrice.push_back(near[i]);
    thrice.push_back(near[i]);
  }
  const SurfacePoint a = surface_of(near, weights), b = surface_of(thrice);
  EXPECT_LT((a.offset_m - b.offset_m).norm(), 2e-7);
  EXPECT_GT(a.normal.dot(b.normal), 1 - 1e-9);
  EXPECT_GT((a.offset_m - surface_of(near).offset_m).norm(), 1e-4);
}

TEST(LocalSurface, LiesOnASheetOfOrderTwoThatAllNeighboursLieOn) {
  std::vector<Point> near;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const float x = 0.005f * static_cast<float>(i), y = 0.005f * static_cast<float>(j);
      near.push_back({x, y, 4 * x * x + 3 * y * y});
    }
  }
  const SurfacePoint found = surface_of(near);
  EXPECT_TRUE(found.on_polynomial);
  EXPECT_LT(found.offset_m.norm(), 1e-7);
  EXPECT_GT(found.normal.z(), 1 - 1e-9);
}

TEST(LocalSurface, IsThePlaneForFewNeighboursAndForThoseOnALineOrInOnePlace) {
  const std::vector<Point> five{
      {0, 0, 0.01f}, {0.01f, 0, 0}, {-0.01f, 0, 0}, {0, 0.01f, 0}, {0, -0.01f, 0}};
  EXPECT_FALSE(surface_of(five).on_polynomial);
  EXPECT_NEAR(surface_of(five).offset_m.z(), 0.002, 1e-8);
  std::vector<Point> line;
  for (int i = -5; i <= 5; ++i) line.push_back({0.002f * static_cast<float>(i), 0, 0});
  EXPECT_FALSE(surface_of(line).on_polynomial);
  EXPECT_LT(surface_of(line).offset_m.norm(), 1e-8);
  const std::vector<Point> place(20, Point{0, 0, 0});
  EXPECT_FALSE(surface_of(place).on_polynomial);
  EXPECT_EQ(surface_of(place).offset_m.norm(), 0);
  EXPECT_NEAR(surface_of(place).normal.norm(), 1, 1e-12);
}

// Two rings, the inner one 20 mm below: the fitted polynomial is 36 mm below at their centre.
TEST(LocalSurface, IsThePlaneWhereTheSheetLiesFurtherAwayThanTheRadius) {
  std::vector<Point> rings;
  for (const auto& [x, y] : {std::array{1.0f, 0.0f}, {0.0f, 1.0f}, {0.6f, 0.8f}, {0.6f, -0.8f}}) {
    for (const float side : {1.0f, -1.0f}) {
      rings.push_back({0.02f * side * x, 0.02f * side * y, -0.02f});
      rings.push_back({0.03f * side * x, 0.03f * side * y, 0});
    }
  }
  EXPECT_FALSE(surface_of(rings).on_polynomial);
  EXPECT_NEAR(surface_of(rings).offset_m.z(), -0.01, 1e-6);
}

TEST(LocalSurface, NeverCarriesAPointFurtherThanTheRadius) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> side(-0.017f, 0.017f);
  for (int round = 0; round < 20'000; ++round) {
    std::vector<Point> near{{0, 0, 0}};
    for (int i = 0; i < 6; ++i) near.push_back({side(random), side(random), side(random)});
    const SurfacePoint found = surface_of(near);
    ASSERT_LE(found.offset_m.norm(), static_cast<double>(k_radius) * (1 + 1e-9));
    ASSERT_NEAR(found.normal.norm(), 1, 1e-9);
  }
}

// Five neighbours at height 0 on a circle, two at its centre. The polynomial passes through each of
// the five, and at the centre through the mean of the two weighted by exp(-d^2 / r^2).
TEST(LocalSurface, WeighsNeighboursByTheExponentialOfTheirSquaredDistance) {
  const double r = static_cast<double>(k_radius);
  for (const auto& [first, second] :
       {std::pair{1.0, 0.0}, std::pair{1.0, -0.2}, std::pair{-1.0, 0.1}, std::pair{-0.9, 0.4},
        std::pair{0.7, -0.8}}) {
    std::vector<Point> near{{0, 0, static_cast<float>(first * r)},
                            {0, 0, static_cast<float>(second * r)}};
    for (int i = 0; i < 5; ++i) {
      const double angle = 2 * M_PI * i / 5;
      near.push_back({static_cast<float>(0.8 * r * std::cos(angle)),
                      static_cast<float>(0.8 * r * std::sin(angle)), 0});
    }
    const double plane = (first + second) / 7;
    const double a = std::exp(-(first - plane) * (first - plane));
    const double b = std::exp(-(second - plane) * (second - plane));
    const SurfacePoint found = surface_of(near);
    ASSERT_TRUE(found.on_polynomial);
    EXPECT_NEAR(found.offset_m.z(), r * (a * first + b * second) / (a + b), 5e-8)
        << first << ' ' << second;
    EXPECT_LT(found.offset_m.head<2>().norm(), 1e-7);
    EXPECT_GT(found.normal.z(), 1 - 1e-9);
  }
}

TEST(LocalSurface, IsCurvedForAsManyNeighboursAsTheSheetHasCoefficientsAndForNoFewer) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<float> side(-0.02f, 0.02f);
  int curved = 0;
  for (int round = 0; round < 3'000; ++round) {
    std::vector<Point> near{{0, 0, 0}};
    for (int i = 0; i < 4; ++i) near.push_back({side(random), side(random), side(random)});
    ASSERT_FALSE(surface_of(near).on_polynomial) << round;
    near.push_back({side(random), side(random), side(random)});
    curved += surface_of(near).on_polynomial ? 1 : 0;
  }
  EXPECT_GT(curved, 1'000);
}

}  // namespace
}  // namespace glint

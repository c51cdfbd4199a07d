#include "kernels/cloud/planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "oriented_clouds.hpp"

namespace glint {
namespace {

TEST(Planes, OfAsManyPointsAsAskedForAreFoundAndOfOneLessAreNot) {
  const TestCloud cloud = cloud_of(tile(400, 20, 0.5f, {0, 0, 1}));
  for (const int points_min : {400, 401}) {
    PlaneSettings settings;
    settings.points_min = points_min;
    TestSearch test(1'000, settings);
    test.run(cloud.points);
    EXPECT_EQ(test.search.count(), points_min == 400 ? 1 : 0);
  }
}

TEST(Planes, CountTheStepsOfEveryPassAndTry) {
  // Every point's normal lies in the plane: every try fails.
  const TestCloud cloud = cloud_of(tile(600, 25, 0.5f, {1, 0, 0}));
  const auto steps_of = [&](const PlaneSettings& settings) {
    TestSearch test(1'000, settings);
    test.search.begin(cloud.points);
    int steps = 0;
    for (bool done = false; !done; steps += test.search.steps()) done = test.search.step(1 << 20);
    EXPECT_EQ(test.search.count(), 0);
    return steps;
  };
  PlaneSettings few, many;
  few.candidates_max = 100;
  many.candidates_max = 1'100;
  EXPECT_EQ(steps_of(many) - steps_of(few), 1'000 * k_plane_try_steps);
  EXPECT_GE(steps_of(few), 600 * (k_plane_list_steps + k_plane_draw_steps));
}

TEST(Planes, AreFoundLargestFirstAndFittedToTheirPoints) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TestCloud cloud = cloud_of(scene_points(seed));
    TestSearch test(20'000);
    test.run(cloud.points);
    ASSERT_EQ(test.search.count(), 2);
    const Plane& floor = test.search.plane(0);
    const Plane& wall = test.search.plane(1);
    EXPECT_GT(std::abs(floor.normal.z()), std::cos(0.1 * M_PI / 180));
    EXPECT_NEAR(std::abs(floor.offset_m), 0.5, 0.0002);
    EXPECT_GT(std::abs(wall.normal.x()), std::cos(0.1 * M_PI / 180));
    EXPECT_NEAR(std::abs(wall.offset_m), 1, 0.0003);
    EXPECT_GT(floor.points, 5'900);
    EXPECT_GT(wall.points, 2'900);
    EXPECT_NEAR(floor.rms_m, 0.003, 0.0003);
  }
}

TEST(Planes, TakeNoPointWhoseNormalStandsAcrossAndNoneBeyondTheThreshold) {
  const std::vector<PointWithNormal> points = scene_points(1);
  const TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points);
  int taken = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t on = test.search.plane_of(static_cast<int>(i));
    if (on == PlaneSearch::k_no_plane) continue;
    ++taken;
    const Plane& plane = test.search.plane(on);
    double along = 0, height = -plane.offset_m;
    for (std::size_t k = 0; k < 3; ++k) {
      const double n = plane.normal(static_cast<Eigen::Index>(k));
      along += n * static_cast<double>(points[i].normal[k]);
      height += n * static_cast<double>(points[i].point[k]);
    }
    ASSERT_GT(std::abs(along), std::cos(20.01 * M_PI / 180));
    ASSERT_LT(std::abs(height), 0.010001);
  }
  EXPECT_EQ(taken, test.search.plane(0).points + test.search.plane(1).points);
}

TEST(Planes, AreTheSameInSlices) {
  const TestCloud cloud = cloud_of(scene_points(3));
  TestSearch whole(20'000), sliced(20'000);
  whole.run(cloud.points);
  sliced.run(cloud.points, 37);
  ASSERT_EQ(whole.search.count(), sliced.search.count());
  for (int i = 0; i < whole.search.count(); ++i) {
    EXPECT_EQ(whole.search.plane(i).normal, sliced.search.plane(i).normal);
    EXPECT_EQ(whole.search.plane(i).points, sliced.search.plane(i).points);
  }
}

TEST(Planes, AreNotSeenInScatteredPointsOrInFewerThanAsked) {
  std::vector<PointWithNormal> points = scene_points(4);
  std::vector<PointWithNormal> scattered(points.begin() + 9'000, points.begin() + 10'500);
  TestSearch test(20'000);
  test.run(cloud_of(scattered).points);
  EXPECT_EQ(test.search.count(), 0);
  std::vector<PointWithNormal> floor(points.begin(), points.begin() + 480);
  test.run(cloud_of(floor).points);
  EXPECT_EQ(test.search.count(), 0);
  floor.assign(points.begin(), points.begin() + 600);
  test.run(cloud_of(floor).points);
  EXPECT_EQ(test.search.count(), 1);
}

TEST(Planes, AreNoneOfNothingNoNumbersOnePlaceALineOrPointsWithoutNormals) {
  TestSearch test(2'000);
  test.run(PointCloud{});
  EXPECT_EQ(test.search.count(), 0);
  const Point up{0, 0, 1};
  const auto count_of = [&](const std::vector<PointWithNormal>& points) {
    test.run(cloud_of(points).points);
    return test.search.count();
  };
  EXPECT_EQ(count_of({{{0, 0, 0}, up}}), 0);
  EXPECT_EQ(count_of(std::vector<PointWithNormal>(1'000, {{k_not_a_number, 0, 0}, up})), 0);
  EXPECT_EQ(count_of(std::vector<PointWithNormal>(1'000, {{1, 2, 3}, up})), 0);
  std::vector<PointWithNormal> line, bare;
  for (int i = 0; i < 1'000; ++i) {
    const float s = 0.001f * static_cast<float>(i);
    line.push_back({{s, 0, 0}, up});
    bare.push_back({{s, s * s, 0}, {0, 0, 0}});
  }
  EXPECT_EQ(count_of(line), 0);
  EXPECT_EQ(count_of(bare), 0);
}

TEST(Planes, OfACloudBeyondTheCapacityAreThoseOfItsFirstPointsAndItSaysSo) {
  TestCloud cloud = cloud_of(scene_points(5));
  TestSearch test(6'000);
  test.run(cloud.points);
  EXPECT_EQ(test.search.reason(), Reason::cloud_full);
  ASSERT_EQ(test.search.count(), 1);
  EXPECT_EQ(test.search.plane_of(6'000), PlaneSearch::k_no_plane);
}

TEST(Planes, EndWithAsManyAsMayBe) {
  PlaneSettings one;
  one.planes_max = 1;
  TestSearch test(20'000, one);
  test.run(cloud_of(scene_points(6)).points);
  EXPECT_EQ(test.search.count(), 1);
}

TEST(Planes, RefuseWhatTheyCannotWorkWith) {
  TestMemory memory(PlaneSearch::bytes(10));
  PlaneSearch search;
  PlaneSettings settings;
  settings.planes_max = k_planes_max + 1;
  EXPECT_EQ(search.prepare(settings, 10, memory.arena()), Reason::out_of_range);
  settings = {};
  settings.scored_max = 0;
  EXPECT_EQ(search.prepare(settings, 10, memory.arena()), Reason::out_of_range);
  settings.scored_max = 1;
  TestMemory own(PlaneSearch::bytes(10));
  EXPECT_EQ(PlaneSearch().prepare(settings, 10, own.arena()), Reason::none);
  settings = {};
  settings.gate.threshold_m = k_not_a_number;
  EXPECT_EQ(search.prepare(settings, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(search.prepare({}, 100'000, memory.arena()), Reason::not_prepared);
  EXPECT_EQ(search.reason(), Reason::not_prepared);
}

// Points exactly at the threshold and normals exactly at the angle, in symmetric pairs that do not
// move the plane.
TEST(Planes, TakeWhatIsExactlyAtTheGate) {
  const float height = 0.0078125f, beyond = std::nextafter(height, 1.0f);
  PlaneSettings settings;
  settings.points_min = 400;
  settings.gate.threshold_m = height;
  const float cosine = settings.gate.normal_cosine_min;
  std::vector<PointWithNormal> points = tile(400, 20, 0, {0, 0, 1});
  for (const float z : {height, -height, beyond, -beyond})
    points.push_back({{0.1f, 0.1f, z}, {0, 0, 1}});
  for (const float along : {cosine, -cosine, std::nextafter(cosine, 0.0f)}) {
    points.push_back({{0.1f, 0.1f, 0}, {0, 0.34f, along}});
  }
  TestSearch test(410, settings);
  test.run(cloud_of(points).points);
  ASSERT_EQ(test.search.count(), 1);
  EXPECT_EQ(test.search.plane(0).points, 404);
  for (int i = 400; i < 407; ++i) {
    const bool on = i < 402 || i == 404 || i == 405;
    EXPECT_EQ(test.search.plane_of(i), on ? 0 : PlaneSearch::k_no_plane) << i;
  }
}

// All normals along one coordinate axis.
TEST(Planes, AreFoundAcrossEachAxis) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<PointWithNormal> points = tile(600, 25, 0.5f, {0, 0, 1});
    for (PointWithNormal& p : points) {
      std::swap(p.point[axis], p.point[2]);
      std::swap(p.normal[axis], p.normal[2]);
    }
    TestSearch test(600);
    test.run(cloud_of(points).points);
    ASSERT_EQ(test.search.count(), 1) << axis;
    const Plane& plane = test.search.plane(0);
    EXPECT_NEAR(std::abs(plane.normal[static_cast<Eigen::Index>(axis)]), 1, 1e-12);
    EXPECT_NEAR(plane.offset_m / plane.normal[static_cast<Eigen::Index>(axis)], 0.5, 1e-9);
    EXPECT_EQ(plane.points, 600);
  }
}

// Reference: the smallest principal axis of the points.
TEST(Planes, AreTheLeastSquaresOfTheirPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> noise(-0.004f, 0.004f);
  std::vector<PointWithNormal> points = tile(900, 30, 0, {0, 0, 1});
  Vector3 mean = Vector3::Zero();
  std::vector<Vector3> places;
  for (PointWithNormal& p : points) {
    p.point = {p.point[0] + 0.7f, p.point[1] - 0.4f, 1.5f + 0.2f * p.point[0] + noise(random)};
    places.emplace_back(static_cast<double>(p.point[0]), static_cast<double>(p.point[1]),
                        static_cast<double>(p.point[2]));
    mean += places.back() / 900;
  }
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& p : places) covariance += (p - mean) * (p - mean).transpose() / 900;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  Vector3 normal = solver.eigenvectors().col(0);
  TestSearch test(900);
  test.run(cloud_of(points).points);
  ASSERT_EQ(test.search.count(), 1);
  const Plane& plane = test.search.plane(0);
  ASSERT_EQ(plane.points, 900);
  if (normal.dot(plane.normal) < 0) normal = -normal;
  EXPECT_LT((plane.normal - normal).norm(), 1e-9);
  EXPECT_NEAR(plane.offset_m, normal.dot(mean), 1e-9);
  EXPECT_NEAR(plane.rms_m, std::sqrt(solver.eigenvalues()(0)), 1e-9);
}

// 50 further points are on no plane.
TEST(Planes, WithTooFewOfTheFreePointsAreNone) {
  std::vector<PointWithNormal> points = tile(400, 20, 0.5f, {0, 0, 1});
  for (const PointWithNormal& p : tile(50, 50, 0.9f, {0, 1, 0})) points.push_back(p);
  for (const int points_min : {400, 401}) {
    PlaneSettings settings;
    settings.points_min = points_min;
    TestSearch test(450, settings);
    test.run(cloud_of(points).points);
    EXPECT_EQ(test.search.count(), points_min == 400 ? 1 : 0);
  }
}

TEST(Planes, AreAsManyAsAskedForOfMore) {
  std::vector<PointWithNormal> points;
  for (const float z : {0.0f, 1.0f, 2.0f}) {
    for (const PointWithNormal& p : tile(200, 20, z, {0, 0, 1})) points.push_back(p);
  }
  for (const int planes_max : {0, 1, 2, 3, k_planes_max}) {
    PlaneSettings settings;
    settings.points_min = 100;
    settings.planes_max = planes_max;
    TestSearch test(600, settings);
    test.run(cloud_of(points).points);
    EXPECT_EQ(test.search.count(), std::min(planes_max, 3));
    if (planes_max > 0) continue;
    test.search.begin(cloud_of(points).points);
    EXPECT_TRUE(test.search.step(1));
    EXPECT_EQ(test.search.steps(), 0);
  }
}

TEST(Planes, BegunAgainAreThoseOfANewSearch) {
  const TestCloud before = cloud_of(scene_points(1)), cloud = cloud_of(scene_points(2));
  TestSearch used(11'000), fresh(11'000);
  for (const int calls : {3, 1'000'000}) {  // interrupted, and complete
    used.search.begin(before.points);
    for (int i = 0; i < calls && !used.search.step(500); ++i) {
    }
    used.run(cloud.points);
    fresh.run(cloud.points);
    ASSERT_EQ(used.search.count(), fresh.search.count());
    for (int i = 0; i < used.search.count(); ++i) {
      EXPECT_EQ(used.search.plane(i).normal, fresh.search.plane(i).normal);
      EXPECT_EQ(used.search.plane(i).offset_m, fresh.search.plane(i).offset_m);
      EXPECT_EQ(used.search.plane(i).rms_m, fresh.search.plane(i).rms_m);
      EXPECT_EQ(used.search.plane(i).points, fresh.search.plane(i).points);
    }
    for (int i = 0; i < cloud.points.count; ++i) {
      ASSERT_EQ(used.search.plane_of(i), fresh.search.plane_of(i));
    }
  }
}

TEST(Planes, OfACloudOfExactlyTheCapacityAreThoseOfAll) {
  const TestCloud cloud = cloud_of(tile(600, 25, 0.5f, {0, 0, 1}));
  TestSearch exact(600), less(599);
  exact.run(cloud.points);
  EXPECT_EQ(exact.search.reason(), Reason::none);
  EXPECT_EQ(exact.search.plane_of(599), 0);
  less.run(cloud.points);
  EXPECT_EQ(less.search.reason(), Reason::cloud_full);
  EXPECT_EQ(less.search.plane_of(598), 0);
  EXPECT_EQ(less.search.plane_of(599), PlaneSearch::k_no_plane);
}

TEST(Planes, TakeEachSettingAtItsLimitAndRefuseItBeyond) {
  const auto reason_of = [](auto change, int points = 10) {
    TestMemory memory(PlaneSearch::bytes(10));
    PlaneSettings settings;
    change(settings);
    PlaneSearch search;
    const Reason reason = search.prepare(settings, points, memory.arena());
    EXPECT_EQ(search.reason(), reason == Reason::none ? reason : Reason::not_prepared);
    EXPECT_EQ(search.count(), 0);
    EXPECT_EQ(search.plane_of(0), PlaneSearch::k_no_plane);
    EXPECT_TRUE(search.step(1)) << "nothing has begun";
    return reason;
  };
  constexpr Reason none = Reason::none, out = Reason::out_of_range;
  using S = PlaneSettings;
  const auto as_is = [](S&) {};
  EXPECT_EQ(reason_of([](S& s) { s.planes_max = 0; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.planes_max = -1; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.planes_max = k_planes_max; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.planes_max = k_planes_max + 1; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.points_min = 3; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.points_min = 2; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.candidates_max = 1; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.candidates_max = 0; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.scored_max = 1; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.scored_max = 0; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.gate.threshold_m = 1e-30f; }), none);
  EXPECT_EQ(reason_of([](S& s) { s.gate.threshold_m = 0; }), out);
  EXPECT_EQ(reason_of([](S& s) { s.gate.threshold_m = INFINITY; }), out);
  for (const float cosine : {-1.0f, 0.0f, 1.0f}) {
    EXPECT_EQ(reason_of([&](S& s) { s.gate.normal_cosine_min = cosine; }), none);
  }
  for (const float cosine : {-1.01f, 1.01f, k_not_a_number}) {
    EXPECT_EQ(reason_of([&](S& s) { s.gate.normal_cosine_min = cosine; }), out);
  }
  EXPECT_EQ(reason_of(as_is, 1), none);
  EXPECT_EQ(reason_of(as_is, 0), out);
  EXPECT_EQ(reason_of(as_is, k_cloud_points_max), Reason::not_prepared);
  EXPECT_EQ(reason_of(as_is, k_cloud_points_max + 1), out);
  ExactMemory enough(PlaneSearch::bytes(10)), less(PlaneSearch::bytes(10) - 1);
  EXPECT_EQ(PlaneSearch().prepare({}, 10, enough.arena()), none);
  EXPECT_EQ(PlaneSearch().prepare({}, 10, less.arena()), Reason::not_prepared);
}

// prepare() interrupts a search.
TEST(Planes, PreparedAnewAreNoneUntilTheSearchBegins) {
  const TestCloud cloud = cloud_of(scene_points(1));
  for (const bool refused : {false, true}) {
    TestSearch used(11'000);
    used.run(cloud.points);
    EXPECT_EQ(used.search.count(), 2);
    used.search.begin(cloud.points);
    for (int i = 0; i < 60; ++i) EXPECT_FALSE(used.search.step(500));
    PlaneSettings settings;
    settings.candidates_max = refused ? 0 : 1;
    TestMemory memory(PlaneSearch::bytes(11'000));
    EXPECT_EQ(used.search.prepare(settings, 11'000, memory.arena()),
              refused ? Reason::out_of_range : Reason::none);
    EXPECT_TRUE(used.search.step(500));
    EXPECT_EQ(used.search.steps(), 0);
    EXPECT_EQ(used.search.reason(), refused ? Reason::not_prepared : Reason::none);
    if (refused) continue;
    EXPECT_EQ(used.search.count(), 0);
    EXPECT_EQ(used.search.plane_of(0), PlaneSearch::k_no_plane);
  }
}

}  // namespace
}  // namespace glint

#include "kernels/cloud/planes.hpp"

#include <algorithm>
#include <cmath>

#include "clouds.hpp"
#include "kernels/cloud/snap_to_planes.hpp"

namespace glint {
namespace {

struct Oriented {
  Point point;
  Point normal;
};

TestCloud cloud_of(const std::vector<Oriented>& points) {
  TestCloud cloud(static_cast<int>(points.size()));
  for (const Oriented& p : points) {
    const int i = cloud.points.count;
    EXPECT_TRUE(cloud.points.add(p.point[0], p.point[1], p.point[2]));
    cloud.points.normal_x[i] = p.normal[0];
    cloud.points.normal_y[i] = p.normal[1];
    cloud.points.normal_z[i] = p.normal[2];
  }
  return cloud;
}

struct TestSearch {
  explicit TestSearch(int points, PlaneSettings settings = {})
      : memory(PlaneSearch::bytes(points) + PlaneSupport::bytes(points)) {
    EXPECT_EQ(search.prepare(settings, points, memory.arena()), Reason::none);
    PlaneSupportSettings wide;  // the test's floors are sparse
    wide.radius_m = 0.2f;
    EXPECT_EQ(support.prepare(wide, points, memory.arena()), Reason::none);
  }
  void run(const PointCloud& points, int slice = 1 << 20) {
    search.begin(points);
    while (!search.step(slice)) {
    }
    support.begin(points, search);
    while (!support.step(slice)) {
    }
  }
  TestMemory memory;
  PlaneSearch search;
  PlaneSupport support;
};

// A floor of 6,000 points, a wall of 3,000, 1,500 here and there, and 400 on the floor's plane that
// stand across it; 3 mm noise, normals a few degrees off and of either sign.
std::vector<Oriented> room(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> side(-1, 1);
  std::normal_distribution<float> noise(0, 0.003f), tilt(0, 0.05f);
  std::vector<Oriented> out;
  const auto sign = [&] { return random() % 2 == 0 ? 1.0f : -1.0f; };
  const auto unit = [](float x, float y, float z) {
    const float length = std::sqrt(x * x + y * y + z * z);
    return Point{x / length, y / length, z / length};
  };
  for (int i = 0; i < 6'000; ++i) {
    out.push_back({{side(random), side(random), 0.5f + noise(random)},
                   unit(tilt(random), tilt(random), sign())});
  }
  for (int i = 0; i < 3'000; ++i) {
    out.push_back({{-1 + noise(random), side(random), 0.5f * (1 + side(random))},
                   unit(sign(), tilt(random), tilt(random))});
  }
  for (int i = 0; i < 1'500; ++i) {
    out.push_back({{side(random), side(random), side(random)},
                   unit(side(random), side(random), side(random))});
  }
  for (int i = 0; i < 400; ++i) {
    out.push_back({{side(random), side(random), 0.5f}, {0, 1, 0}});
  }
  return out;
}

TEST(Planes, OfAsManyPointsAsAskedForAreFoundAndOfOneLessAreNot) {
  std::vector<Oriented> tile;
  for (int i = 0; i < 400; ++i) {
    tile.push_back({{0.01f * static_cast<float>(i % 20), 0.01f * static_cast<float>(i / 20), 0.5f},
                    {0, 0, 1}});
  }
  const TestCloud cloud = cloud_of(tile);
  for (const int points_min : {400, 401}) {
    PlaneSettings settings;
    settings.points_min = points_min;
    TestSearch test(1'000, settings);
    test.run(cloud.points);
    EXPECT_EQ(test.search.count(), points_min == 400 ? 1 : 0);
  }
}

TEST(Planes, CountTheStepsOfEveryPassAndTry) {
  std::vector<Oriented> tile;
  for (int i = 0; i < 600; ++i) {
    tile.push_back({{0.01f * static_cast<float>(i % 25), 0.01f * static_cast<float>(i / 25), 0.5f},
                    {1, 0, 0}});  // no plane through them has this normal
  }
  const TestCloud cloud = cloud_of(tile);
  const auto steps_of = [&](const PlaneSettings& settings) {
    TestSearch test(1'000, settings);
    test.search.begin(cloud.points);
    int steps = 0;
    for (bool done = false; !done; steps += test.search.steps()) done = test.search.step(1 << 20);
    EXPECT_EQ(test.search.count(), 0);
    return steps;
  };
  PlaneSettings few, many;
  few.tries = 100;
  many.tries = 1'100;
  EXPECT_EQ(steps_of(many) - steps_of(few), 1'000 * k_plane_try_steps);
  EXPECT_GE(steps_of(few), 600 * (k_plane_list_steps + k_plane_draw_steps));
}

TEST(Planes, AreFoundLargestFirstAndFittedToTheirPoints) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TestCloud cloud = cloud_of(room(seed));
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
  const std::vector<Oriented> points = room(1);
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

TEST(Planes, MakeTheirPointsFlatAndMoveNoOther) {
  const std::vector<Oriented> points = room(2);
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

// A table of 1 cm voxels, and beside it a wall that crosses its plane, with normals that are wrong
// by the worst of luck: only the wall's other points tell that the stripe is no part of the table.
TEST(PlaneSupport, TakesOffAStripeAndLeavesEdgesOn) {
  std::vector<Oriented> points;
  for (int i = 0; i < 60 * 60; ++i) {
    points.push_back(
        {{0.01f * static_cast<float>(i % 60), 0.01f * static_cast<float>(i / 60), 0}, {0, 0, 1}});
  }
  const std::size_t table = points.size();
  for (int i = 0; i < 40 * 40; ++i) {
    points.push_back(
        {{1.2f, 0.01f * static_cast<float>(i % 40), 0.01f * static_cast<float>(i / 40) - 0.2f},
         {0, 0, 1}});
  }
  const TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.search.begin(cloud.points);
  while (!test.search.step(1'000)) {
  }
  ASSERT_EQ(test.search.count(), 1);
  TestMemory memory(PlaneSupport::bytes(20'000));
  PlaneSupport support;
  ASSERT_EQ(support.prepare({}, 20'000, memory.arena()), Reason::none);
  support.begin(cloud.points, test.search);
  while (!support.step(13)) {
  }
  int stripe = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = static_cast<int>(i);
    const bool on = test.search.plane_of(place) == 0;
    if (i < table) {
      ASSERT_EQ(support.plane_of(place), 0);
    } else {
      stripe += on ? 1 : 0;
      ASSERT_EQ(support.plane_of(place), PlaneSearch::k_no_plane);
    }
  }
  EXPECT_GE(stripe, 40);
  EXPECT_EQ(support.taken_off(), stripe);
}

TEST(PlaneSupport, CountsItsStepsAndRefusesSettingsThatFindNothing) {
  const std::vector<Oriented> points = room(3);
  const TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points);
  PlaneSupport& support = test.support;
  support.begin(cloud.points, test.search);
  constexpr int k_most = 500;
  std::int64_t steps = 0;
  for (bool done = false; !done; steps += support.steps()) {
    done = support.step(SliceSize{k_most, k_most});
    EXPECT_LE(support.steps(), k_most + PlaneSupport::steps_max(PlaneSupportSettings{}));
  }
  // Each point costs its share, and on a plane at least a look at itself.
  std::int64_t on_planes = 0;
  for (int i = 0; i < cloud.points.count; ++i)
    on_planes += test.search.plane_of(i) != PlaneSearch::k_no_plane ? 1 : 0;
  EXPECT_GE(steps, k_support_steps * std::int64_t{cloud.points.count} + k_vote_steps * on_planes);
  for (const float radius : {0.0f, -1.0f, 1e-40f}) {
    PlaneSupportSettings settings;
    settings.radius_m = radius;
    TestMemory memory(PlaneSupport::bytes(100));
    EXPECT_EQ(PlaneSupport().prepare(settings, 100, memory.arena()), Reason::out_of_range)
        << radius;
  }
}

// Every pair of points is looked at.
TEST(PlaneSupport, LeavesOnAPlaneWhatAPlainCountOfNeighboursLeaves) {
  const std::vector<Oriented> points = room(5);
  const TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points, 211);
  constexpr float k_limit = 0.2f * 0.2f;
  int taken_off = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t plane = test.search.plane_of(static_cast<int>(i));
    int near = 0, on_plane = 0;
    for (std::size_t j = 0; j < points.size() && plane != PlaneSearch::k_no_plane; ++j) {
      const float dx = points[j].point[0] - points[i].point[0],
                  dy = points[j].point[1] - points[i].point[1];
      const float dz = points[j].point[2] - points[i].point[2];
      if (dx * dx + dy * dy + dz * dz > k_limit) continue;
      ++near;
      on_plane += test.search.plane_of(static_cast<int>(j)) == plane ? 1 : 0;
    }
    const bool stays = plane == PlaneSearch::k_no_plane ||
                       static_cast<float>(on_plane) >= 0.4f * static_cast<float>(near);
    taken_off += stays ? 0 : 1;
    ASSERT_EQ(test.support.plane_of(static_cast<int>(i)), stays ? plane : PlaneSearch::k_no_plane)
        << i << ": " << on_plane << " of " << near;
  }
  EXPECT_EQ(test.support.taken_off(), taken_off);
  EXPECT_GT(taken_off, 0);
}

TEST(PlaneSupport, RefusesWhatItCannotWorkWith) {
  TestMemory memory(PlaneSupport::bytes(10));
  PlaneSupport support;
  EXPECT_EQ(support.prepare({0, 0.4f, 100}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(support.prepare({0.05f, 1.5f, 100}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(support.prepare({0.05f, 0.4f, 0}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(support.prepare({}, 10'000, memory.arena()), Reason::not_prepared);
  EXPECT_EQ(support.plane_of(0), PlaneSearch::k_no_plane);
}

TEST(Planes, AreTheSameInSlices) {
  const TestCloud cloud = cloud_of(room(3));
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
  std::vector<Oriented> points = room(4);
  std::vector<Oriented> scattered(points.begin() + 9'000, points.begin() + 10'500);
  TestSearch test(20'000);
  test.run(cloud_of(scattered).points);
  EXPECT_EQ(test.search.count(), 0);
  std::vector<Oriented> floor(points.begin(), points.begin() + 480);
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
  const auto count_of = [&](const std::vector<Oriented>& points) {
    test.run(cloud_of(points).points);
    return test.search.count();
  };
  EXPECT_EQ(count_of({{{0, 0, 0}, up}}), 0);
  EXPECT_EQ(count_of(std::vector<Oriented>(1'000, {{k_not_a_number, 0, 0}, up})), 0);
  EXPECT_EQ(count_of(std::vector<Oriented>(1'000, {{1, 2, 3}, up})), 0);
  std::vector<Oriented> line, bare;
  for (int i = 0; i < 1'000; ++i) {
    const float s = 0.001f * static_cast<float>(i);
    line.push_back({{s, 0, 0}, up});
    bare.push_back({{s, s * s, 0}, {0, 0, 0}});
  }
  EXPECT_EQ(count_of(line), 0);
  EXPECT_EQ(count_of(bare), 0);
}

TEST(Planes, OfACloudBeyondTheCapacityAreThoseOfItsFirstPointsAndItSaysSo) {
  TestCloud cloud = cloud_of(room(5));
  TestSearch test(6'000);
  test.run(cloud.points);
  EXPECT_EQ(test.search.reason(), Reason::cloud_full);
  ASSERT_EQ(test.search.count(), 1);
  EXPECT_EQ(test.search.plane_of(6'000), PlaneSearch::k_no_plane);
  EXPECT_EQ(snap_to_planes(test.search, test.support, 0, 1 << 20, cloud.points),
            cloud.points.count);
}

TEST(Planes, EndWithAsManyAsMayBe) {
  PlaneSettings one;
  one.planes_max = 1;
  TestSearch test(20'000, one);
  test.run(cloud_of(room(6)).points);
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

}  // namespace
}  // namespace glint

#include "kernels/cloud/plane_support.hpp"

#include <tuple>

#include "oriented_clouds.hpp"
#include "walk_steps.hpp"

namespace glint::plane_support_test {
namespace {

// A table of 1 cm voxels, and beside it a wall that crosses its plane and has the table's normals
// (worst case). Only the wall's other points show that the stripe is not part of the table.
TEST(PlaneSupport, TakesOffAStripeAndLeavesEdgesOn) {
  std::vector<PointWithNormal> points;
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
  EXPECT_EQ(support.removed(), stripe);
}

TEST(PlaneSupport, CountsItsStepsAndRefusesSettingsThatFindNothing) {
  const std::vector<PointWithNormal> points = scene_points(3);
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
  // Each point costs k_support_steps, and on a plane at least one vote (its own).
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

// Reference: all pairs of points.
TEST(PlaneSupport, LeavesOnAPlaneWhatAPlainCountOfNeighboursLeaves) {
  const std::vector<PointWithNormal> points = scene_points(5);
  const TestCloud cloud = cloud_of(points);
  TestSearch test(20'000);
  test.run(cloud.points, 211);
  constexpr float k_limit = 0.2f * 0.2f;
  int removed = 0;
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
    removed += stays ? 0 : 1;
    ASSERT_EQ(test.support.plane_of(static_cast<int>(i)), stays ? plane : PlaneSearch::k_no_plane)
        << i << ": " << on_plane << " of " << near;
  }
  EXPECT_EQ(test.support.removed(), removed);
  EXPECT_GT(removed, 0);
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

// A tile within one cell, and k_off points off every plane.
struct SupportedTile {
  static constexpr int k_on = 400, k_off = 16, k_all = k_on + k_off;
  explicit SupportedTile(PlaneSupportSettings settings = {}, bool off_first = false)
      : memory(PlaneSupport::bytes(k_all)) {
    std::vector<PointWithNormal> points = tile(k_on, 20, 0.5f, {0, 0, 1});
    points.insert(off_first ? points.begin() : points.end(), k_off, {{0.5f, 0.5f, 0.75f}, {}});
    cloud = std::make_unique<TestCloud>(cloud_of(points));
    PlaneSettings planes;
    planes.points_min = 100;
    planes_of = std::make_unique<TestSearch>(k_all, planes);
    planes_of->run(cloud->points);
    EXPECT_EQ(planes_of->search.count(), 1);
    settings.radius_m = 1;  // equals the cell's width
    EXPECT_EQ(support.prepare(settings, k_all, memory.arena()), Reason::none);
  }
  // Sum of the steps of all calls.
  int run(SliceSize most) {
    support.begin(cloud->points, planes_of->search);
    int steps = 0;
    for (bool done = false; !done; steps += support.steps()) done = support.step(most);
    return steps;
  }
  [[nodiscard]] int stay() const {
    int count = 0;
    for (int i = 0; i < k_all; ++i) {
      count += support.plane_of(i) != PlaneSearch::k_no_plane ? 1 : 0;
    }
    return count;
  }
  std::unique_ptr<TestCloud> cloud;
  std::unique_ptr<TestSearch> planes_of;
  TestMemory memory;
  PlaneSupport support;
};

TEST(PlaneSupport, CountsTheStepsOfMarkingSortingAndEachCandidate) {
  constexpr int k_all = SupportedTile::k_all, k_on = SupportedTile::k_on;
  constexpr int k_walk = k_all * k_support_steps + k_single_cell_steps;
  for (const int candidates : {1, 20, k_all, 4096}) {
    SupportedTile tile({1, 0, candidates});
    const int voted = std::min(candidates, k_all) * k_on * k_vote_steps;
    const int rest = sorting_steps(k_all, k_all) + k_walk + voted;
    EXPECT_EQ(tile.run(1 << 20), 1 + k_all / k_marked_per_step + rest) << candidates;
    // Marking 100 points takes seven steps, the last 16 take two.
    EXPECT_EQ(tile.run(100), 4 * (1 + 100 / k_marked_per_step) + 1 + 1 + rest) << candidates;
    // With a budget of two steps, each call takes three: one is the overhead of the call.
    EXPECT_EQ(tile.run({1 << 20, 2}), k_all / (2 * k_marked_per_step) * 3 + rest) << candidates;
  }
}

TEST(PlaneSupport, TakesNoMoreStepsThanItStatesForOnePoint) {
  PlaneSupportSettings settings{1, 0, 100};
  SupportedTile tile(settings);
  tile.support.begin(tile.cloud->points, tile.planes_of->search);
  int most = 0;
  int calls = 0;
  for (bool done = false; !done; ++calls) {
    done = tile.support.step(1);
    // Skip the calls that sort: each pass ends with extra steps.
    if (calls > 6 * SupportedTile::k_all) most = std::max(most, tile.support.steps());
  }
  EXPECT_EQ(most, k_support_steps + k_vote_steps * 100);
  EXPECT_EQ(PlaneSupport::steps_max(settings) - most - k_single_cell_steps,
            k_worst_cell_extra_steps);
}

// The first points of the cell vote: 16 of the first 20 are off the plane.
TEST(PlaneSupport, StaysWhereExactlyThePartAskedForOfTheCandidatesIsOnThePlane) {
  for (const auto& [part, candidates, stays] :
       {std::tuple{0.2f, 20, true}, std::tuple{0.21f, 20, false}, std::tuple{0.2f, 19, false},
        std::tuple{0.5f, 32, true}, std::tuple{0.5f, 31, false}, std::tuple{0.0f, 1, true},
        std::tuple{1.0f, 17, false}}) {
    SupportedTile tile({1, part, candidates}, true);
    tile.run(50);
    EXPECT_EQ(tile.stay(), stays ? SupportedTile::k_on : 0) << part << ' ' << candidates;
    EXPECT_EQ(tile.support.removed(), stays ? 0 : SupportedTile::k_on);
  }
}

// One further point is off the plane, above the corner point at exactly the radius.
TEST(PlaneSupport, CountsANeighbourAtExactlyTheRadius) {
  std::vector<PointWithNormal> points;
  for (int i = 0; i < 9; ++i) {
    points.push_back(
        {{0.125f * static_cast<float>(i % 3), 0.125f * static_cast<float>(i / 3), 0}, {0, 0, 1}});
  }
  for (const float height : {0.125f, std::nextafter(0.125f, 1.0f)}) {
    std::vector<PointWithNormal> all = points;
    all.push_back({{0.25f, 0.25f, height}, {}});
    const TestCloud cloud = cloud_of(all);
    PlaneSettings planes;
    planes.points_min = 9;
    TestSearch search(10, planes);
    search.run(cloud.points);
    ASSERT_EQ(search.search.count(), 1);
    TestMemory memory(PlaneSupport::bytes(10));
    PlaneSupport support;
    // The corner counts itself and two neighbours on the plane: 3 of 3, or 3 of 4.
    ASSERT_EQ(support.prepare({0.125f, 0.8f, 100}, 10, memory.arena()), Reason::none);
    support.begin(cloud.points, search.search);
    while (!support.step(1)) {
    }
    EXPECT_EQ(support.removed(), height == 0.125f ? 1 : 0) << height;
    EXPECT_EQ(support.plane_of(8), height == 0.125f ? PlaneSearch::k_no_plane : 0);
  }
}

TEST(PlaneSupport, BegunAgainJudgesAsANewOne) {
  SupportedTile used({1, 1, 17}, true);
  const int steps = used.run(1 << 20);
  EXPECT_EQ(used.support.removed(), SupportedTile::k_on);
  EXPECT_EQ(used.run(1 << 20), steps);
  EXPECT_EQ(used.support.removed(), SupportedTile::k_on) << "counted anew";
  used.support.begin(used.cloud->points, used.planes_of->search);
  EXPECT_EQ(used.support.removed(), 0);
  EXPECT_EQ(used.stay(), 0) << "at once each point is on no plane";
}

TEST(PlaneSupport, PreparedAnewHasNoPointOnAPlane) {
  SupportedTile used({1, 0, 100});
  used.run(1 << 20);
  EXPECT_EQ(used.stay(), SupportedTile::k_on);
  TestMemory memory(PlaneSupport::bytes(SupportedTile::k_all));
  ASSERT_EQ(used.support.prepare({}, SupportedTile::k_all, memory.arena()), Reason::none);
  EXPECT_EQ(used.stay(), 0);
  EXPECT_EQ(used.support.prepare({0, 0.4f, 100}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_TRUE(used.support.step(1)) << "it is prepared no longer";
  EXPECT_EQ(used.support.steps(), 0);
}

// Only the first points up to the capacity are tested; the others are on no plane.
TEST(PlaneSupport, OfACloudBeyondItsCapacityJudgesTheFirstPoints) {
  SupportedTile tile;
  TestMemory memory(PlaneSupport::bytes(150));
  PlaneSupport support;
  ASSERT_EQ(support.prepare({1, 0.5f, 1000}, 150, memory.arena()), Reason::none);
  support.begin(tile.cloud->points, tile.planes_of->search);
  while (!support.step(13)) {
  }
  for (int i = 0; i < SupportedTile::k_all; ++i) {
    ASSERT_EQ(support.plane_of(i), i < 150 ? 0 : PlaneSearch::k_no_plane) << i;
  }
}

TEST(PlaneSupport, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  const auto reason_of = [](const PlaneSupportSettings& settings, int points = 10) {
    TestMemory memory(PlaneSupport::bytes(10));
    return PlaneSupport().prepare(settings, points, memory.arena());
  };
  for (const PlaneSupportSettings& settings : {PlaneSupportSettings{1e-38f, 0.4f, 100},
                                               {0.05f, 0, 100},
                                               {0.05f, 1, 100},
                                               {0.05f, 0.4f, 1}}) {
    EXPECT_EQ(reason_of(settings), Reason::none);
  }
  for (const PlaneSupportSettings& settings : {PlaneSupportSettings{0, 0.4f, 100},
                                               {-1, 0.4f, 100},
                                               {1e-40f, 0.4f, 100},
                                               {k_not_a_number, 0.4f, 100},
                                               {0.05f, -0.01f, 100},
                                               {0.05f, 1.01f, 100},
                                               {0.05f, k_not_a_number, 100},
                                               {0.05f, 0.4f, 0}}) {
    EXPECT_EQ(reason_of(settings), Reason::out_of_range)
        << settings.radius_m << ' ' << settings.support_share_min << ' ' << settings.candidates_max;
  }
  EXPECT_EQ(reason_of({}, 0), Reason::out_of_range);
  EXPECT_EQ(reason_of({}, k_cloud_points_max + 1), Reason::out_of_range);
  EXPECT_EQ(reason_of({}, k_cloud_points_max), Reason::not_prepared);
  ExactMemory enough(PlaneSupport::bytes(10)), less(PlaneSupport::bytes(10) - 1);
  EXPECT_EQ(PlaneSupport().prepare({}, 10, enough.arena()), Reason::none);
  EXPECT_EQ(PlaneSupport().prepare({}, 10, less.arena()), Reason::not_prepared);
}

}  // namespace
}  // namespace glint::plane_support_test

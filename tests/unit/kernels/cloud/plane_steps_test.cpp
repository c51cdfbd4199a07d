// Step counts of the plane search, and its draws compared with a plain implementation.
#include <algorithm>

#include "oriented_clouds.hpp"

namespace glint::plane_steps_test {
namespace {

constexpr SliceSize k_whole = 1 << 20;

struct PassCost {
  int calls = 0, steps = 0;
};
PassCost run(PlaneSearch& search, const PointCloud& cloud, SliceSize most) {
  PassCost out;
  search.begin(cloud);
  for (bool done = false; !done; ++out.calls) {
    done = search.step(most);
    out.steps += search.steps();
  }
  return out;
}

PlaneSettings few_tries(int candidates_max, int scored_max, int planes_max = 1) {
  PlaneSettings settings;
  settings.planes_max = planes_max;
  settings.points_min = 100;
  settings.candidates_max = candidates_max;
  settings.scored_max = scored_max;
  return settings;
}

constexpr Point k_up{0, 0, 1}, k_across{1, 0, 0};

TEST(PlaneSteps, AreThoseOfItsPassesInSlicesOfAnySize) {
  constexpr int k_points = 400;
  const TestCloud cloud = cloud_of(tile(k_points, 20, 0.5f, k_up));
  const struct {
    SliceSize most;
    int listed, drawn, fitted, taken;  // calls of each pass
  } cases[] = {{k_whole, 1, 1, 1, 1},
               {100, 4, 4, 4, 4},
               {1, 400, 400, 400, 400},
               {{1 << 20, 600}, 4, 16, 7, 4},
               {{1 << 20, 1}, 400, 400, 400, 400}};
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const auto& c : cases) {
      PlaneSettings settings = few_tries(1, 1);
      settings.random_seed = seed;
      TestSearch test(k_points, settings);
      const PassCost one = run(test.search, cloud.points, c.most);
      const int planes = test.search.count();  // 0 if the three drawn points are collinear
      found += planes;
      EXPECT_EQ(one.calls, c.listed + c.drawn + 1 + planes * (k_plane_fits * c.fitted + c.taken));
      const int of_points =
          k_plane_list_steps + k_plane_draw_steps +
          planes * (k_plane_score_steps + k_plane_fits * k_plane_fit_steps + k_plane_take_steps);
      EXPECT_EQ(one.steps,
                one.calls * k_plane_call_steps + k_points * of_points + k_plane_try_steps);
      // If a further plane is allowed, the free points are listed again; none is left.
      settings.planes_max = 2;
      TestSearch more(k_points, settings);
      const PassCost two = run(more.search, cloud.points, c.most);
      EXPECT_EQ(more.search.count(), planes);
      EXPECT_EQ(two.calls, one.calls + planes * c.listed);
      EXPECT_EQ(two.steps - one.steps,
                planes * (c.listed * k_plane_call_steps + k_points * k_plane_list_steps));
    }
  }
  EXPECT_GT(found, 5);
}

TEST(PlaneSteps, AreThoseOfItsTriesInSlicesOfAnySize) {
  constexpr int k_points = 400, k_tries = 100;
  // Every point's normal lies in the plane: every try fails.
  const TestCloud cloud = cloud_of(tile(k_points, 20, 0.5f, k_across));
  const struct {
    SliceSize most;
    int listed, drawn, tried;
  } cases[] = {{k_whole, 1, 1, 1},
               {7, 58, 58, 15},
               {1, 400, 400, 100},
               {{1 << 20, 50}, 50, 200, 34},   // the third try exceeds the steps
               {{1 << 20, 48}, 50, 200, 50}};  // two tries use up the steps
  for (const auto& c : cases) {
    TestSearch test(k_points, few_tries(k_tries, 8));
    const PassCost all = run(test.search, cloud.points, c.most);
    EXPECT_EQ(test.search.count(), 0);
    EXPECT_EQ(all.calls, c.listed + c.drawn + c.tried);
    EXPECT_EQ(all.steps, all.calls * k_plane_call_steps +
                             k_points * (k_plane_list_steps + k_plane_draw_steps) +
                             k_tries * k_plane_try_steps);
  }
}

// A scored try counts as one item per sample point, plus one for the try itself.
TEST(PlaneSteps, CountAScoredSampleByItsPoints) {
  constexpr int k_points = 400, k_tries = 10;
  const TestCloud cloud = cloud_of(tile(k_points, 20, 0.5f, k_up));
  const int passes = 1 + 1 + k_plane_fits + 1;
  int checked = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PlaneSettings settings = few_tries(k_tries, k_tries);
    settings.random_seed = seed;
    TestSearch test(k_points, settings);
    const PassCost whole = run(test.search, cloud.points, k_whole);
    const int of_points = k_plane_list_steps + k_plane_draw_steps +
                          k_plane_fits * k_plane_fit_steps + k_plane_take_steps;
    const int scored = whole.steps - whole.calls * k_plane_call_steps - k_points * of_points -
                       k_tries * k_plane_try_steps;
    if (scored != k_tries * k_points * k_plane_score_steps) continue;  // some draws were collinear
    ++checked;
    EXPECT_EQ(run(test.search, cloud.points, k_points + 1).calls, passes + k_tries);
    EXPECT_EQ(run(test.search, cloud.points, k_points + 2).calls, passes + k_tries / 2);
  }
  EXPECT_GT(checked, 2);
}

// Reference: the search's draws and scores in plain loops. One sample point from each of equal
// parts of the free points; then planes through three of them; the first of the best wins.
struct PlainSearch {
  PlaneSettings settings;
  const PointCloud& cloud;
  TestMemory memory{PlaneSample::bytes()};
  int tried = 0, scored = 0, sampled = 0;
  CandidatePlane best{};

  void find(int plane, const std::vector<int>& free) {
    PlaneSample sample;
    ASSERT_EQ(sample.prepare(memory.arena()), Reason::none);
    sampled = std::min(static_cast<int>(free.size()), k_plane_sample);
    for (int i = 0; i < sampled; ++i) {
      const std::size_t begin =
          free.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(sampled);
      const std::size_t end =
          free.size() * static_cast<std::size_t>(i + 1) / static_cast<std::size_t>(sampled);
      sample.add(cloud, free[begin + random_at(settings.random_seed, plane, i) % (end - begin)]);
    }
    int most = 0;
    tried = scored = 0;
    while (tried < settings.candidates_max && scored < settings.scored_max) {
      const std::uint64_t drawn = random_at(settings.random_seed, plane, k_plane_sample + tried++);
      CandidatePlane candidate;
      if (!sample.candidate_of(drawn, settings.gate, candidate)) continue;
      ++scored;
      const int score = sample.score(candidate, settings.gate);
      if (score > most) most = score, best = candidate;
    }
    EXPECT_GT(most, 0);
  }
};

// Two tiles of the same size, one above the other: the order of the draws alone decides which plane
// is found first. Of 4,000 points about half are in the sample.
TEST(PlaneSteps, AreThoseOfAPlainSearchThatDrawsTheSameNumbers) {
  for (const int points : {300, 2'000}) {
    std::vector<PointWithNormal> both = tile(points, 50, 0, k_up);
    for (const PointWithNormal& p : tile(points, 50, 1, k_up)) both.push_back(p);
    for (std::size_t i = 0; i < both.size(); i += 7) both[i].normal = {0.6f, 0, 0.8f};
    const TestCloud cloud = cloud_of(both);
    int upper = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      PlaneSettings settings = few_tries(500, 12, 2);
      settings.random_seed = seed;
      TestSearch test(2 * points, settings);
      const PassCost all = run(test.search, cloud.points, k_whole);
      ASSERT_EQ(test.search.count(), 2);
      int steps = 0;
      for (int plane = 0; plane < 2; ++plane) {
        std::vector<int> free;
        for (int i = 0; i < 2 * points; ++i) {
          const std::uint8_t on = test.search.plane_of(i);
          if (plane == 0 || on != 0) free.push_back(i);
        }
        PlainSearch plain{settings, cloud.points};
        plain.find(plane, free);
        const auto left = static_cast<int>(free.size());
        steps += 2 * points * k_plane_list_steps + plain.sampled * k_plane_draw_steps +
                 plain.tried * k_plane_try_steps +
                 plain.scored * plain.sampled * k_plane_score_steps +
                 left * (k_plane_fits * k_plane_fit_steps + k_plane_take_steps);
        const Plane& found = test.search.plane(plane);
        const double sign = found.normal.z() * static_cast<double>(plain.best.nz) < 0 ? -1 : 1;
        EXPECT_NEAR(sign * found.offset_m, plain.best.offset_m, 0.01) << seed << ' ' << plane;
        upper += plane == 0 && std::abs(found.offset_m) > 0.5 ? 1 : 0;
      }
      EXPECT_EQ(all.steps, all.calls * k_plane_call_steps + steps) << points << ' ' << seed;
      EXPECT_EQ(all.calls, 2 * (3 + k_plane_fits + 1));
    }
    EXPECT_GT(upper, 0);
    EXPECT_LT(upper, 8);
  }
}

TEST(PlaneSteps, GoNoFurtherBeyondASliceThanStated) {
  const TestCloud cloud = cloud_of(scene_points(8));
  TestSearch test(20'000);
  for (const int steps : {1, 300, 5'000}) {
    test.search.begin(cloud.points);
    while (!test.search.step({1 << 20, steps})) {
      ASSERT_LE(test.search.steps(), steps + PlaneSearch::steps_max());
      ASSERT_GT(test.search.steps(), 0);
    }
  }
  // If each try is scored in its own call, a slice of one step costs one turn, one try and one
  // sample.
  PlaneSettings settings = few_tries(4096, 256);
  settings.gate.normal_cosine_min = 0;
  TestSearch one(20'000, settings);
  int most = 0;
  one.search.begin(cloud.points);
  while (!one.search.step(1)) most = std::max(most, one.search.steps());
  EXPECT_EQ(most, PlaneSearch::steps_max());
}

}  // namespace
}  // namespace glint::plane_steps_test

// Smallest distances between tools, compared with an exhaustive search over all labelings by the
// tracker's own rigid fit.
#include "platform/cells/tool_distinction.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <set>
#include <vector>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/cells/tool_file.hpp"
#include "tests/unit/platform/cells/test_tools.hpp"

namespace glint {
namespace {

using test::asymmetric_tool;
using test::permuted_tool;
using test::random_tool;
using test::set_of;
using test::tool_of;

DistinctionSettings without_limit() {
  DistinctionSettings settings;
  settings.limit_sigmas = 1e6;
  return settings;
}

// Smallest root of the squared residual sum over all labelings of `wanted` markers of a by markers
// of b. If a and b are the same tool, the identity is excluded.
double nearest_of_all_m(const Tool& a, const Tool& b, int wanted) {
  double least = INFINITY;
  for (unsigned chosen = 0; chosen < 1U << a.marker_count; ++chosen) {
    if (std::popcount(chosen) != wanted) continue;
    std::vector<int> names(static_cast<std::size_t>(b.marker_count));
    std::iota(names.begin(), names.end(), 0);
    do {
      std::vector<Vector3> seen, model;
      bool identity = &a == &b;
      for (int i = 0; i < a.marker_count; ++i) {
        if (((chosen >> i) & 1U) == 0) continue;
        const int name = names[seen.size()];
        identity = identity && name == i;
        seen.push_back(a.markers_m[static_cast<std::size_t>(i)]);
        model.push_back(b.markers_m[static_cast<std::size_t>(name)]);
      }
      if (identity) continue;
      const RigidFit fit = fit_rigid(model, seen);
      if (fit.reason == Reason::none) least = std::min(least, fit.rms_m);
    } while (std::next_permutation(names.begin(), names.end()));
  }
  return least * std::sqrt(static_cast<double>(wanted));
}

const WrongLabeling* labeling_between(const Distinction& found, int one, int other) {
  for (const WrongLabeling& labeling : found.wrong_labelings) {
    if (std::set{labeling.seen, labeling.other} == std::set{one, other}) return &labeling;
  }
  return nullptr;
}

TEST(ToolDistinction, FindsWhatTryingAllLabelingsFinds) {
  test::Random random(1);
  int compared = 0, with_limit = 0;
  for (int round = 0; round < 60; ++round) {
    const ToolSet set = set_of({random_tool(random, 3 + random.below(3), 0.06),
                                random_tool(random, 3 + random.below(3), 0.06),
                                random_tool(random, 3 + random.below(3), 0.06)});
    const Distinction found = distinguish(set, without_limit());
    const Distinction near = distinguish(set, {});
    ASSERT_EQ(found.wrong_labelings.size(), 6u);
    for (const WrongLabeling& labeling : found.wrong_labelings) {
      const Tool& seen = set.items[static_cast<std::size_t>(labeling.seen)];
      const Tool& other = set.items[static_cast<std::size_t>(labeling.other)];
      const int wanted = &seen == &other ? seen.marker_count : std::min(4, other.marker_count);
      const double expected = nearest_of_all_m(seen, other, wanted) / 0.0015;
      EXPECT_NEAR(labeling.distance_sigmas, expected, 1e-5 + 1e-9 * expected);
      EXPECT_EQ(labeling.markers, wanted);
      EXPECT_FALSE(labeling.steps_exhausted);
      ++compared;
      const WrongLabeling* const nearer = labeling_between(near, labeling.seen, labeling.other);
      EXPECT_EQ(nearer != nullptr, expected < k_distinct_sigmas) << expected;
      if (nearer == nullptr) continue;
      EXPECT_NEAR(nearer->distance_sigmas, expected, 1e-5);
      ++with_limit;
    }
  }
  EXPECT_EQ(compared, 360);
  EXPECT_GT(with_limit, 50);
}

TEST(ToolDistinction, SaysHowOftenNoiseMakesTheWrongLabelingFitBetter) {
  // Planar, and nearly symmetric under a rotation by pi.
  const Tool tool = tool_of({{-40, 0, 0}, {40, 0, 0}, {3, 55, 0}, {0, 20, 0}});
  const Distinction found = distinguish(set_of({tool}), {});
  ASSERT_EQ(found.wrong_labelings.size(), 1u);
  const WrongLabeling& labeling = found.wrong_labelings[0];
  test::Random random(7);
  constexpr int frames = 40'000;
  int wrong = 0;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Vector3> measured, renamed;
    for (std::size_t i = 0; i < 4; ++i) {
      measured.push_back(tool.markers_m[i] + random.vector(0.0015));
      renamed.push_back(tool.markers_m[static_cast<std::size_t>(labeling.assignment[i])]);
    }
    const double right_m = fit_rigid(std::span(tool.markers_m.data(), 4), measured).rms_m;
    if (fit_rigid(renamed, measured).rms_m < right_m) ++wrong;
  }
  const double share = static_cast<double>(wrong) / frames;
  std::printf("  %.2f sigma: %.4f of frames, predicted %.4f\n", labeling.distance_sigmas, share,
              error_probability(labeling.distance_sigmas));
  ASSERT_GT(wrong, 400);
  EXPECT_NEAR(share / error_probability(labeling.distance_sigmas), 1, 0.1);
}

TEST(ToolDistinction, FindsEqualToolsHoweverTheyLieAndAreNumbered) {
  const Pose moved{Quaternion(0.5, 0.1, -0.7, 0.2).normalized(), Vector3(0.3, -0.2, 0.1)};
  const ToolSet set = set_of(
      {asymmetric_tool(),
       permuted_tool(asymmetric_tool(), [&](const Vector3& point) { return moved * point; })});
  const Distinction found = distinguish(set, {});
  ASSERT_EQ(found.wrong_labelings.size(), 1u);
  EXPECT_LT(found.wrong_labelings[0].distance_sigmas, 1e-4);
  for (std::size_t i = 0; i < 5; ++i) {
    const int name = found.wrong_labelings[0].assignment[i];
    if (name >= 0) {
      EXPECT_EQ(name, 4 - static_cast<int>(i));
    }
  }
}

TEST(ToolDistinction, TellsAToolFromItsMirrorImageUnlessItIsFlat) {
  const auto mirrored = [](const Vector3& point) {
    return Vector3(-point.x(), point.y(), point.z());
  };
  EXPECT_TRUE(
      distinguish(set_of({asymmetric_tool(), permuted_tool(asymmetric_tool(), mirrored)}), {})
          .wrong_labelings.empty());
  const Tool flat = tool_of({{0, 0, 0}, {70, 5, 0}, {20, 90, 0}, {110, 60, 0}});
  const Distinction found = distinguish(set_of({flat, permuted_tool(flat, mirrored)}), {});
  ASSERT_NE(labeling_between(found, 0, 1), nullptr);
  EXPECT_LT(labeling_between(found, 0, 1)->distance_sigmas, 1e-4);
}

TEST(ToolDistinction, FindsAToolOfThreeMarkersWithinALargerOneNotTheOtherWayRound) {
  const Tool large = asymmetric_tool();
  const Tool three = tool_of({{-40, 45, 115}, {45, 45, 240}, {22, 24, 129}});
  for (const ToolSet& set : {set_of({large, three}), set_of({three, large})}) {
    const Distinction found = distinguish(set, {});
    ASSERT_EQ(found.wrong_labelings.size(), 1u);
    const WrongLabeling& labeling = found.wrong_labelings[0];
    EXPECT_EQ(set.items[static_cast<std::size_t>(labeling.other)].marker_count, 3);
    EXPECT_EQ(labeling.markers, 3);
    EXPECT_EQ(labeling.assignment, (MarkerAssignment{-1, 0, 1, -1, 2, -1, -1, -1}));
  }
}

TEST(ToolDistinction, SeesMarkersOnALineThatNearlyFitATriangle) {
  // Three markers of the larger tool are collinear; the smaller tool is bent by 3 mm.
  const Tool ruled = tool_of({{0, 0, 0}, {40, 0, 0}, {100, 0, 0}, {130, 80, 30}});
  const Tool bent = tool_of({{0, 0, 0}, {40, 3, 0}, {100, 0, 0}});
  const Distinction found = distinguish(set_of({ruled, bent}), {});
  ASSERT_NE(labeling_between(found, 0, 1), nullptr);
  // The residual of the smaller tool's markers to the best line is 2.4 mm.
  EXPECT_GT(labeling_between(found, 0, 1)->distance_sigmas, 1.0);
  EXPECT_LT(labeling_between(found, 0, 1)->distance_sigmas, 2.0);
}

TEST(ToolDistinction, PassesOverMarkersOnALineWhichTheTrackersFitRefuses) {
  const Tool first = tool_of({{0, 0, 0}, {40, 0, 0}, {100, 0, 0}, {130, 0, 0}, {20, 80, 0}});
  const Tool second = tool_of({{0, 0, 0}, {40, 0, 0}, {100, 0, 0}, {130, 0, 0}, {90, 0, 75}});
  const ToolSet set = set_of({first, second});
  const Distinction found = distinguish(set, without_limit());
  ASSERT_NE(labeling_between(found, 0, 1), nullptr);
  EXPECT_NEAR(labeling_between(found, 0, 1)->distance_sigmas,
              nearest_of_all_m(set.items[0], set.items[1], 4) / 0.0015, 1e-5);
  EXPECT_GT(labeling_between(found, 0, 1)->distance_sigmas, k_distinct_sigmas);
}

// The corners of a cube. Two cubes of similar size have many near labelings.
Tool cube_of(double mm) {
  return tool_of({{0, 0, 0},
                  {mm, 0, 0},
                  {0, mm, 0},
                  {mm, mm, 0},
                  {0, 0, mm},
                  {mm, 0, mm},
                  {0, mm, mm},
                  {mm, mm, mm}});
}

TEST(ToolDistinction, StopsAtItsStepsAndSaysSo) {
  DistinctionSettings settings;
  settings.steps_max = 20;
  const Distinction cut = distinguish(set_of({cube_of(60), cube_of(66)}), settings);
  ASSERT_EQ(cut.wrong_labelings.size(), 3u);
  for (const WrongLabeling& labeling : cut.wrong_labelings) EXPECT_TRUE(labeling.steps_exhausted);
  EXPECT_LE(cut.steps_max_used, 20);
  const Distinction whole = distinguish(set_of({cube_of(60), cube_of(66)}), {});
  for (const WrongLabeling& labeling : whole.wrong_labelings)
    EXPECT_FALSE(labeling.steps_exhausted);
}

// Prints the elapsed time; only the steps are tested, the time is not.
Distinction timed(const char* name, const ToolSet& set, const DistinctionSettings& settings = {}) {
  const auto start = std::chrono::steady_clock::now();
  Distinction found = distinguish(set, settings);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("  %-14s %.3f s, at most %lld steps for a pair\n", name, took.count(),
              static_cast<long long>(found.steps_max_used));
  return found;
}

TEST(ToolDistinction, OfSixteenToolsOfEightMarkersEndsWithinItsSteps) {
  test::Random random(3);
  ToolSet drawn, cubes, bent_cubes;
  drawn.count = cubes.count = bent_cubes.count = k_tools_max;
  for (std::size_t t = 0; t < k_tools_max; ++t) {
    drawn.items[t] = random_tool(random, k_markers_per_tool_max, 0.15);
    cubes.items[t] = cube_of(50 + 2 * static_cast<double>(t));
    bent_cubes.items[t] = permuted_tool(
        cube_of(60), [&](const Vector3& point) { return Vector3(point + random.vector(0.003)); });
  }
  const Distinction usual = timed("random", drawn);
  EXPECT_LE(usual.steps_max_used, DistinctionSettings{}.steps_max / 10);
  for (const WrongLabeling& labeling : usual.wrong_labelings)
    EXPECT_FALSE(labeling.steps_exhausted);
  for (const Distinction& alike : {timed("cubes", cubes), timed("bent cubes", bent_cubes),
                                   timed("without limit", drawn, without_limit())}) {
    EXPECT_LE(alike.steps_max_used, DistinctionSettings{}.steps_max);
    EXPECT_GE(alike.wrong_labelings.size(), static_cast<std::size_t>(k_tools_max));
  }
}

TEST(ToolDistinction, OfRealToolsIsListed) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data == nullptr ? "" : data) / "tool_defs";
  if (data == nullptr || !std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no tool_defs; set GLINT_TEST_DATA";
  }
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".rom" || ending == ".ini") files.insert(entry.path());
  }
  ASSERT_FALSE(files.empty());
  ToolSet set;
  for (const auto& file : files) {
    if (set.count == k_tools_max) break;
    set.items[static_cast<std::size_t>(set.count++)] = load_tool(file.string());
  }
  const Distinction found = distinguish(set, without_limit());
  for (const WrongLabeling& labeling : found.wrong_labelings) {
    const Tool& seen = set.items[static_cast<std::size_t>(labeling.seen)];
    const Tool& other = set.items[static_cast<std::size_t>(labeling.other)];
    std::printf("  %-8s %-8s %6.2f sigma, %.2g of frames\n", seen.name.data(),
                &seen == &other ? "itself" : other.name.data(), labeling.distance_sigmas,
                error_probability(labeling.distance_sigmas));
    const int wanted = &seen == &other ? seen.marker_count : std::min(4, other.marker_count);
    EXPECT_NEAR(labeling.distance_sigmas, nearest_of_all_m(seen, other, wanted) / 0.0015, 1e-5);
  }
  EXPECT_EQ(static_cast<int>(found.wrong_labelings.size()), set.count * (set.count + 1) / 2);
}

}  // namespace
}  // namespace glint

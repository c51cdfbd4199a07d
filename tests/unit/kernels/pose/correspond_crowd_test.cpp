// Correspondence of five tools of five markers among twenty stray reflections at increasing noise:
// results lost to a cell's budgets, compared with an unlimited search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::correspond_crowd_test {
namespace {

constexpr int k_tools = 5;
constexpr int k_strays = 20;

struct Crowd {
  std::array<Tool, k_tools> tool;
  std::array<Pose, k_tools> pose;
  std::array<std::array<std::int16_t, 5>, k_tools> truth{};
  Markers markers;
};

void add_noisy(Crowd& crowd, const Tool& tool, const Vector3& point, double sigma_m,
               test::Random& random) {
  const Vector3 across = random.vector(point.norm() * 0.1 / 253);
  test::add_marker(crowd.markers, tool,
                   point + across + point.normalized() * (sigma_m * random.normal()));
}

Crowd crowd_of(double sigma_m, test::Random& random) {
  Crowd crowd;
  for (std::size_t t = 0; t < k_tools; ++t) {
    crowd.tool[t] = test::random_tool(random, 5);
    crowd.pose[t] = {random.rotation(), Vector3(0, 0, 0.55) + random.in_box(0.5)};
    for (std::size_t m = 0; m < 5; ++m) {
      crowd.truth[t][m] = static_cast<std::int16_t>(crowd.markers.count);
      add_noisy(crowd, crowd.tool[t], crowd.pose[t] * crowd.tool[t].markers_m[m], sigma_m, random);
    }
  }
  for (int s = 0; s < k_strays; ++s) {
    add_noisy(crowd, crowd.tool[0], Vector3(0, 0, 0.55) + random.in_box(0.6), sigma_m, random);
  }
  return crowd;
}

struct Outcome {
  int searches = 0, full = 0, none = 0, wrong = 0, steps_most = 0;
};

Outcome outcome_of(double sigma_m, const CorrespondSettings& settings, bool predicted) {
  Outcome outcome;
  test::Random random(31);
  auto scratch = std::make_unique<CorrespondScratch>();
  for (int frame = 0; frame < 400; ++frame) {
    const Crowd crowd = crowd_of(sigma_m, random);
    for (std::size_t t = 0; t < k_tools; ++t) {
      Labelings found;
      Pose prior = crowd.pose[t];
      prior.translation += random.vector(0.01);
      const CorrespondWork work = propose_labelings(crowd.markers, crowd.tool[t], settings,
                                                    predicted ? &prior : nullptr, *scratch, found);
      ++outcome.searches;
      outcome.full += found.reason == Reason::search_full ? 1 : 0;
      outcome.none += found.count == 0 ? 1 : 0;
      outcome.wrong += found.count > 0 && !std::equal(crowd.truth[t].begin(), crowd.truth[t].end(),
                                                      found.items[0].marker.begin())
                           ? 1
                           : 0;
      outcome.steps_most = std::max(outcome.steps_most, work.search.steps);
    }
  }
  return outcome;
}

// A cell of 64 blobs, as in platform/cells/default.toml.
CorrespondSettings cell_settings() {
  CorrespondSettings settings;
  settings.focal_px = 253;
  settings.markers_max = 64;
  settings.search_steps_max = 768;
  return settings;
}

TEST(CorrespondCrowd, LosesNothingToTheBudgetsOfACell) {
  CorrespondSettings unlimited_settings = cell_settings();
  unlimited_settings.search_steps_max = 1'000'000;
  for (const bool predicted : {false, true}) {
    for (int millimetres = 0; millimetres <= 5; millimetres += test::repetitions(1, 3)) {
      const double sigma_m = 1e-3 * millimetres;
      const Outcome free = outcome_of(sigma_m, unlimited_settings, predicted);
      const Outcome cell = outcome_of(sigma_m, cell_settings(), predicted);
      std::printf(
          "  %s prior, %.0f mm: of %d searches none %d, wrong %d, steps %d; "
          "in a cell none %d, wrong %d, full %d\n",
          predicted ? "with" : "without", 1e3 * sigma_m, free.searches, free.none, free.wrong,
          free.steps_most, cell.none, cell.wrong, cell.full);
      EXPECT_LE(cell.none, free.none + cell.searches / 500);
      EXPECT_LE(cell.wrong, free.wrong + cell.searches / 500);
      EXPECT_LE(cell.full, cell.searches / (sigma_m < 0.004 ? 40 : 10));
    }
  }
}

}  // namespace
}  // namespace glint::correspond_crowd_test

// Correspondence search against an enumeration of all labelings, and its step counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <vector>

#include "kernels/pose/correspond.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "tests/unit/kernels/pose/correspond_view.hpp"

namespace glint::correspond_search_test {
namespace {

using test::centres;
using test::Random;

bool has(const PairMatches& matches, int i, int a, int j, int b) {
  return (matches.word[static_cast<std::size_t>(matches.set_of(i, a, j) + b / 64)] >> (b % 64) &
          1) != 0;
}

struct Searched {
  std::unique_ptr<CorrespondScratch> scratch = std::make_unique<CorrespondScratch>();
  Labelings found;
  CorrespondWork work;

  void run(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
           const Pose* prior = nullptr) {
    work = propose_labelings(markers, tool, settings, prior, *scratch, found);
  }
};

// All labelings of `markers_min` or more markers with matching distances and a sufficient fit.
class Enumeration {
 public:
  Enumeration(const Searched& searched, const Tool& tool, const CorrespondSettings& settings,
              int markers_min)
      : searched_(searched), tool_(tool), settings_(settings), markers_min_(markers_min) {
    chosen_.fill(-1);
    name(0, 0);
    std::sort(all_.begin(), all_.end(), [](const Labeling& a, const Labeling& b) {
      return std::tuple(-a.count, a.rms_m, a.marker) < std::tuple(-b.count, b.rms_m, b.marker);
    });
  }
  // Labelings with the most markers and with up to `fewer` less, at most k_labelings_max.
  [[nodiscard]] std::vector<Labeling> best(int fewer) const {
    std::vector<Labeling> out;
    for (const Labeling& labeling : all_)
      if (labeling.count >= all_.front().count - fewer && out.size() < k_labelings_max)
        out.push_back(labeling);
    return out;
  }

 private:
  void name(int i, int named) {
    if (i == tool_.marker_count) {
      if (named >= markers_min_) judge(named);
      return;
    }
    name(i + 1, named);
    const Candidates& candidates = searched_.scratch->candidates;
    for (int a = 0; a < candidates.count; ++a) {
      bool fits = true;
      for (int j = 0; j < i; ++j) {
        const int b = chosen_[static_cast<std::size_t>(j)];
        fits = fits && (b < 0 || has(searched_.scratch->matches, j, b, i, a));
      }
      if (!fits) continue;
      chosen_[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(a);
      name(i + 1, named + 1);
      chosen_[static_cast<std::size_t>(i)] = -1;
    }
  }
  void judge(int named) {
    Labeling labeling;
    labeling.count = named;
    labeling.marker.fill(-1);
    std::vector<Vector3> model, measured;
    for (std::size_t j = 0; j < chosen_.size(); ++j) {
      if (chosen_[j] < 0) continue;
      const auto a = static_cast<std::size_t>(chosen_[j]);
      labeling.marker[j] = searched_.scratch->candidates.marker[a];
      model.push_back(tool_.markers_m[j]);
      measured.push_back(searched_.scratch->candidates.point_m[a]);
    }
    const RigidFit fit = fit_rigid(model, measured);
    if (fit.reason != Reason::none || !(fit.rms_m <= settings_.max_rms_m)) return;
    labeling.rms_m = fit.rms_m;
    labeling.T_camera_tool = fit.transform;
    all_.push_back(labeling);
  }

  const Searched& searched_;
  const Tool& tool_;
  const CorrespondSettings& settings_;
  int markers_min_;
  std::array<std::int16_t, k_markers_per_tool_max> chosen_;
  std::vector<Labeling> all_;
};

// Crowded and noisy: most scenes have several labelings, and some have more than the capacity.
TEST(CorrespondSearch, FindsTheBestOfAPlainEnumeration) {
  Random random(21);
  auto searched = std::make_unique<Searched>();
  int full = 0, several = 0;
  for (int round = 0; round < 250; ++round) {
    const Tool tool = test::random_tool(random, 3 + round % 3);
    CorrespondSettings settings;
    settings.range_sigma_m = 0.003;
    settings.gate_sigmas = 4;
    settings.max_rms_m = round % 2 == 0 ? 0.006 : 0.01;
    settings.min_markers_without_prior = 3 + round % 2;
    settings.fewer_markers_max = round % 3;
    settings.search_steps_max = 1'000'000;
    test::SceneSettings scene;
    scene.strays = 3 + round % 5 * (tool.marker_count == 3 ? 4 : 2);
    scene.stray_box_m = 0.2;
    scene.missing = round % 7 == 0 && tool.marker_count > 3 ? 1 : 0;
    const Markers markers = test::scene_of(tool, scene, random).markers;
    searched->run(markers, tool, settings);
    const int markers_min = std::min(settings.min_markers_without_prior, tool.marker_count);
    const auto expected =
        Enumeration(*searched, tool, settings, markers_min).best(settings.fewer_markers_max);
    ASSERT_EQ(searched->found.count, static_cast<int>(expected.size())) << "round " << round;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const Labeling& found = searched->found.items[k];
      ASSERT_EQ(found.marker, expected[k].marker) << "round " << round << ", place " << k;
      EXPECT_EQ(found.count, expected[k].count);
      EXPECT_EQ(found.rms_m, expected[k].rms_m);
      EXPECT_EQ(found.T_camera_tool.translation, expected[k].T_camera_tool.translation);
      EXPECT_EQ(found.log_prior_ratio_m2, 0) << "nothing was predicted";
    }
    full += expected.size() == k_labelings_max ? 1 : 0;
    several += expected.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(full, 20);
  EXPECT_GT(several, 100);
}

// One candidate per marker: the search tries an assignment wherever enough markers remain to reach
// `target`, and none beyond it.
int assignments_tried(int markers, int target, int at = 0, int named = 0) {
  if (named == target || named + markers - at < target) return 0;
  return 1 + assignments_tried(markers, target, at + 1, named + 1) +
         assignments_tried(markers, target, at + 1, named);
}

int labelings_of_size(int markers, int target) {
  int ways = 1;
  for (int k = 0; k < markers - target; ++k) ways = ways * (markers - k) / (k + 1);
  return ways;
}

// A tool whose distances are all different.
Tool distinct_tool(int markers) {
  Random random(31);
  for (;;) {
    const Tool tool = test::random_tool(random, markers);
    std::vector<double> distances;
    for (std::size_t i = 0; i < static_cast<std::size_t>(markers); ++i)
      for (std::size_t j = 0; j < i; ++j) distances.push_back(tool.distance_m[i][j]);
    std::sort(distances.begin(), distances.end());
    bool apart = true;
    for (std::size_t k = 1; k < distances.size(); ++k)
      apart = apart && distances[k] - distances[k - 1] > 0.0005;
    if (apart) return tool;
  }
}

Markers full_view(const Tool& tool) {
  std::vector<Vector3> points;
  for (int i = 0; i < tool.marker_count; ++i)
    points.push_back(tool.markers_m[static_cast<std::size_t>(i)] + Vector3(0, 0, 0.5));
  return centres(tool, points);
}

// Gates so narrow that each distance is unique.
CorrespondSettings exact() {
  CorrespondSettings settings;
  settings.range_sigma_m = 1e-5;
  settings.delta_min_m = 0.0001;
  return settings;
}

TEST(CorrespondSearch, CountsAStepANameAndThirtyTwoAFit) {
  auto searched = std::make_unique<Searched>();
  for (int markers = 3; markers <= 6; ++markers) {
    const Tool tool = distinct_tool(markers);
    for (int fewer = 0; fewer <= 2; ++fewer) {
      CorrespondSettings settings = exact();
      settings.min_markers_without_prior = 3;
      settings.fewer_markers_max = fewer;
      searched->run(full_view(tool), tool, settings);
      int names = 0, fits = 0;
      for (int target = markers; target >= std::max(3, markers - fewer); --target) {
        names += assignments_tried(markers, target);
        fits += labelings_of_size(markers, target);
      }
      EXPECT_EQ(searched->work.search.steps, names + k_fit_steps * fits) << markers << fewer;
      EXPECT_EQ(searched->found.hypotheses, static_cast<unsigned>(names));
      EXPECT_EQ(searched->work.search.words_narrowed, names * markers) << "a row each name";
      EXPECT_EQ(searched->work.markers, markers);
      EXPECT_EQ(searched->found.count, std::min(fits, k_labelings_max));
    }
  }
}

TEST(CorrespondSearch, EndsWithItsLastStepAndSaysSoOnlyWhereOneIsMissing) {
  auto searched = std::make_unique<Searched>();
  const Tool tool = distinct_tool(4);
  CorrespondSettings settings = exact();
  settings.fewer_markers_max = 0;
  const int needed = assignments_tried(4, 4) + k_fit_steps;
  for (const int budget : {needed, needed - 1, 4, 3, 1, 0}) {
    settings.search_steps_max = budget;
    searched->run(full_view(tool), tool, settings);
    EXPECT_EQ(searched->found.count, budget == needed ? 1 : 0) << budget;
    EXPECT_EQ(searched->found.reason, budget == needed ? Reason::none : Reason::search_full);
    EXPECT_EQ(searched->work.search.steps, budget == needed ? needed : std::min(budget, 4));
    EXPECT_EQ(searched->found.hypotheses, static_cast<unsigned>(std::min(budget, 4)));
  }
}

// With a prediction: near it, then everywhere, then the best labeling's markers again. A labeling
// found before is not fitted again.
TEST(CorrespondSearch, CountsEachPassOfAPredictedTool) {
  auto searched = std::make_unique<Searched>();
  const Tool tool = distinct_tool(4);
  CorrespondSettings settings = exact();
  settings.fewer_markers_max = 0;
  const Pose prior{Quaternion::Identity(), Vector3(0, 0, 0.5)};
  for (const bool only_near : {false, true}) {
    settings.only_near = only_near;
    searched->run(full_view(tool), tool, settings, &prior);
    const int passes = only_near ? 2 : 3;
    EXPECT_EQ(searched->found.hypotheses, static_cast<unsigned>(4 * passes));
    EXPECT_EQ(searched->work.search.steps, 4 * passes + k_fit_steps);
    EXPECT_EQ(searched->found.count, 1);
  }
}

TEST(CorrespondSearch, NeedsThreeMarkersAndAToolOfThreeToAsManyAsThereMayBe) {
  auto searched = std::make_unique<Searched>();
  Tool tool = distinct_tool(3);
  CorrespondSettings settings = exact();
  searched->run(full_view(tool), tool, settings);
  EXPECT_EQ(searched->found.count, 1) << "four are wanted, but it has three";
  settings.min_markers_without_prior = 0;
  Markers two = full_view(tool);
  two.count = 2;
  searched->run(two, tool, settings);
  EXPECT_EQ(searched->found.reason, Reason::too_few_markers);
  EXPECT_EQ(searched->work.pairs.pairs, 0) << "nothing was compared";
  tool.marker_count = 2;
  searched->run(full_view(tool), tool, settings);
  EXPECT_EQ(searched->found.reason, Reason::not_prepared);
  tool.marker_count = k_markers_per_tool_max + 1;
  searched->run({}, tool, settings);
  EXPECT_EQ(searched->found.reason, Reason::not_prepared);
  const Tool large = distinct_tool(k_markers_per_tool_max);
  searched->run(full_view(large), large, settings);
  EXPECT_EQ(searched->found.items[0].count, k_markers_per_tool_max);
}

// A tool of five markers, of which four, three or two are visible.
TEST(CorrespondSearch, TakesTheLeastMarkersThatItsSettingsAllow) {
  auto searched = std::make_unique<Searched>();
  const Tool tool = distinct_tool(5);
  const Pose prior{Quaternion::Identity(), Vector3(0, 0, 0.5)};
  const auto best = [&](int seen, int alone, int predicted, bool with_prior) {
    CorrespondSettings settings = exact();
    settings.min_markers_without_prior = alone;
    settings.min_markers_with_prior = predicted;
    Markers markers = full_view(tool);
    markers.count = seen;
    searched->run(markers, tool, settings, with_prior ? &prior : nullptr);
    return searched->found.count > 0 ? searched->found.items[0].count : 0;
  };
  EXPECT_EQ(best(4, 4, 3, false), 4);
  EXPECT_EQ(best(4, 5, 3, false), 0);
  EXPECT_EQ(searched->found.reason, Reason::too_few_markers);
  EXPECT_EQ(best(4, 9, 3, false), 0) << "all five, no more";
  EXPECT_EQ(best(5, 9, 3, false), 5);
  EXPECT_EQ(best(3, 3, 3, false), 3);
  EXPECT_EQ(best(3, 1, 3, false), 3) << "three at least";
  EXPECT_EQ(best(3, 4, 3, true), 3);
  EXPECT_EQ(best(3, 4, 1, true), 3);
  EXPECT_EQ(best(3, 4, 4, true), 0);
  EXPECT_EQ(best(4, 5, 4, true), 4);
  EXPECT_EQ(best(4, 5, 9, true), 0);
  EXPECT_EQ(best(5, 5, 9, true), 5);
}

// No state is carried over from one call to the next.
TEST(CorrespondSearch, StartsAnewWithEachCall) {
  auto used = std::make_unique<Searched>(), fresh = std::make_unique<Searched>();
  const Tool tool = distinct_tool(5);
  CorrespondSettings narrow = exact();
  narrow.search_steps_max = 40;
  used->run(full_view(tool), tool, narrow);
  EXPECT_EQ(used->found.reason, Reason::search_full);
  used->run(full_view(tool), tool, exact());
  fresh->run(full_view(tool), tool, exact());
  EXPECT_EQ(used->found.reason, Reason::none);
  EXPECT_EQ(used->found.count, fresh->found.count);
  EXPECT_EQ(used->found.hypotheses, fresh->found.hypotheses);
  EXPECT_EQ(used->work.search.steps, fresh->work.search.steps);
  used->run({}, tool, exact());
  EXPECT_EQ(used->found.count, 0);
  EXPECT_EQ(used->found.hypotheses, 0u);
}

}  // namespace
}  // namespace glint::correspond_search_test

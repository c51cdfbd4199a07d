#include "schedules/assessment.hpp"

#include <gtest/gtest.h>

#include "schedules/sensitivity.hpp"
#include "small_question.hpp"

namespace glint::assessment_test {
namespace {

using test::k_ms;
using test::k_us;
using test::small_input;

TEST(Assessment, AddsEachStageOnceAndKeepsEstimatesApart) {
  const Assessment found = assess(small_input());
  ASSERT_TRUE(found.holds()) << found.missed_deadlines.front();
  ASSERT_EQ(found.chains.size(), 2U);
  const Chain& to_can = found.chains[0];
  std::int64_t sum = 0, estimates = 0;
  for (const ChainStage& stage : to_can.stages) {
    sum += stage.ns;
    if (stage.kind == StageKind::estimate) estimates += stage.ns;
  }
  EXPECT_EQ(to_can.total_ns, sum);
  EXPECT_EQ(to_can.estimate_ns, estimates);
  // Frame group: 100 us of nodes and one tick of 50 us. Tick group: 50 us.
  EXPECT_EQ(to_can.stages[1].ns, 150 * k_us);
  EXPECT_EQ(to_can.stages[3].ns, 4 * k_ms);
  EXPECT_EQ(to_can.stages[5].ns, 50 * k_us);
  // Estimates for the frame group: wake-up 20, two writes of the tick of 5 each, one interrupt
  // of 2. Of the tick group: wake-up 20, interrupt 2, write 5.
  EXPECT_EQ(to_can.stages[0].ns, 20 * k_us);
  EXPECT_EQ(to_can.stages[2].ns, 12 * k_us);
  EXPECT_EQ(to_can.estimate_ns, (20 + 12 + 20 + 2 + 5) * k_us);
}

TEST(Assessment, GivesReactionTimeAndDataAgeFromMidExposureToTheLastBit) {
  const AnalysisInput input = small_input();
  const Assessment found = assess(input);
  const Chain& to_bus = found.chains[1];
  EXPECT_EQ(to_bus.stages[0].ns, 1 * k_ms);
  EXPECT_EQ(to_bus.stages[1].ns, 8 * k_ms);
  EXPECT_EQ(to_bus.stages[2].ns, 400 * k_us);
  // Its own 135 bits, 135 of the other node before it, and one frame that began earlier.
  EXPECT_EQ(to_bus.stages.back().ns, 270 * k_us);
  EXPECT_EQ(to_bus.maximum_reaction_time_ns, to_bus.total_ns + 20 * k_ms);
  EXPECT_EQ(to_bus.maximum_data_age_ns, to_bus.total_ns + 16 * k_ms);
  EXPECT_EQ(to_bus.jitter_ns, to_bus.total_ns - (9 * k_ms + 108 * k_us));
  EXPECT_EQ(found.can[0].response_ns, *found.groups[1].response_ns + 270 * k_us);
}

TEST(Assessment, SaysWhichDeadlineIsMissedAndByHowMuch) {
  AnalysisInput input = small_input();
  input.frame_to_can_deadline_ns = 3 * k_ms;
  input.model.groups[1].deadline_ns = 40 * k_us;
  const Assessment found = assess(input);
  ASSERT_EQ(found.missed_deadlines.size(), 2U);
  EXPECT_EQ(found.missed_deadlines[0], "group tick: bound 82.0 us, deadline 40.0 us");
  EXPECT_EQ(found.missed_deadlines[1].substr(0, 24), "chain frame_to_can: boun");
}

TEST(Sensitivity, FindsTheFactorThatAnIndependentSearchFinds) {
  AnalysisInput input = small_input();
  input.model.system = {};
  input.model.groups[0].deadline_ns = 1 * k_ms;
  // Frame group: 400 us of jitter and 50 of the tick. 600 - 50 us remain for 100 us of nodes.
  const auto group = largest_factor(input, [](std::size_t g, std::size_t) { return g == 0; });
  ASSERT_TRUE(group);
  EXPECT_NEAR(*group, 5.5, 0.001);
  EXPECT_NEAR(slack_percent(*group), 450, 0.1);
  // One node of 60 us alone: 600 - 50 - 40 us remain.
  const auto node =
      largest_factor(input, [](std::size_t g, std::size_t n) { return g == 0 && n == 0; });
  EXPECT_NEAR(*node, 510.0 / 60, 0.001);
  // All nodes: 600 / 150.
  const auto all = largest_factor(
      input, [](std::size_t, std::size_t) { return true; }, true);
  EXPECT_NEAR(*all, 4.0, 0.001);
  // The returned factor holds; a slightly larger one does not.
  for (const double factor : {*all, *all * 1.001}) {
    AnalysisInput scaled_input = input;
    scaled_input.model = scaled(
        input.model, factor, [](std::size_t, std::size_t) { return true; }, true);
    EXPECT_EQ(assess(scaled_input).holds(), factor == *all);
  }
}

TEST(Sensitivity, IsNegativeWhereADeadlineIsMissedAndNoneWhereNothingHelps) {
  AnalysisInput input = small_input();
  input.model.system = {};
  input.model.groups[1].deadline_ns = 40 * k_us;  // the tick needs 50
  const auto factor = largest_factor(input, [](std::size_t, std::size_t) { return true; });
  ASSERT_TRUE(factor);
  EXPECT_NEAR(slack_percent(*factor), -20, 0.1);
  input.frame_to_can_deadline_ns = 1 * k_ms;  // sampling alone takes 4
  EXPECT_FALSE(largest_factor(input, [](std::size_t, std::size_t) { return true; }));
}

// Chain by brute force: frames and ticks have any phase, and each group takes its worst-case
// response. No pose reaches the bus after the bound, and none is older than the maximum data age.
TEST(Assessment, NoPhaseOfFramesAndTicksIsLaterThanTheChainsBounds) {
  AnalysisInput input = small_input();
  input.model.system = {};
  const Assessment found = assess(input);
  const std::int64_t frame_ns = *found.groups[0].response_ns - 400 * k_us;
  const std::int64_t tick_ns = *found.groups[1].response_ns;
  std::int64_t latest = 0, oldest = 0;
  for (std::int64_t phase = 0; phase < 4 * k_ms; phase += 5 * k_us) {
    const auto published = [&](int n) {
      return phase + n * 20 * k_ms + 1 * k_ms + 8 * k_ms + 400 * k_us + frame_ns;
    };
    // Tick k reads at 4k ms. A frame published at exactly that time misses it.
    const auto first_tick = [&](int n) { return (published(n) / (4 * k_ms) + 1) * 4 * k_ms; };
    const std::int64_t mid = phase + 0;
    const std::int64_t wire = tick_ns + 270 * k_us;
    latest = std::max(latest, first_tick(0) + wire - mid);
    oldest = std::max(oldest, first_tick(1) - 4 * k_ms + wire - mid);
  }
  EXPECT_LE(latest, found.chains[1].total_ns);
  EXPECT_LE(oldest, found.chains[1].maximum_data_age_ns);
  EXPECT_GT(latest, found.chains[1].total_ns - 10 * k_us);
  EXPECT_GT(oldest, found.chains[1].maximum_data_age_ns - 10 * k_us);
}

}  // namespace
}  // namespace glint::assessment_test

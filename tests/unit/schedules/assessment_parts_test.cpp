// Parts of a schedule's assessment, each by itself: deadlines, rows and frames.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "small_question.hpp"

namespace glint::assessment_parts_test {
namespace {

using test::k_ms;
using test::k_us;
using test::small_input;

// Each deadline at its bound, then 1 us below it: exactly one line names what misses its deadline.
TEST(Assessment, HoldsUpToEachDeadlineAndNamesWhatIsLateBeyond) {
  const AnalysisInput input = small_input();
  const Assessment within = assess(input);
  ASSERT_TRUE(within.holds());
  struct Case {
    const char* name;
    std::int64_t bound_ns;
    std::int64_t& (*deadline)(AnalysisInput&);
  };
  const Case cases[] = {
      {"group frame", *within.groups[0].response_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.model.groups[0].deadline_ns; }},
      {"group tick", *within.groups[1].response_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.model.groups[1].deadline_ns; }},
      {"CAN frame pose", *within.can[0].response_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.frames[0].deadline_ns; }},
      {"CAN frame drive", *within.can[1].response_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.frames[1].deadline_ns; }},
      {"chain frame_to_can", within.chains[0].total_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.frame_to_can_deadline_ns; }},
      {"chain mid_exposure_to_bus", within.chains[1].total_ns,
       [](AnalysisInput& q) -> std::int64_t& { return q.age_deadline_ns; }},
  };
  for (const Case& c : cases) {
    AnalysisInput tight = input;
    c.deadline(tight) = c.bound_ns;
    EXPECT_TRUE(assess(tight).holds()) << c.name;
    c.deadline(tight) -= 1'000;
    const Assessment late = assess(tight);
    ASSERT_EQ(late.missed_deadlines.size(), 1U) << c.name;
    const auto in_us = [](std::int64_t ns) {
      const std::int64_t tenths = ns / 100;
      return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " us";
    };
    EXPECT_EQ(late.missed_deadlines[0], c.name + (": bound " + in_us(c.bound_ns)) + ", deadline " +
                                            in_us(c.bound_ns - 1'000));
  }
}

// A group's rows add up to its response without the jitter. Two cores have two wake-ups.
TEST(Assessment, SplitsEachResponseIntoItsRowsOnTwoCores) {
  AnalysisInput input = small_input();
  input.model.cores = 2;
  input.model.system.inter_core_delay_ns = 3 * k_us;
  input.model.groups[0] = staged_group({{"Find", 2, 60 * k_us}, {"Fit", 2, 40 * k_us}});
  input.model.groups[0].min_gap_ns = input.model.groups[0].deadline_ns = 20 * k_ms;
  input.model.groups[0].jitter_ns = 400 * k_us;
  input.plan = synthesize(input.model);
  const Assessment found = assess(input);
  ASSERT_TRUE(found.holds()) << found.missed_deadlines.front();
  ASSERT_EQ(found.groups[0].times.cores_used, 2);
  ASSERT_EQ(found.groups[1].times.cores_used, 1);
  const Chain& chain = found.chains.at(1);
  const auto row = [&](const std::string& name) {
    std::int64_t ns = 0;
    for (const ChainStage& stage : chain.stages) ns += stage.name == name ? stage.ns : 0;
    return ns;
  };
  EXPECT_EQ(row("frame: wake-up"), 40 * k_us);
  EXPECT_EQ(row("tick: wake-up"), 20 * k_us);
  EXPECT_EQ(row("CAN write"), 10 * k_us) << "both frames";
  EXPECT_EQ(row("frame: wake-up") + row("frame: nodes and preemption") +
                row("frame: interrupts, hand-over, writes"),
            *found.groups[0].response_ns - 400 * k_us);
  EXPECT_EQ(row("tick: wake-up") + row("tick: nodes and preemption") + row("tick: interrupts") +
                row("CAN write"),
            *found.groups[1].response_ns);
}

TEST(Assessment, TakesTheFirstWriteAloneForFrameToCanAndNoneWhereNoneIsWritten) {
  AnalysisInput input = small_input();
  for (const int writes : {0, 1, 5}) {
    input.model.groups[1].can_writes = writes;
    const Assessment found = assess(input);
    ASSERT_TRUE(found.holds()) << found.missed_deadlines.front();
    EXPECT_EQ(found.chains[0].stages.back().name, "CAN write");
    EXPECT_EQ(found.chains[0].stages.back().ns, (writes > 0 ? 5 : 0) * k_us) << writes;
  }
}

// Own frames at the tick's rate carry poses. The slowest of them determines the bound.
TEST(Assessment, EndsTheChainWithTheSlowestFrameThatCarriesAPose) {
  AnalysisInput input = small_input();
  const Assessment alone = assess(input);
  const auto bus_ns = [](const Assessment& found) { return found.chains.at(1).stages.back().ns; };
  CanMessage rare = input.frames[0];
  rare.name = "heartbeat";
  rare.identifier = 0x720;
  rare.period_ns = rare.deadline_ns = 100 * k_ms;
  rare.fifo = false;
  CanMessage foreign = input.frames[1];
  foreign.name = "slow";
  foreign.identifier = 0x7FF;
  foreign.period_ns = foreign.deadline_ns = 4 * k_ms;
  input.frames = {rare, input.frames[0], foreign, input.frames[1]};
  const Assessment more = assess(input);
  ASSERT_TRUE(more.holds()) << more.missed_deadlines.front();
  const std::int64_t tick_ns = *more.groups[1].response_ns;
  EXPECT_EQ(bus_ns(more), *more.can[1].response_ns - tick_ns);
  EXPECT_LT(bus_ns(more), *more.can[0].response_ns - tick_ns) << "the heartbeat is slower";
  EXPECT_GT(bus_ns(more), bus_ns(alone)) << "one frame more goes ahead";
  // A second pose frame, shorter and of lower priority: it waits for the first as well.
  CanMessage second = rare;
  second.name = "buttons";
  second.identifier = 0x1A4;
  second.shape.data_bytes = 1;
  second.period_ns = second.deadline_ns = 4 * k_ms;
  for (const bool listed_first : {false, true}) {
    AnalysisInput two = input;
    two.frames.insert(listed_first ? two.frames.begin() : two.frames.end(), second);
    const Assessment both = assess(two);
    ASSERT_TRUE(both.holds()) << both.missed_deadlines.front();
    const CanResponse& slowest = listed_first ? both.can.front() : both.can.back();
    EXPECT_EQ(slowest.frame_ns, 65 * k_us);
    EXPECT_EQ(bus_ns(both), *slowest.response_ns - *both.groups[1].response_ns);
    EXPECT_GT(bus_ns(both), bus_ns(more));
    EXPECT_EQ(both.chains[1].jitter_ns, both.chains[1].total_ns - 9 * k_ms - 52 * k_us);
  }
}

TEST(Assessment, HasNoChainWhereAGroupHasNoBound) {
  AnalysisInput input = small_input();
  input.model.groups[1].nodes[0].bound_ns = 5 * k_ms;  // a tick comes every 4 ms
  const Assessment found = assess(input);
  EXPECT_EQ(found.missed_deadlines,
            (std::vector<std::string>{"group frame: bound none, deadline 20000.0 us",
                                      "group tick: bound none, deadline 4000.0 us"}));
  EXPECT_TRUE(found.chains.empty());
  ASSERT_EQ(found.can.size(), 2U);
  EXPECT_FALSE(found.can[0].response_ns || found.can[1].response_ns);
}

TEST(Assessment, HasNoChainToABusThatIsFull) {
  AnalysisInput input = small_input();
  input.frames[1].period_ns = 100 * k_us;
  const Assessment found = assess(input);
  ASSERT_EQ(found.missed_deadlines.size(), 2U);
  EXPECT_EQ(found.missed_deadlines[0], "CAN frame pose: bound none, deadline 4000.0 us");
  EXPECT_EQ(found.missed_deadlines[1], "CAN frame drive: bound none, deadline 10000.0 us");
  ASSERT_EQ(found.chains.size(), 1U);
  EXPECT_EQ(found.chains[0].name, "frame_to_can");
}

// The tick's response is jitter of the frames that the tick sends, and of no others.
TEST(Assessment, AddsTheTicksResponseToTheJitterOfItsOwnFramesAlone) {
  AnalysisInput input = small_input();
  input.frames[0].jitter_ns = 7 * k_us;
  const Assessment found = assess(input);
  std::vector<CanMessage> frames = input.frames;
  frames[0].jitter_ns += *found.groups[1].response_ns;
  const std::vector<CanResponse> expected = can_responses(frames, input.rates);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(found.can[f].response_ns, expected[f].response_ns) << f;
    EXPECT_EQ(found.can[f].frame_ns, expected[f].frame_ns) << f;
  }
}

}  // namespace
}  // namespace glint::assessment_parts_test

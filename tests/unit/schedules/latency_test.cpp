// Latency chains: stages, totals and deadlines, with a different duration for each part.
#include "schedules/latency.hpp"

#include <gtest/gtest.h>

namespace glint::latency_test {
namespace {

ChainParts distinct_parts() {
  ChainParts parts;
  parts.sensor = {2'000, 30'000};
  parts.arrival_jitter_ns = 400;
  parts.frame_gap_ns = 5'000'000;
  parts.tick_gap_ns = 700'000;
  parts.frame = {
      .bound_ns = 11, .blocking_ns = 12, .wake_up_ns = 13, .system_ns = 14, .writes_ns = 15};
  parts.tick = {
      .bound_ns = 21, .blocking_ns = 22, .wake_up_ns = 23, .system_ns = 24, .writes_ns = 25};
  parts.first_write_ns = 8;
  parts.bus_ns = 90'000;
  parts.bus_min_ns = 80'000;
  parts.frame_to_can_deadline_ns = 1'111;
  parts.age_deadline_ns = 2'222;
  return parts;
}

void expect_stages(const Chain& chain, const std::vector<ChainStage>& expected) {
  ASSERT_EQ(chain.stages.size(), expected.size());
  std::int64_t total = 0, estimates = 0;
  for (std::size_t s = 0; s < expected.size(); ++s) {
    EXPECT_EQ(chain.stages[s].name, expected[s].name) << s;
    EXPECT_EQ(chain.stages[s].kind, expected[s].kind) << expected[s].name;
    EXPECT_EQ(chain.stages[s].ns, expected[s].ns) << expected[s].name;
    total += expected[s].ns;
    estimates += expected[s].kind == StageKind::estimate ? expected[s].ns : 0;
  }
  EXPECT_EQ(chain.total_ns, total);
  EXPECT_EQ(chain.estimate_ns, estimates);
}

std::vector<ChainStage> group_stages(std::int64_t writes_ns) {
  return {{"frame: wake-up", StageKind::estimate, 13},
          {"frame: blocked by a slice", StageKind::bound, 12},
          {"frame: nodes and preemption", StageKind::bound, 11},
          {"frame: interrupts, hand-over, writes", StageKind::estimate, 14},
          {"sampling", StageKind::bound, 700'000},
          {"tick: wake-up", StageKind::estimate, 23},
          {"tick: blocked by a slice", StageKind::bound, 22},
          {"tick: nodes and preemption", StageKind::bound, 21},
          {"tick: interrupts", StageKind::estimate, 24},
          {"CAN write", StageKind::estimate, writes_ns}};
}

TEST(Latency, OfFrameToCanEndsWithTheFirstWrite) {
  const std::vector<Chain> chains = chains_of(distinct_parts());
  ASSERT_EQ(chains.size(), 2U);
  const Chain& chain = chains[0];
  EXPECT_EQ(chain.name, "frame_to_can");
  EXPECT_EQ(chain.deadline_ns, 1'111);
  expect_stages(chain, group_stages(8));
  EXPECT_EQ(chain.maximum_reaction_time_ns, chain.total_ns + 5'000'000);
  EXPECT_EQ(chain.maximum_data_age_ns, chain.total_ns - 700'000 + 5'000'000);
  EXPECT_EQ(chain.jitter_ns, chain.total_ns) << "it may take no time at all";
}

TEST(Latency, OfMidExposureToBusBeginsAtTheLightAndEndsWithTheLastFrame) {
  const std::vector<Chain> chains = chains_of(distinct_parts());
  ASSERT_EQ(chains.size(), 2U);
  const Chain& chain = chains[1];
  EXPECT_EQ(chain.name, "mid_exposure_to_bus");
  EXPECT_EQ(chain.deadline_ns, 2'222);
  std::vector<ChainStage> expected = {{"half the exposure", StageKind::declared, 1'000},
                                      {"readout and transport", StageKind::declared, 30'000},
                                      {"transport jitter", StageKind::declared, 400}};
  for (const ChainStage& stage : group_stages(25)) expected.push_back(stage);
  expected.push_back({"CAN: queue and bus", StageKind::bound, 90'000});
  expect_stages(chain, expected);
  EXPECT_EQ(chain.maximum_reaction_time_ns, chain.total_ns + 5'000'000);
  EXPECT_EQ(chain.maximum_data_age_ns, chain.total_ns - 700'000 + 5'000'000);
  EXPECT_EQ(chain.jitter_ns, chain.total_ns - 1'000 - 30'000 - 80'000);
}

TEST(Latency, HasNoChainToABusWithoutABound) {
  ChainParts parts = distinct_parts();
  parts.bus_ns.reset();
  const std::vector<Chain> chains = chains_of(parts);
  ASSERT_EQ(chains.size(), 1U);
  expect_stages(chains[0], group_stages(8));
}

TEST(Latency, HasARowForASliceOnlyWhereItBlocks) {
  ChainParts parts = distinct_parts();
  parts.frame.blocking_ns = 1;
  parts.tick.blocking_ns = 0;
  const Chain chain = chains_of(parts).at(0);
  ASSERT_EQ(chain.stages.size(), 9U);
  EXPECT_EQ(chain.stages[1].name, "frame: blocked by a slice");
  EXPECT_EQ(chain.stages[1].ns, 1);
  EXPECT_EQ(chain.stages[6].name, "tick: nodes and preemption");
}

TEST(Latency, NamesEachKindOfStage) {
  EXPECT_STREQ(name_of(StageKind::bound), "bound");
  EXPECT_STREQ(name_of(StageKind::estimate), "estimate");
  EXPECT_STREQ(name_of(StageKind::declared), "declared");
}

}  // namespace
}  // namespace glint::latency_test

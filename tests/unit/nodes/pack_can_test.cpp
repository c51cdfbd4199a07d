#include "nodes/pack_can.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace glint {
namespace {

// Counts frames by identifier over one second of 250 Hz ticks, and what the node counted.
std::map<std::uint32_t, int> one_second(const PackCanSettings& settings, TrackState second_half,
                                        graph::LoopCounts* counted = nullptr) {
  PackCan node;
  node.settings = settings;
  auto samples = std::make_unique<PoseSamples>();
  auto frames = std::make_unique<CanFrames>();
  samples->count = 1;
  std::map<std::uint32_t, int> seen;
  for (std::uint32_t i = 0; i < 250; ++i) {
    Now now{Time{} + milliseconds(4 * i), i, 1'700'000'000'000'000'000};
    samples->items[0].tick = now.tick;
    samples->items[0].tick_number = i;
    samples->items[0].state = i < 125 ? TrackState::measured : second_half;
    node(now, *samples, *frames);
    for (const CanFrame& frame : frames->frames()) ++seen[frame.identifier];
    for (std::size_t loop = 0; counted != nullptr && loop < PackCan::k_loops.size(); ++loop) {
      (*counted)[loop] += node.counts()[loop];
    }
  }
  return seen;
}

TEST(PackCan, SendsFiveClassicFramesATickAndTheNodesOwnAtTheirRates) {
  const auto seen = one_second({}, TrackState::measured);
  for (std::uint32_t id = 0x1A0; id <= 0x1A4; ++id) EXPECT_EQ(seen.at(id), 250) << id;
  EXPECT_EQ(seen.at(0x720), 10);
  EXPECT_EQ(seen.at(0x1AE), 1);
  EXPECT_EQ(seen.at(0x1AF), 1);
  EXPECT_EQ(seen.count(0x0A0), 0u);
}

TEST(PackCan, SendsOneFdFrameATickInsteadWhereChosen) {
  PackCanSettings settings;
  settings.format = CanFormat::fd;
  const auto seen = one_second(settings, TrackState::measured);
  EXPECT_EQ(seen.at(0x1A8), 250);
  EXPECT_EQ(seen.count(0x1A0), 0u);
}

TEST(PackCan, SendsOneEmergencyWhenAToolIsLost) {
  EXPECT_EQ(one_second({}, TrackState::lost).at(0x080 + 32), 1);
}

TEST(PackCan, CountsThePosesAndTheFramesOfItsOwn) {
  graph::LoopCounts counted{};
  const auto seen = one_second({}, TrackState::lost, &counted);
  EXPECT_EQ(counted[0], 250);
  EXPECT_EQ(counted[1], 250);
  EXPECT_EQ(counted[2], seen.at(0x080 + 32));
  EXPECT_EQ(counted[3], seen.at(0x720) + seen.at(0x1AE) + seen.at(0x1AF));
}

// The states of the heartbeats over three seconds in which frames arrive up to `last_frame`.
std::vector<int> heartbeats(Time first_frame, Time last_frame) {
  PackCan node;
  auto samples = std::make_unique<PoseSamples>();
  auto frames = std::make_unique<CanFrames>();
  std::vector<int> states;
  for (std::uint64_t i = 0; i < 750; ++i) {
    const Now now{Time{} + milliseconds(4) * static_cast<std::int64_t>(i), i, 0};
    samples->any_frame = now.tick >= first_frame;
    samples->newest_frame = std::min(now.tick, last_frame);
    node(now, *samples, *frames);
    for (const CanFrame& frame : frames->frames()) {
      if (frame.identifier == 0x720) states.push_back(frame.data[0]);
    }
  }
  return states;
}

TEST(PackCan, BootsUpAndIsPreOperationalUntilTheFirstFrame) {
  const auto states = heartbeats(Time{} + milliseconds(1000), Time{} + milliseconds(9000));
  ASSERT_EQ(states.size(), 30u);
  EXPECT_EQ(states[0], 0x00);
  for (std::size_t i = 1; i < 30; ++i) EXPECT_EQ(states[i], i < 10 ? 0x7F : 0x05) << i;
}

TEST(PackCan, IsPreOperationalWhenFramesNoLongerCome) {
  const auto states = heartbeats(Time{}, Time{} + milliseconds(1000));
  ASSERT_EQ(states.size(), 30u);
  for (std::size_t i = 1; i < 30; ++i) EXPECT_EQ(states[i], i <= 15 ? 0x05 : 0x7F) << i;
}

}  // namespace
}  // namespace glint

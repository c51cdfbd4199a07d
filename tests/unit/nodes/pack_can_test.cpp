#include "nodes/pack_can.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace glint {
namespace {

// Frames by identifier over one second of ticks at 250 Hz, and the node's own counts.
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

// Ticks of one node at given times in ms after the start. Counts its own frames per tick.
class OwnFrames : public testing::Test {
 protected:
  std::vector<CanFrame> at(std::int64_t ms) {
    (*node_)({Time{} + milliseconds(ms), static_cast<std::uint64_t>(ms), k_unix_offset_ns},
             *samples_, *frames_);
    const auto all = frames_->frames();
    return {all.begin(), all.end()};
  }
  int count_at(std::int64_t ms, std::uint32_t identifier) {
    int count = 0;
    for (const CanFrame& frame : at(ms)) count += frame.identifier == identifier ? 1 : 0;
    return count;
  }
  static constexpr std::int64_t k_unix_offset_ns = 1'700'000'000'123'456'789;
  std::unique_ptr<PackCan> node_ = std::make_unique<PackCan>();
  std::unique_ptr<PoseSamples> samples_ = std::make_unique<PoseSamples>();
  std::unique_ptr<CanFrames> frames_ = std::make_unique<CanFrames>();
};

// A period starts at the tick that was due. Skipped frames are not sent later.
TEST_F(OwnFrames, AreDueAPeriodAfterTheLast) {
  EXPECT_EQ(count_at(0, 0x720), 1);
  EXPECT_EQ(count_at(99, 0x720), 0);
  EXPECT_EQ(count_at(100, 0x720), 1);
  EXPECT_EQ(count_at(450, 0x720), 1);
  EXPECT_EQ(count_at(500, 0x720), 0);
  EXPECT_EQ(count_at(550, 0x720), 1);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1, 0, 0, 1}}));
}

TEST_F(OwnFrames, OfTimeArePairsWhoseCounterRisesModuloSixteen) {
  const TimeSync sync{.base_identifier = k_can_base_default};
  for (int second = 0; second < 35; ++second) {
    const std::int64_t unix_ns = second * 1'000'000'000LL + k_unix_offset_ns;
    const auto counter = static_cast<std::uint8_t>(second % 16);
    const std::vector<CanFrame> frames = at(1000 * second);
    ASSERT_EQ(frames.size(), 3U) << "heartbeat and the pair";
    EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1, 0, 0, 3}}));
    const auto begin = time_sync_frame(sync, counter, unix_ns);
    const auto follow_up = time_follow_up_frame(sync, counter, unix_ns, unix_ns);
    ASSERT_TRUE(begin && follow_up);
    EXPECT_EQ(frames[1].identifier, begin.value.identifier);
    EXPECT_EQ(frames[1].data, begin.value.data) << second;
    EXPECT_EQ(frames[2].identifier, follow_up.value.identifier);
    EXPECT_EQ(frames[2].data, follow_up.value.data) << second;
  }
}

// Only at changes of state, separately for each tool.
TEST_F(OwnFrames, OfEmergencyComeWhereAToolIsLostOrFoundAgain) {
  samples_->count = 2;
  std::int64_t ms = 1;
  const auto emergencies = [&](TrackState first, TrackState second) {
    samples_->items[0].state = first;
    samples_->items[1].state = second;
    const int count = count_at(ms++, 0x080 + 32);
    EXPECT_EQ(node_->counts()[1], 2);
    EXPECT_EQ(node_->counts()[2], count);
    return count;
  };
  using enum TrackState;
  EXPECT_EQ(emergencies(none, none), 0);
  EXPECT_EQ(emergencies(measured, lost), 1) << "lost before it was found";
  EXPECT_EQ(emergencies(predicted, lost), 0);
  EXPECT_EQ(emergencies(lost, lost), 1);
  EXPECT_EQ(emergencies(lost, none), 0);
  EXPECT_EQ(emergencies(predicted, measured), 1) << "found again; the other was not lost";
  EXPECT_EQ(emergencies(lost, lost), 2);
  EXPECT_EQ(emergencies(measured, predicted), 2);
}

TEST_F(OwnFrames, AreOfNoMoreToolsThanTheCellHas) {
  node_->limits.tools = 3;
  samples_->count = 5;
  (void)at(1);
  EXPECT_EQ(node_->counts()[1], 3);
  samples_->count = 2;
  (void)at(2);
  EXPECT_EQ(node_->counts()[1], 2);
}

// States of the heartbeats over three seconds; frames arrive until `last_frame`.
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

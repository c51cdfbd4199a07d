#include "nodes/pack_can.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>

namespace glint {
namespace {

// Counts frames by identifier over one second of 250 Hz ticks.
std::map<std::uint32_t, int> one_second(const PackCanSettings& settings, TrackState second_half) {
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

}  // namespace
}  // namespace glint

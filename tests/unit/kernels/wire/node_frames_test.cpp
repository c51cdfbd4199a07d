#include "kernels/wire/node_frames.hpp"

#include <gtest/gtest.h>

#include "kernels/wire/crc.hpp"
#include "tests/unit/kernels/wire/hex.hpp"

namespace glint::node_frames_test {
namespace {

TEST(NodeFrames, BeatAsCanOpenSays) {
  const CanFrame frame = heartbeat_frame(32, CanNodeState::operational);
  EXPECT_EQ(frame.identifier, 0x720U);
  EXPECT_EQ(hex_of(frame.bytes()), "05");
  EXPECT_EQ(hex_of(heartbeat_frame(1, CanNodeState::pre_operational).bytes()), "7F");
}

TEST(NodeFrames, TellAnEmergencyAndItsEnd) {
  PoseSample sample;
  sample.tool = 2;
  sample.state = TrackState::lost;
  sample.reason = Reason::too_old;
  sample.registration = RegistrationState::given;
  const CanFrame frame = emergency_frame(32, sample);
  EXPECT_EQ(frame.identifier, 0xA0U);
  EXPECT_EQ(hex_of(frame.bytes()), "0CFF8102030C0100");
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  EXPECT_EQ(hex_of(emergency_frame(32, sample).bytes()), "0000000202000100");
}

// Receiver's CRC check of a CanTSyn frame.
bool check(const CanFrame& frame, const TimeSync& sync) {
  std::vector<std::uint8_t> covered(frame.data.begin() + 2, frame.data.begin() + 8);
  covered.push_back(sync.data_ids[frame.data[2] & 0xFU]);
  return frame.data[1] == crc8_h2f(covered);
}

TEST(Overrun, NamesItsReasonItsGroupAndTheLastNodeThatRan) {
  const CanFrame frame = overrun_frame(32, {1, 2, Reason::overrun_predicted, 7});
  EXPECT_EQ(frame.identifier, 0xA0u);
  EXPECT_EQ(hex_of(frame.bytes()), "15FF810102150007");
}

TEST(NodeFrames, CarryTheTimeInTwoFrames) {
  TimeSync sync;
  sync.domain = 3;
  constexpr std::int64_t k_time = 1'700'000'000'987'654'321;
  const auto first = time_sync_frame(sync, 9, k_time);
  const auto second = time_follow_up_frame(sync, 9, k_time, k_time + 20'000'000);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first.value.identifier, 0x1AEU);
  EXPECT_EQ(second.value.identifier, 0x1AFU);
  EXPECT_EQ(first.value.data[0], 0x20);
  EXPECT_EQ(second.value.data[0], 0x28);
  EXPECT_EQ(hex_of(first.value.bytes()).substr(4),
            "3900"
            "6553F100");  // 1700000000
  EXPECT_EQ(hex_of(second.value.bytes()).substr(4),
            "3901"
            "0074CBB1");  // one second, 7654321 ns
  for (const CanFrame& frame : {first.value, second.value}) {
    EXPECT_TRUE(check(frame, sync));
    for (int bit = 8; bit < 64; ++bit) EXPECT_FALSE(check(flipped(frame, bit), sync)) << bit;
  }
}

TEST(NodeFrames, RefuseTimesThatDoNotFit) {
  const TimeSync sync;
  EXPECT_FALSE(time_sync_frame(sync, 0, -1));
  EXPECT_FALSE(time_sync_frame(sync, 0, 4'294'967'296'000'000'000));
  EXPECT_TRUE(time_sync_frame(sync, 0, 4'294'967'295'999'999'999));
  EXPECT_TRUE(time_follow_up_frame(sync, 0, 1'000'000'000, 4'999'999'999));
  EXPECT_FALSE(time_follow_up_frame(sync, 0, 1'000'000'000, 5'000'000'000));
  EXPECT_FALSE(time_follow_up_frame(sync, 0, 1'000'000'000, 999'999'999));
}

// The first and the last time of each field, and one beyond each.
TEST(NodeFrames, TakeTimesFrom1970ToTheLastThatTheFieldsHold) {
  const TimeSync sync;
  EXPECT_TRUE(time_sync_frame(sync, 0, 0));
  EXPECT_TRUE(time_follow_up_frame(sync, 0, 0, 0));
  EXPECT_FALSE(time_follow_up_frame(sync, 0, -1, 0));
  EXPECT_FALSE(time_follow_up_frame(sync, 0, 0, -1));
  for (int seconds = 0; seconds <= 5; ++seconds) {
    const auto frame = time_follow_up_frame(sync, 0, 500, 1'000'000'000LL * seconds + 7);
    EXPECT_EQ(frame.reason, seconds <= 3 ? Reason::none : Reason::out_of_range) << seconds;
    if (!frame) continue;
    EXPECT_EQ(frame.value.data[3], seconds);
    EXPECT_EQ(frame.value.data[7], 7);
  }
}

TEST(NodeFrames, CheckEachFrameByTheIdentifierAtItsCounter) {
  TimeSync sync;
  sync.base_identifier = 0x200;
  for (std::uint8_t i = 0; i < 16; ++i) sync.data_ids[i] = static_cast<std::uint8_t>(91 * i + 17);
  for (std::uint8_t counter = 0; counter < 32; ++counter) {
    const auto first = time_sync_frame(sync, counter, 1'000'000'000);
    const auto second = time_follow_up_frame(sync, counter, 1'000'000'000, 1'000'000'001);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first.value.identifier, 0x20EU);
    EXPECT_EQ(second.value.identifier, 0x20FU);
    for (const CanFrame& frame : {first.value, second.value}) {
      EXPECT_EQ(frame.length, 8);
      EXPECT_EQ(frame.data[2] & 0xF, counter % 16);
      EXPECT_TRUE(check(frame, sync)) << int{counter};
    }
  }
}

TEST(NodeFrames, TakeTheNodeModulo128) {
  for (const unsigned node : {1U, 127U, 129U}) {
    EXPECT_EQ(heartbeat_frame(node, CanNodeState::boot_up).identifier, 0x700 + node % 128);
    EXPECT_EQ(emergency_frame(node, {}).identifier, 0x80 + node % 128);
    EXPECT_EQ(overrun_frame(node, {}).identifier, 0x80 + node % 128);
  }
}

}  // namespace
}  // namespace glint::node_frames_test

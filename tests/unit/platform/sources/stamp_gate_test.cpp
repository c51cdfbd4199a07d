#include "platform/sources/stamp_gate.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

constexpr Duration k_period = milliseconds(20);

Time at(std::int64_t ms) { return Time{} + milliseconds(ms); }

TEST(StampGate, TakesAscendingStampsAndCountsLongGaps) {
  StampGate gate(k_period);
  for (const std::int64_t ms : {500, 520, 1520, 2521, 14'521}) EXPECT_TRUE(gate.take(at(ms))) << ms;
  EXPECT_EQ(gate.counts().gaps, 2u);  // 1 s is not yet a gap
  EXPECT_EQ(gate.counts().longest_gap, milliseconds(12'000));
  EXPECT_EQ(gate.offset(), Duration{});
}

TEST(StampGate, SkipsDoubledAndBackwardStamps) {
  StampGate gate(k_period);
  EXPECT_TRUE(gate.take(at(100)));
  EXPECT_FALSE(gate.take(at(100)));
  EXPECT_FALSE(gate.take(at(60)));
  EXPECT_TRUE(gate.take(at(120)));
  EXPECT_EQ(gate.counts().doubled, 1u);
  EXPECT_EQ(gate.counts().backward, 1u);
  EXPECT_EQ(gate.counts().restarts, 0u);
}

TEST(StampGate, SkipsOneStampFarOff) {
  StampGate gate(k_period);
  EXPECT_TRUE(gate.take(at(0)));
  EXPECT_FALSE(gate.take(Time{} + k_stamp_step_max + Duration{1}));
  EXPECT_FALSE(gate.take(Time{INT64_MAX}));
  EXPECT_FALSE(gate.take(Time{INT64_MIN}));
  EXPECT_TRUE(gate.take(at(20)));
  EXPECT_EQ(gate.counts().far_off, 3u);
  EXPECT_TRUE(gate.take(at(20) + k_stamp_step_max));
}

TEST(StampGate, RefusesAFirstStampBeyondItsRange) {
  StampGate gate(k_period);
  EXPECT_FALSE(gate.take(Time{k_stamp_max.nanoseconds + 1}));
  EXPECT_TRUE(gate.take(k_stamp_max));
}

// After a restart the time continues one nominal gap after the last accepted frame.
TEST(StampGate, FollowsAClockThatRestarts) {
  for (const std::int64_t restart_ms : {0, 400'000'000}) {
    StampGate gate(k_period);
    EXPECT_TRUE(gate.take(at(1'000'000)));
    for (int i = 0; i < k_restart_stamps; ++i) {
      EXPECT_FALSE(gate.take(at(restart_ms + 20 * i))) << i;
    }
    const Time first = at(restart_ms + 20 * k_restart_stamps);
    EXPECT_TRUE(gate.take(first));
    EXPECT_EQ(first + gate.offset(), at(1'000'000) + k_period);
    EXPECT_TRUE(gate.take(first + k_period));
    EXPECT_EQ(gate.counts().restarts, 1u);
    EXPECT_EQ(gate.counts().backward + gate.counts().far_off,
              static_cast<std::uint64_t>(k_restart_stamps));
  }
}

TEST(StampGate, TakesNoRestartFromScatteredStamps) {
  StampGate gate(k_period);
  EXPECT_TRUE(gate.take(at(1'000'000)));
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(gate.take(at(i % 2 == 0 ? 5000 : 100))) << i;
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(gate.take(at(2000 * i))) << i;  // gaps too long
  EXPECT_EQ(gate.counts().restarts, 0u);
}

}  // namespace
}  // namespace glint

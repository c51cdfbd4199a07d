// Error frames of a CAN interface: their kinds, and a reader with a socket pair instead of a bus.
#include "platform/sinks/can/can_errors.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace glint::can_errors_test {
namespace {

// Values of linux/can/error.h, written out.
constexpr canid_t k_error = 0x20000000U;
constexpr canid_t k_controller = 0x04U, k_protocol = 0x08U, k_acknowledge = 0x20U,
                  k_bus_off = 0x40U, k_restarted = 0x100U;

can_frame error_frame(canid_t kinds, std::uint8_t controller = 0) {
  can_frame frame{};
  frame.can_id = k_error | kinds;
  frame.len = 8;
  frame.data[1] = controller;
  return frame;
}

TEST(CanErrors, CountsEachKindOfAFrame) {
  CanErrorCounts counts;
  count_error(error_frame(k_bus_off), counts);
  count_error(error_frame(k_restarted), counts);
  count_error(error_frame(k_controller, 0x08), counts);              // transmit warning
  count_error(error_frame(k_controller, 0x20), counts);              // transmit passive
  count_error(error_frame(k_controller, 0x02), counts);              // transmit overflow
  count_error(error_frame(k_protocol | k_acknowledge), counts);      // two kinds in one
  count_error(error_frame(k_bus_off | k_controller, 0x20), counts);  // likewise
  EXPECT_EQ(counts.bus_off, 2u);
  EXPECT_EQ(counts.restarted, 1u);
  EXPECT_EQ(counts.passive, 3u);
  EXPECT_EQ(counts.overflow, 1u);
  EXPECT_EQ(counts.no_acknowledge, 1u);
  EXPECT_EQ(counts.other, 1u);
}

TEST(CanErrors, IgnoresDataFrames) {
  CanErrorCounts counts;
  can_frame frame = error_frame(k_bus_off);
  frame.can_id &= ~k_error;
  count_error(frame, counts);
  EXPECT_EQ(counts.bus_off, 0u);
}

TEST(CanErrors, ReadsUntilItEnds) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  const Descriptor far(ends[1]);
  const CanErrors errors{Descriptor(ends[0])};
  for (int i = 0; i < 3; ++i) {
    const can_frame frame = error_frame(k_bus_off);
    ASSERT_EQ(::write(far.get(), &frame, sizeof frame), static_cast<ssize_t>(sizeof frame));
  }
  while (errors.counts().bus_off < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(errors.counts().bus_off, 3u);
}

}  // namespace
}  // namespace glint::can_errors_test

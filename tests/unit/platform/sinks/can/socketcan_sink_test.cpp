// Sending of CAN frames, with a socket pair instead of a bus.
#include "platform/sinks/can/socketcan_sink.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace glint::socketcan_sink_test {
namespace {

struct Bus {
  Bus() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
    here = ends[0];
    far = std::make_unique<Descriptor>(ends[1]);
    sink = socketcan_sink_of(Descriptor(here));
  }
  // Receives the next frame as the bus would. Returns its size, or -1.
  ssize_t receive(canfd_frame& raw) const {
    std::memset(&raw, 0xEE, sizeof raw);
    return ::recv(far->get(), &raw, sizeof raw, 0);
  }
  // From now on the sink writes to another file.
  void replace_by(const Descriptor& other) const { ASSERT_EQ(::dup2(other.get(), here), here); }

  int here = -1;
  std::unique_ptr<Descriptor> far;
  std::unique_ptr<CanSink> sink;
};

CanFrame frame_of(bool fd, bool extended, bool bit_rate_switch, std::uint8_t length) {
  CanFrame frame;
  frame.identifier = extended ? 0x12345678 : 0x1A3;
  frame.length = length;
  frame.extended = extended;
  frame.fd = fd;
  frame.bit_rate_switch = bit_rate_switch;
  for (std::size_t i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(3 * i + 1);
  return frame;
}

TEST(SocketCanSink, WritesEachFieldWhereLinuxHasIt) {
  const Bus bus;
  std::uint64_t sent = 0;
  for (const bool fd : {false, true}) {
    for (const bool extended : {false, true}) {
      for (const bool fast : {false, true}) {
        const std::uint8_t length = fd ? 64 : 8;
        const CanFrame frame = frame_of(fd, extended, fd && fast, length);
        EXPECT_TRUE(bus.sink->send(frame, {}));
        ++sent;
        canfd_frame raw{};
        ASSERT_EQ(bus.receive(raw), static_cast<ssize_t>(fd ? CANFD_MTU : CAN_MTU));
        EXPECT_EQ(raw.can_id, frame.identifier | (extended ? CAN_EFF_FLAG : 0U));
        EXPECT_EQ(raw.len, length);
        EXPECT_EQ(raw.flags, fd && fast ? CANFD_BRS : 0);
        EXPECT_TRUE(std::equal(raw.data, raw.data + length, frame.data.begin()));
      }
    }
  }
  const CanSinkCounts counts = bus.sink->counts();
  EXPECT_EQ(counts.sent, sent);
  EXPECT_TRUE(counts.all_sent());
  EXPECT_EQ(counts.error, 0);
}

// A full queue is not an error: the bus is slow.
TEST(SocketCanSink, CountsWhatAFullQueueRefusesAsDropped) {
  const Bus bus;
  const CanFrame frame = frame_of(false, false, false, 8);
  std::uint64_t sent = 0;
  const auto send_alone = [&] {
    bus.sink->begin_set();
    return bus.sink->send(frame, {});
  };
  while (send_alone()) ASSERT_LT(++sent, 1'000'000u);
  EXPECT_FALSE(send_alone());
  CanSinkCounts counts = bus.sink->counts();
  EXPECT_EQ(counts.sent, sent);
  EXPECT_EQ(counts.dropped, 2u);
  EXPECT_EQ(counts.failed, 0u);
  EXPECT_EQ(counts.error, 0);
  canfd_frame raw{};
  while (bus.receive(raw) > 0) {
  }
  EXPECT_TRUE(send_alone()) << "there is room again";
  EXPECT_EQ(bus.sink->counts().sent, sent + 1);
}

// An overloaded bus: each estimate that a receiver gets is complete, and the newest that fitted.
TEST(SocketCanSink, ReplacesEstimatesThatWaitByTheNewest) {
  constexpr int k_ticks = 400, k_frames = 5, k_passed_a_tick = 3;
  const Bus bus;
  std::vector<std::pair<int, int>> received;  // estimate, frame
  std::vector<int> offered_at;                // ticks of the estimates that were accepted
  canfd_frame raw{};
  const auto pass = [&](int frames) {
    for (int i = 0; i < frames && bus.receive(raw) > 0; ++i) {
      received.emplace_back(raw.data[0] + 256 * raw.data[1], raw.data[2]);
    }
  };
  CanFrame frame = frame_of(false, false, false, 8);
  for (int tick = 0; tick < k_ticks; ++tick) {
    bus.sink->begin_set();
    int accepted = 0;
    for (int i = 0; i < k_frames; ++i) {
      frame.data = {static_cast<std::uint8_t>(tick % 256), static_cast<std::uint8_t>(tick / 256),
                    static_cast<std::uint8_t>(i)};
      accepted += bus.sink->send(frame, {}) ? 1 : 0;
    }
    EXPECT_TRUE(accepted == 0 || accepted == k_frames) << "tick " << tick << ": " << accepted;
    if (accepted == k_frames) offered_at.push_back(tick);
    pass(k_passed_a_tick);
  }
  std::size_t before = 0;
  do {
    before = received.size();
    pass(k_ticks * k_frames);
    bus.sink->begin_set();  // sends the rest
  } while (received.size() > before);
  ASSERT_EQ(received.size(), offered_at.size() * k_frames);
  for (std::size_t i = 0; i < received.size(); ++i) {
    const auto expected = std::pair(offered_at[i / k_frames], static_cast<int>(i % k_frames));
    ASSERT_EQ(received[i], expected) << "frame " << i;
  }
  const CanSinkCounts counts = bus.sink->counts();
  EXPECT_GT(counts.sets_replaced, 100u);
  EXPECT_EQ(counts.sets_replaced, static_cast<std::uint64_t>(k_ticks) - offered_at.size());
  EXPECT_EQ(counts.dropped, counts.sets_replaced * k_frames);
  EXPECT_EQ(counts.sent, received.size());
}

TEST(SocketCanSink, KeepsTheReasonOfTheFirstFrameThatFailed) {
  const Bus bus;
  const CanFrame frame = frame_of(false, false, false, 8);
  EXPECT_TRUE(bus.sink->send(frame, {}));
  bus.replace_by(Descriptor(::open("/dev/full", O_WRONLY | O_CLOEXEC)));
  EXPECT_FALSE(bus.sink->send(frame, {}));
  bus.replace_by(Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)));
  EXPECT_FALSE(bus.sink->send(frame, {}));
  bus.sink->flush();
  const CanSinkCounts counts = bus.sink->counts();
  EXPECT_EQ(counts.sent, 1u);
  EXPECT_EQ(counts.dropped, 0u);
  EXPECT_EQ(counts.failed, 2u);
  EXPECT_EQ(counts.error, ENOSPC);
  bus.replace_by(Descriptor(::open("/dev/null", O_WRONLY | O_CLOEXEC)));
  EXPECT_TRUE(bus.sink->send(frame, {})) << "a bus may come back";
  EXPECT_EQ(bus.sink->counts().error, ENOSPC);
}

}  // namespace
}  // namespace glint::socketcan_sink_test

// Thread that reads the buttons, and where it blocks.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/can/can_buttons.hpp"

// Replaces the C library's function: records this thread's sleeps.
namespace {
thread_local std::vector<long>* g_sleeps_ns = nullptr;
}  // namespace

extern "C" int nanosleep(const timespec* wanted, timespec* left) {
  if (g_sleeps_ns != nullptr)
    g_sleeps_ns->push_back(wanted->tv_sec * 1'000'000'000 + wanted->tv_nsec);
  return static_cast<int>(::syscall(SYS_nanosleep, wanted, left));
}

namespace glint::can_buttons_thread_test {
namespace {

constexpr std::uint32_t k_buttons = 0x190;

struct Ends {
  Descriptor pen, here;
};

Ends made() {
  int ends[2] = {-1, -1};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, ends), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// A frame of `size` bytes as the kernel delivers it.
void send(const Descriptor& pen, std::uint8_t bits, std::size_t size) {
  canfd_frame raw{};
  raw.can_id = k_buttons;
  raw.len = 1;
  raw.data[0] = bits;
  ASSERT_EQ(::send(pen.get(), &raw, size, 0), static_cast<ssize_t>(size));
}

// Durations of the sleeps of the calls in `doing`.
template <class Doing>
std::vector<long> sleeps_of(Doing doing) {
  std::vector<long> sleeps;
  g_sleeps_ns = &sleeps;
  doing();
  g_sleeps_ns = nullptr;
  return sleeps;
}

TEST(CanButtonsThread, TakesClassicAndFdFramesButNoneWithoutAByte) {
  Ends ends = made();
  int events = 0;
  CanButtons buttons(std::move(ends.here), k_buttons, {}, [&](const ButtonEvent&) { ++events; });
  send(ends.pen, 1, CAN_MTU);
  send(ends.pen, 2, CANFD_MTU);
  send(ends.pen, 0, 0);
  EXPECT_EQ(buttons.read(milliseconds(1000)), 3);
  EXPECT_EQ(buttons.counts().received, 2u);
  EXPECT_EQ(buttons.counts().refused, 1u);
  EXPECT_EQ(events, 3) << "one down, one up, one down";
}

TEST(CanButtonsThread, SleepsWhereAnInterfaceIsReadyButHasNothing) {
  // Like a removed interface: always ready, but no frame can be received.
  CanButtons buttons(Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)), k_buttons, {}, {});
  const auto sleeps = sleeps_of([&] { EXPECT_EQ(buttons.read(milliseconds(3)), 0); });
  EXPECT_EQ(sleeps, std::vector<long>{3'000'000});
}

TEST(CanButtonsThread, SleepsNeitherAfterAFrameNorAfterItsTime) {
  Ends ends = made();
  CanButtons buttons(std::move(ends.here), k_buttons, {}, {});
  const auto sleeps = sleeps_of([&] {
    EXPECT_EQ(buttons.read(milliseconds(2)), 0) << "poll waited";
    send(ends.pen, 1, CAN_MTU);
    EXPECT_EQ(buttons.read(milliseconds(1000)), 1);
  });
  EXPECT_TRUE(sleeps.empty());
}

TEST(CanButtonsThread, StartsOnceAndAgainAfterAStop) {
  Ends ends = made();
  std::atomic<int> events{0};
  std::array<char, 16> name{};
  CanButtons buttons(std::move(ends.here), k_buttons, {}, [&](const ButtonEvent&) {
    pthread_getname_np(pthread_self(), name.data(), name.size());
    ++events;
  });
  const auto wait_for = [&](int count) {
    for (int waited = 0; events < count && waited < 5'000; ++waited)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(events, count);
  };
  buttons.start();
  buttons.start();  // does nothing
  send(ends.pen, 1, CAN_MTU);
  wait_for(1);
  buttons.stop();
  buttons.stop();
  buttons.start();
  send(ends.pen, 0, CAN_MTU);
  wait_for(2);
  buttons.stop();
  EXPECT_STREQ(name.data(), "glint_buttons");
}

TEST(BoardArrival, IsAsLongBeforeNowAsTheStampUpToTenSeconds) {
  constexpr Time unix_now{1'700'000'000'000'000'000}, board_now{50'000'000'000};
  const auto of_age = [&](std::int64_t age_ns) {
    return monotonic_arrival(unix_now - Duration{age_ns}, unix_now, board_now);
  };
  EXPECT_EQ(of_age(0), board_now);
  EXPECT_EQ(of_age(1), board_now - Duration{1});
  EXPECT_EQ(of_age(10'000'000'000), board_now - milliseconds(10'000));
  EXPECT_EQ(of_age(10'000'000'001), board_now);
  EXPECT_EQ(of_age(-1), board_now);
}

}  // namespace
}  // namespace glint::can_buttons_thread_test

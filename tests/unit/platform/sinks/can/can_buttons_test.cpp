// Reading of button frames from a socket pair instead of a bus.
#include "platform/sinks/can/can_buttons.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <ctime>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"

namespace glint::can_buttons_test {
namespace {

constexpr std::uint32_t k_buttons = 0x190;
constexpr Duration k_unix_minus_steady = {1'000'000'000'000'000};

Time board_now() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return Time{std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec} - k_unix_minus_steady;
}

// One end is the reader, the other the pen.
class SocketPair {
 public:
  explicit SocketPair(ButtonFrames::OnButton on_button, Duration timeout = k_button_timeout)
      : SocketPair(made(), std::move(on_button), timeout) {}

  void send(std::uint8_t bits, std::uint32_t flags = 0) const {
    can_frame raw{};
    raw.can_id = k_buttons | flags;
    raw.can_dlc = 1;
    raw.data[0] = bits;
    ASSERT_EQ(::send(pen_.get(), &raw, sizeof raw, 0), static_cast<ssize_t>(sizeof raw));
  }
  // Starts with the bytes of a valid frame.
  void send_bytes(std::size_t size) const {
    std::vector<std::uint8_t> bytes(std::max(size, sizeof(can_frame)));
    can_frame raw{};
    raw.can_id = k_buttons;
    raw.can_dlc = 1;
    raw.data[0] = 1;
    std::memcpy(bytes.data(), &raw, sizeof raw);
    ASSERT_EQ(::send(pen_.get(), bytes.data(), size, 0), static_cast<ssize_t>(size));
  }
  CanButtons& buttons() { return buttons_; }

 private:
  struct Ends {
    Descriptor pen, here;
  };
  static Ends made() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, ends), 0);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
  }
  SocketPair(Ends ends, ButtonFrames::OnButton on_button, Duration timeout)
      : pen_(std::move(ends.pen)),
        buttons_(std::move(ends.here), k_buttons, k_unix_minus_steady, std::move(on_button),
                 timeout) {}

  Descriptor pen_;
  CanButtons buttons_;
};

// An emulated kernel may not support time stamps.
bool supports_arrival_times() {
  const Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  return ::setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0;
}

// The time stamp of a queued frame is its arrival, not the time of its reading.
TEST(CanButtons, StampAFrameWhenItArrivedNotWhenItWasRead) {
  if (!supports_arrival_times()) GTEST_SKIP() << "no socket here stamps its messages";
  std::vector<ButtonEvent> events;
  SocketPair pair([&](const ButtonEvent& event) { events.push_back(event); });
  const Time before = board_now();
  pair.send(1);
  const Time after = board_now();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(pair.buttons().read(milliseconds(1000)), 1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_GE(events[0].time, before - milliseconds(1));  // the two clocks are compared twice
  EXPECT_LE(events[0].time, after + milliseconds(1));
}

// The kernel uses the Unix clock, which may be set before a frame arrives or while it is queued.
TEST(CanButtons, StampAFrameOnTheBoardsClockWhateverTheUnixClockDoes) {
  const Time board_now{10'000'000'000}, unix_then{1'700'000'000'000'000'000};
  const Duration hour = milliseconds(3'600'000), age = milliseconds(7);
  for (const Duration step : {Duration{}, hour, Duration{} - hour}) {
    // The clock was set before the frame arrived: time stamp and clock agree.
    EXPECT_EQ(monotonic_arrival(unix_then + step - age, unix_then + step, board_now),
              board_now - age);
  }
  for (const Duration step : {hour, Duration{} - hour}) {
    EXPECT_EQ(monotonic_arrival(unix_then - age, unix_then + step, board_now), board_now);
  }
}

TEST(CanButtons, ReleaseAHeldButtonWhoseSenderFellSilent) {
  std::vector<ButtonEvent> events;
  const Duration timeout = milliseconds(30);
  SocketPair pair([&](const ButtonEvent& event) { events.push_back(event); }, timeout);
  pair.send(1);
  for (int look = 0; events.size() < 2 && look < 5'000; ++look)
    pair.buttons().read(milliseconds(2));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_FALSE(events[1].pressed);
  EXPECT_GT(events[1].time - events[0].time, timeout);
  EXPECT_EQ(pair.buttons().counts().released, 1u);
}

// Each received frame triggers the next one: the queue stays non-empty until 600 frames were sent.
TEST(CanButtons, TakeNoMoreAWakeUpThanDeclared) {
  int events = 0;
  SocketPair* pen = nullptr;
  SocketPair pair([&](const ButtonEvent& event) {
    if (++events < 600) pen->send(event.pressed ? 0 : 1);
  });
  pen = &pair;
  pair.send(1);
  EXPECT_EQ(pair.buttons().read(milliseconds(1000)), 256);
  EXPECT_EQ(pair.buttons().read(milliseconds(1000)), 256);
  EXPECT_EQ(pair.buttons().read(milliseconds(1000)), 88);
}

TEST(CanButtons, RefuseHostileFramesAndGoOn) {
  std::vector<ButtonEvent> events;
  SocketPair pair([&](const ButtonEvent& event) { events.push_back(event); });
  pair.send(1, CAN_RTR_FLAG);
  pair.send(1, CAN_ERR_FLAG);
  pair.send(1, CAN_EFF_FLAG);
  pair.send_bytes(3);
  pair.send_bytes(CANFD_MTU + 1);
  pair.send_bytes(4096);
  pair.send(2);
  while (pair.buttons().read(milliseconds(1)) > 0) {
  }
  EXPECT_EQ(pair.buttons().counts().refused, 6u);
  EXPECT_EQ(pair.buttons().counts().received, 1u);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].button, Button::delete_last);
}

TEST(CanButtons, AreHeardByAThreadThatEndsWhenToldTo) {
  std::atomic<int> events{0};
  SocketPair pair([&](const ButtonEvent&) { ++events; });
  pair.buttons().start();
  pair.send(1);
  for (int waited = 0; events < 1 && waited < 5'000; ++waited) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(events, 1);
  pair.buttons().stop();
  pair.send(0);
  EXPECT_EQ(pair.buttons().counts().received, 1u);
  EXPECT_EQ(pair.buttons().read(milliseconds(1000)), 1);  // no other call read it
  EXPECT_EQ(events, 2);
}

TEST(CanButtons, DoNotComeFromALogAndNameTheInterfaceThatIsNotThere) {
  EXPECT_EQ(open_can_buttons("log:can.log", k_buttons, {}, {}), nullptr);
  try {
    (void)open_can_buttons("socketcan:nocan7", k_buttons, {}, {});
    ADD_FAILURE() << "opened";
  } catch (const MissingDevice& error) {
    EXPECT_NE(std::string(error.what()).find("socketcan:nocan7: no such network interface"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace glint::can_buttons_test

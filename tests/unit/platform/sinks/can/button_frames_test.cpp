// Decoding of button frames, including invalid frames.
#include "platform/sinks/can/button_frames.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>

#include <cstring>
#include <random>
#include <vector>

namespace glint::button_frames_test {
namespace {

constexpr std::uint32_t k_identifier = 0x190;

CanFrame held(std::uint8_t bits) {
  CanFrame frame;
  frame.identifier = k_identifier;
  frame.length = 1;
  frame.data[0] = bits;
  return frame;
}

struct ReceivedEvents {
  std::vector<ButtonEvent> events;
  ButtonFrames frames{k_identifier, [this](const ButtonEvent& event) { events.push_back(event); }};
};

// A frame as the kernel delivers it, `size` bytes long.
std::optional<CanFrame> from_kernel(std::uint32_t id, std::uint8_t length, std::size_t size) {
  canfd_frame raw{};
  raw.can_id = id;
  raw.len = length;
  raw.data[0] = 1;
  std::array<std::uint8_t, CANFD_MTU + 1> bytes{};
  std::memcpy(bytes.data(), &raw, sizeof raw);
  return frame_of_socketcan({bytes.data(), size});
}

TEST(ButtonFrames, SayEachChangeOfEachButtonOnce) {
  ReceivedEvents received;
  received.frames.receive(held(0b0001), {10});
  received.frames.receive(held(0b0001), {20});  // repeated: no event
  received.frames.receive(held(0b1010), {30});
  received.frames.receive(held(0b0000), {40});
  const std::vector<ButtonEvent> expected{
      {{10}, Button::draw, true},         {{30}, Button::draw, false},
      {{30}, Button::delete_last, true},  {{30}, Button::finish, true},
      {{40}, Button::delete_last, false}, {{40}, Button::finish, false}};
  EXPECT_EQ(received.events, expected);
  EXPECT_EQ(received.frames.counts().received, 4u);
  received.frames.receive(held(0b0100), {50});
  EXPECT_EQ(received.events.back(), (ButtonEvent{{50}, Button::undo, true}));
}

TEST(ButtonFrames, ReleaseWhatASilentSenderHeld) {
  ReceivedEvents received;
  received.frames.receive(held(0b1001), {0});
  received.frames.receive(held(0b1001), {5'000'000'000});  // repeated: the timeout restarts
  received.frames.release_on_timeout(Time{5'000'000'000} + k_button_timeout);
  EXPECT_EQ(received.events.size(), 2u) << "released before its timeout";
  const Time late = Time{5'000'000'001} + k_button_timeout;
  received.frames.release_on_timeout(late);
  received.frames.release_on_timeout(late + milliseconds(1));
  ASSERT_EQ(received.events.size(), 4u);
  EXPECT_EQ(received.events[2], (ButtonEvent{late, Button::draw, false}));
  EXPECT_EQ(received.events[3], (ButtonEvent{late, Button::finish, false}));
  EXPECT_EQ(received.frames.counts().released, 2u);
  received.frames.receive(held(0b0001), late + milliseconds(2));  // the sender sends again
  EXPECT_EQ(received.events.back(), (ButtonEvent{late + milliseconds(2), Button::draw, true}));
}

TEST(ButtonFrames, LookAtNothingBeyondTheFourBits) {
  ReceivedEvents received;
  CanFrame frame = held(0xF0);
  frame.length = 8;
  frame.data[1] = 0xFF;
  received.frames.receive(frame, {});
  EXPECT_TRUE(received.events.empty());
  EXPECT_EQ(received.frames.counts().received, 1u);
}

TEST(ButtonFrames, RefuseAndCountWhatIsNoButtonsFrame) {
  ReceivedEvents received;
  CanFrame empty = held(1), other = held(1), extended = held(1);
  empty.length = 0;
  other.identifier = k_identifier + 1;
  extended.extended = true;
  for (const CanFrame& frame : {empty, other, extended}) received.frames.receive(frame, {});
  received.frames.receive({}, {});
  EXPECT_TRUE(received.events.empty());
  EXPECT_EQ(received.frames.counts().received, 0u);
  EXPECT_EQ(received.frames.counts().refused, 4u);
}

TEST(ButtonFrames, CountWithoutACallback) {
  ButtonFrames frames(k_identifier, {}, milliseconds(1));
  EXPECT_FALSE(frames.counts().any());
  frames.receive(held(0b0011), {10});
  frames.release_on_timeout(Time{11} + milliseconds(1));
  EXPECT_EQ(frames.counts().received, 1u);
  EXPECT_EQ(frames.counts().released, 2u);
}

TEST(ButtonFrames, AreCountedWhetherHeardOrRefused) {
  EXPECT_FALSE((ButtonFrameCounts{0, 0, 5}.any()));
  EXPECT_TRUE((ButtonFrameCounts{1, 0, 0}.any()));
  EXPECT_TRUE((ButtonFrameCounts{0, 1, 0}.any()));
  EXPECT_TRUE((ButtonFrameCounts{1, 1, 0}.any()));
}

TEST(FrameOfSocketCan, IsAClassicOrAnFdDataFrame) {
  const auto classic = from_kernel(k_identifier, 8, CAN_MTU);
  ASSERT_TRUE(classic);
  EXPECT_EQ(classic->identifier, k_identifier);
  EXPECT_EQ(classic->length, 8);
  EXPECT_EQ(classic->data[0], 1);
  EXPECT_FALSE(classic->fd || classic->extended);
  const auto fd = from_kernel(0x1234567U | CAN_EFF_FLAG, 64, CANFD_MTU);
  ASSERT_TRUE(fd);
  EXPECT_EQ(fd->identifier, 0x1234567u);
  EXPECT_EQ(fd->length, 64);
  EXPECT_TRUE(fd->fd && fd->extended);
}

TEST(FrameOfSocketCan, KeepsEveryFieldAndNoByteBeyondItsLength) {
  for (const bool fd : {false, true}) {
    for (const std::uint8_t length : {std::uint8_t{0}, std::uint8_t{3}, std::uint8_t{8}}) {
      for (int flags = 0; flags < 256; ++flags) {
        canfd_frame raw{};
        raw.can_id = k_identifier;
        raw.len = length;
        raw.flags = static_cast<std::uint8_t>(flags);  // flags of a classic frame: padding
        for (std::size_t i = 0; i < sizeof raw.data; ++i)
          raw.data[i] = static_cast<std::uint8_t>(i + 7);
        std::array<std::uint8_t, sizeof raw> bytes{};
        std::memcpy(bytes.data(), &raw, sizeof raw);
        const auto frame = frame_of_socketcan(std::span(bytes).first(fd ? CANFD_MTU : CAN_MTU));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->fd, fd);
        EXPECT_EQ(frame->length, length);
        EXPECT_EQ(frame->bit_rate_switch, fd && flags % 2 == 1) << flags;
        for (std::size_t i = 0; i < frame->data.size(); ++i)
          ASSERT_EQ(frame->data[i], i < length ? i + 7 : 0) << i;
      }
    }
  }
}

// A frame with an 11-bit identifier keeps none of the upper bits.
TEST(FrameOfSocketCan, HasTheIdentifierOfItsKind) {
  const auto classic = from_kernel(0x1FFFFFFFU, 1, CAN_MTU);
  ASSERT_TRUE(classic);
  EXPECT_EQ(classic->identifier, k_can_identifier_max);
  const auto extended = from_kernel(0x1FFFFFFFU | CAN_EFF_FLAG, 1, CAN_MTU);
  ASSERT_TRUE(extended);
  EXPECT_EQ(extended->identifier, k_can_extended_identifier_max);
}

TEST(FrameOfSocketCan, IsNothingElse) {
  EXPECT_FALSE(from_kernel(k_identifier | CAN_RTR_FLAG, 1, CAN_MTU));
  EXPECT_FALSE(from_kernel(k_identifier | CAN_ERR_FLAG, 8, CAN_MTU));
  EXPECT_FALSE(from_kernel(k_identifier, 9, CAN_MTU));
  EXPECT_FALSE(from_kernel(k_identifier, 65, CANFD_MTU));
  for (const std::size_t size : {0, 1, 15, 17, 71, 73}) {
    EXPECT_FALSE(from_kernel(k_identifier, 1, size)) << size;
  }
}

TEST(FrameOfSocketCan, KeepsToItsBoundsWhateverTheBytes) {
  std::mt19937 random(7);
  ReceivedEvents received;
  int data_frames = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> bytes(i % 3 == 0 ? random() % 80 : i % 3 == 1 ? CAN_MTU : CANFD_MTU);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const auto frame = frame_of_socketcan(bytes);
    if (frame) {
      ++data_frames;
      ASSERT_LE(frame->length, frame->fd ? 64 : 8);
      ASSERT_LE(frame->identifier,
                frame->extended ? k_can_extended_identifier_max : k_can_identifier_max);
    }
    received.frames.receive(frame, {i});
  }
  EXPECT_GT(data_frames, 100);
  const ButtonFrameCounts counts = received.frames.counts();
  EXPECT_EQ(counts.received + counts.refused, 20'000u);
}

}  // namespace
}  // namespace glint::button_frames_test

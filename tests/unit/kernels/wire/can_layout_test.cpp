// The table of CAN messages, and faults in a table that the compile-time check rejects.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "kernels/wire/can_layout_check.hpp"
#include "kernels/wire/can_messages.hpp"
#include "kernels/wire/node_frames.hpp"
#include "tests/unit/kernels/wire/hex.hpp"

namespace glint::can_layout_test {
namespace {

// Two signals that one frame may both contain, and two of one multiplexor.
constexpr std::array k_first{CanValueRange{0, 1}};
constexpr std::array k_second{CanValueRange{2, 5}};
constexpr std::array<CanSignal, 4> k_signals{{
    {.name = "Kind", .field = {0, 4}},
    {.name = "Free", .field = {4, 4}},
    {.name = "A", .field = {8, 8}, .selector = "Kind", .selected_by = k_first},
    {.name = "B", .field = {8, 16}, .selector = "Kind", .selected_by = k_second},
}};

bool accepted(std::array<CanSignal, 4> signals, int bytes = 3) {
  return is_consistent(CanMessageLayout{.name = "M", .bytes = bytes, .signals = signals});
}

TEST(CanLayout, AcceptsSignalsOfDifferentMultiplexorValuesInOnePlace) {
  EXPECT_TRUE(accepted(k_signals));
}

TEST(CanLayout, RejectsSignalsThatOverlap) {
  auto signals = k_signals;
  signals[1].field.start = 3;
  EXPECT_FALSE(accepted(signals)) << "Free overlaps Kind";
  signals = k_signals;
  signals[3].selected_by = k_first;
  EXPECT_FALSE(accepted(signals)) << "A and B in one frame";
  signals = k_signals;
  signals[2].selector = {};
  EXPECT_FALSE(accepted(signals)) << "A is in every frame";
}

TEST(CanLayout, RejectsASignalOutsideItsMessageOrWithoutItsMultiplexor) {
  EXPECT_FALSE(accepted(k_signals, 2)) << "B ends in byte 3";
  auto signals = k_signals;
  signals[3].selector = "Sort";
  EXPECT_FALSE(accepted(signals)) << "no signal Sort";
  signals = k_signals;
  signals[3].name = "A";
  EXPECT_FALSE(accepted(signals)) << "two signals A";
  signals = k_signals;
  signals[1].limit = 16;
  EXPECT_FALSE(accepted(signals)) << "16 does not fit 4 bits";
}

TEST(CanLayout, RejectsTwoMessagesOfOneIdentifier) {
  std::array messages = k_can_messages;
  EXPECT_TRUE(is_consistent(messages));
  messages[1].offset = messages[0].offset;
  EXPECT_FALSE(is_consistent(messages)) << "two messages of a tool";
  messages = k_can_messages;
  messages[8].offset = messages[0].offset;
  EXPECT_FALSE(is_consistent(messages)) << "time and position";
  messages = k_can_messages;
  messages[0].offset = k_can_tool_stride;
  EXPECT_FALSE(is_consistent(messages)) << "an identifier of the next tool";
}

TEST(CanLayout, WritesMotorolaFieldsHighestByteFirst) {
  std::array<std::uint8_t, 8> bytes{};
  put(bytes, {.name = "Word", .field = {39, 32, CanCoding::motorola}}, 0x12345678);
  put(bytes, {.name = "High", .field = {23, 4, CanCoding::motorola}}, 0xA);
  put(bytes, {.name = "Low", .field = {19, 4, CanCoding::motorola}}, 0xB);
  put(bytes, {.name = "Two", .field = {25, 2, CanCoding::motorola}}, 3);
  EXPECT_EQ(hex_of(bytes), "0000AB0312345678");
}

TEST(CanMessages, GiveEachToolAndTheNodeIdentifiersOfTheirOwn) {
  const CanAddress address{.base = 0x1A0, .node = 32, .buttons = 0x190};
  std::multiset<std::uint32_t> identifiers;
  for (const CanMessageLayout& message : k_can_messages) {
    const int times = message.rule == CanIdentifierRule::of_tool ? k_tools_max : 1;
    for (int t = 0; t < times; ++t) identifiers.insert(identifier_of(message, address, t));
  }
  EXPECT_EQ(identifiers.size(), 7U * 16 + 5);
  for (const std::uint32_t identifier : identifiers)
    EXPECT_EQ(identifiers.count(identifier), 1U) << std::hex << identifier;
  EXPECT_EQ(identifiers.count(0x1A0), 1U);
  EXPECT_EQ(identifiers.count(0x1A0 + 15 * 16 + 8), 1U);
  EXPECT_EQ(identifiers.count(0x720), 1U);
  EXPECT_EQ(identifiers.count(0xA0), 1U);
}

TEST(CanMessages, NameEveryReasonAndEveryErrorCode) {
  const CanSignal& reason = *can_message("Emergency").find("Reason");
  const CanSignal& error = *can_message("Emergency").find("ErrorCode");
  ASSERT_EQ(reason.names.size(), k_reasons);
  for (std::size_t i = 0; i < k_reasons; ++i) {
    EXPECT_EQ(reason.names[i].value, i);
    EXPECT_EQ(reason.names[i].name, name_of(static_cast<Reason>(i)));
    EXPECT_EQ(error.names[i].value, i == 0 ? 0 : 0xFF00 + i);
  }
}

TEST(LostOutputFrame, NamesItsKindAlone) {
  EXPECT_EQ(hex_of(lost_output_frame(32, 2).bytes()), "82FF810200000000");
}

}  // namespace
}  // namespace glint::can_layout_test

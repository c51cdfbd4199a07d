// Section [can] of a cell file.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

TEST(CellCan, HearsNoButtonsWhereItSaysNothing) {
  EXPECT_FALSE(default_cell().can.buttons);
  EXPECT_FALSE(cell_from_text("[can]\nnode = 3\n", "cell.toml").can.buttons);
}

TEST(CellCan, TakesTheIdentifierOfButtonsBesideItsOwn) {
  for (const char* const free : {"0x190", "0x19F", "0x1B0", "0x7FF", "1"}) {
    const Cell cell = cell_from_text("[can]\nbuttons = " + std::string(free) + "\n", "cell.toml");
    EXPECT_EQ(cell.can.buttons, std::stoul(free, nullptr, 0)) << free;
  }
}

TEST(CellCan, RefusesAnIdentifierOfButtonsWithWhichItSends) {
  const std::string expected =
      ", an identifier that Glint sends; expected none of 0x1A0 to 0x1AF, 0x720, 0xA0";
  for (const char* const taken : {"0x1A0", "0x1A4", "0x1AE", "0x1AF", "0xA0", "0x720"}) {
    EXPECT_EQ(test::error_message_for("[can]\nbuttons = " + std::string(taken) + "\n"),
              "cell.toml:2: can.buttons is " + std::string(taken) + expected);
  }
  // Each tool has 16 identifiers, from the cell's base identifier on.
  const std::string two = "tools = [\"pen\", \"board\"]\n[can]\n";
  EXPECT_EQ(test::error_message_for(two + "buttons = 0x1BF\n"),
            "cell.toml:3: can.buttons is 0x1BF, an identifier that Glint sends; expected none of "
            "0x1A0 to 0x1BF, 0x720, 0xA0");
  EXPECT_EQ(test::error_message_for(two + "base_id = 0x200\nbuttons = 0x1BF\n"), "accepted");
}

TEST(CellCan, RefusesABaseWithWhoseToolsItsNodeClashes) {
  const std::string rest = "; expected another base_id or node";
  EXPECT_EQ(
      test::error_message_for("[can]\nbase_id = 0x700\nnode = 15\n"),
      "cell.toml:2: can.base_id is 0x700: the tools' identifiers 0x700 to 0x70F contain 0x70F "
      "of can.node 15" +
          rest);
  EXPECT_EQ(test::error_message_for("[can]\nbase_id = 0x90\nnode = 16\n"),
            "cell.toml:2: can.base_id is 0x90: the tools' identifiers 0x90 to 0x9F contain 0x90 of "
            "can.node 16" +
                rest);
  EXPECT_EQ(test::error_message_for("[can]\nbase_id = 0x90\nnode = 32\n"), "accepted");
}

TEST(CellCan, RefusesAnIdentifierOfButtonsBeyondElevenBits) {
  for (const char* const wrong : {"0", "-1", "2048", "\"0x190\""}) {
    EXPECT_EQ(test::error_message_for("[can]\nbuttons = " + std::string(wrong) + "\n"),
              "cell.toml:2: can.buttons is " + std::string(wrong) +
                  "; expected a whole number from 1 to 2047");
  }
}

}  // namespace
}  // namespace glint

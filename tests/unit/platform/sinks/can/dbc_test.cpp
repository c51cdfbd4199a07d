// DBC file of a cell: what another program's reader does not judge (dbc_decode.py).
#include "platform/sinks/can/dbc.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::dbc_test {
namespace {

bool has(const std::string& text, const std::string& line) {
  return text.find(line + "\n") != std::string::npos;
}

DbcBus bus_of(std::vector<std::string> tools) {
  DbcBus bus;
  bus.address = {.base = 0x200, .node = 5};
  bus.tools = std::move(tools);
  return bus;
}

TEST(Dbc, MakesEachToolsNameAWordOfItsOwn) {
  const std::vector<std::string> prefixes =
      dbc_prefixes({"pen", "left pen", "Left-Pen", "3d probe", "\xC3\xA4\xC3\xB6",
                    "a very long name of a tool"});
  const std::vector<std::string> expected{"Pen",         "LeftPen", "LeftPen_2",
                                          "Tool3dProbe", "Tool",    "AVeryLongNameO"};
  EXPECT_EQ(prefixes, expected);
}

TEST(Dbc, TakesIdentifiersNodeAndButtonsOfTheCell) {
  DbcBus bus = bus_of({"pen", "probe"});
  const std::string without = dbc_text(bus);
  EXPECT_TRUE(has(without, "BO_ 512 PenPosition: 8 Glint"));
  EXPECT_TRUE(has(without, "BO_ 532 ProbeQuality: 8 Glint"));
  EXPECT_TRUE(has(without, "BO_ 133 Emergency: 8 Glint"));
  EXPECT_TRUE(has(without, "BO_ 1797 Heartbeat: 1 Glint"));
  EXPECT_EQ(without.find("PenButtons"), std::string::npos);
  bus.address.buttons = 0x190;
  EXPECT_TRUE(has(dbc_text(bus), "BO_ 400 PenButtons: 1 Controller"));
}

TEST(Dbc, GivesACycleTimeToTheFormatOfTheCellAlone) {
  DbcBus bus = bus_of({"pen"});
  bus.tick_hz = 500;
  const std::string classic = "BA_ \"GenMsgCycleTime\" BO_ 512 2;";
  const std::string fd = "BA_ \"GenMsgCycleTime\" BO_ 520 2;";
  EXPECT_TRUE(has(dbc_text(bus), classic));
  EXPECT_FALSE(has(dbc_text(bus), fd));
  bus.format = CanFormat::fd;
  EXPECT_FALSE(has(dbc_text(bus), classic));
  EXPECT_TRUE(has(dbc_text(bus), fd));
}

TEST(Dbc, IsAsciiForAnyNameOfATool) {
  const std::string text = dbc_text(bus_of({"\"\xC3\xA4\\pen\n"}));
  for (const char c : text) EXPECT_TRUE(c == '\n' || c == '\t' || (c >= ' ' && c <= '~'));
  EXPECT_NE(text.find("Tool ????pen?. Position of the tip."), std::string::npos);
}

}  // namespace
}  // namespace glint::dbc_test

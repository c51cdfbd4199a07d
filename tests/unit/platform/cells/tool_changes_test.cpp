// Tool changes, and allowed inputs over DDS, in a cell file.
#include <gtest/gtest.h>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

const char* const k_two = "tools = [\"pen\", \"board\"]\n";

TEST(ToolChanges, AreReadInTheirOrder) {
  const Cell cell = cell_from_text(std::string(k_two) +
                                       "absent = [\"board\"]\n"
                                       "[[tool_change]]\nat_s = 1.5\nadd = \"board\"\n"
                                       "[[tool_change]]\nat_s = 2\nremove = \"pen\"\n",
                                   "cell.toml");
  EXPECT_EQ(cell.tools_at_start & 3, 1);
  ASSERT_EQ(cell.tool_changes.size(), 2u);
  EXPECT_EQ(cell.tool_changes[0].at.nanoseconds, 1'500'000'000);
  EXPECT_EQ(cell.tool_changes[0].present & 3, 3);
  EXPECT_EQ(cell.tool_changes[1].present & 3, 2);
  EXPECT_EQ(default_cell().tools_at_start, k_all_tools);
}

TEST(ToolChanges, LeaveThePlaceOfAToolEmptyAndTheOthersWhereTheyAre) {
  const Cell cell = cell_from_text(k_two, "cell.toml");
  const ToolSet set = tools_present(cell.tools, 2);
  EXPECT_EQ(set.count, 2);
  EXPECT_FALSE(set.items[0].present());
  EXPECT_EQ(set.items[0].identity, 0u);
  EXPECT_EQ(set.items[1].identity, cell.tools.items[1].identity);
}

TEST(ToolChanges, AreRefusedByNameAndLine) {
  EXPECT_EQ(error_message_for(std::string(k_two) + "absent = [\"hammer\"]\n"),
            "cell.toml:2: absent: no tool is named \"hammer\"; expected the name of a listed tool: "
            "pen, board");
  EXPECT_EQ(error_message_for(std::string(k_two) + "[[tool_change]]\nat_s = 1\nadd = \"pen\"\n"),
            "cell.toml:3: tool_change: \"pen\" is already present; expected a change at that time");
  EXPECT_EQ(
      error_message_for(std::string(k_two) + "[[tool_change]]\nat_s = 1\n"),
      "cell.toml:3: tool_change changes nothing; expected add = \"NAME\" or remove = \"NAME\"");
  EXPECT_EQ(error_message_for(std::string(k_two) + "[[tool_change]]\nat_s = 2\nremove = \"pen\"\n"
                                                   "[[tool_change]]\nat_s = 2\nadd = \"pen\"\n"),
            "cell.toml:6: tool_change: at_s is not later than the previous one; expected "
            "increasing times from 0 on");
}

TEST(DdsInputs, AreAllowedByNameOnly) {
  for (const bool allowed : default_cell().dds.allow.by_input) EXPECT_FALSE(allowed);
  const Cell cell = cell_from_text("[dds]\nallow = [\"buttons\", \"joint_states\"]\n", "cell.toml");
  EXPECT_EQ(cell.dds.allow.by_input,
            (std::array<bool, k_dds_inputs>{true, false, false, true, false}));
  EXPECT_TRUE(
      cell_from_text("[dds]\ntool_changes = true\n", "cell.toml").dds.allow[DdsInput::tools])
      << "the key of older cells";
  EXPECT_EQ(error_message_for("[dds]\nallow = [\"button\"]\n"),
            "cell.toml:2: dds.allow: \"button\"; expected names of inputs: joint_states, "
            "robot_description, initial_pose, buttons, tools");
}

}  // namespace
}  // namespace glint

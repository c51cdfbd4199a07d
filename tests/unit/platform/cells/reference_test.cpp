// Headset drift and reference body in a cell file.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

TEST(CellReference, IsOneOfTheListedToolsByName) {
  const Cell cell = cell_from_text(
      "tools = [\"pen\", \"board\"]\nreference = \"board\"\n[robot]\nframe = \"reference\"\n",
      "cell.toml");
  EXPECT_EQ(cell.reference, 1);
  EXPECT_TRUE(cell.robot_in_reference);
  EXPECT_TRUE(cell.warnings.empty()) << cell.warnings.front();
  EXPECT_EQ(default_cell().reference, -1);
  EXPECT_FALSE(default_cell().robot_in_reference);
}

TEST(CellReference, MustBeListed) {
  EXPECT_EQ(error_message_for("tools = [\"pen\"]\nreference = \"board\"\n"),
            "cell.toml:2: reference is \"board\"; expected the name of a listed tool: pen");
}

TEST(CellReference, IsNeededForARobotThatIsGivenInItsFrame) {
  EXPECT_EQ(error_message_for("[robot]\nframe = \"reference\"\n"),
            "cell.toml:2: robot.frame is \"reference\" without a reference; expected reference = "
            "\"NAME\" at the top, a listed tool at rest");
}

TEST(CellHeadset, IsReadInMetresAndRadians) {
  const Cell cell = cell_from_text(
      "[headset]\nrest_mm = 2\nrest_deg = 1\nmm_per_m_s = 40\nmrad_per_rad_s = 5\npivot_m = 0.7\n",
      "cell.toml");
  const HeadNoise &noise = cell.head_noise, usual;
  EXPECT_DOUBLE_EQ(noise.rest_position_m, 0.002);
  EXPECT_NEAR(noise.rest_angle_rad, 0.0174532925, 1e-9);
  EXPECT_DOUBLE_EQ(noise.position_per_speed_s, 0.04);
  EXPECT_DOUBLE_EQ(noise.angle_per_turn_s, 0.005);
  EXPECT_DOUBLE_EQ(noise.pivot_m, 0.7);
  EXPECT_DOUBLE_EQ(noise.motion_correlation_s, usual.motion_correlation_s);
  EXPECT_NE(error_message_for("[headset]\nrest_mm = -1\n").find("cell.toml:2: headset.rest_mm"),
            std::string::npos);
}

}  // namespace
}  // namespace glint

// Section [camera.depth_bias] of a cell file.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

TEST(CellDepthBias, IsReadInMetres) {
  const Cell cell = cell_from_text(
      "[camera.depth_bias]\noffset_mm = 3\nmm_per_m = -10\ndim_mm = 0.5\nrange_mm = [250, 900]\n",
      "cell.toml");
  const DepthBias& bias = cell.camera.depth.bias;
  EXPECT_DOUBLE_EQ(bias.offset_m, 0.003);
  EXPECT_DOUBLE_EQ(bias.per_metre, -0.01);
  EXPECT_DOUBLE_EQ(bias.low_signal_m, 0.0005);
  EXPECT_DOUBLE_EQ(bias.range_min_m, 0.25);
  EXPECT_DOUBLE_EQ(bias.range_max_m, 0.9);
}

TEST(CellDepthBias, IsNoneWhereNothingIsSaid) {
  EXPECT_EQ(default_cell().camera.depth.bias.at(0.5, 100), 0);
}

TEST(CellDepthBias, NeedsTheRangesItWasMeasuredAt) {
  EXPECT_EQ(error_message_for("name = \"a\"\n[camera.depth_bias]\noffset_mm = 3\n"),
            "cell.toml:2: camera.depth_bias.range_mm is missing; expected [from, to], the measured "
            "ranges");
  EXPECT_EQ(error_message_for("[camera.depth_bias]\nrange_mm = [900, 250]\n"),
            "cell.toml:2: camera.depth_bias.range_mm is not a range; expected [from, to], the "
            "measured ranges");
  EXPECT_NE(error_message_for("[camera.depth_bias]\noffset_mm = 3000\nrange_mm = [1, 2]\n")
                .find("cell.toml:2: camera.depth_bias.offset_mm"),
            std::string::npos);
  EXPECT_NE(
      error_message_for("[camera.depth_bias]\noffset = 3\nrange_mm = [1, 2]\n").find("offset"),
      std::string::npos);
}

}  // namespace
}  // namespace glint

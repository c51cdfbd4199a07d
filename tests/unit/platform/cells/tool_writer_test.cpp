#include "platform/cells/tool_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "platform/cells/tool_file.hpp"

namespace glint {
namespace {

TEST(ToolWriter, WritesWhatIsReadBackTheSame) {
  Tool tool = default_pen();
  tool.tip_m = {0.0012345, -0.2, 0.15};
  tool.shape = MarkerShape::disc;
  tool.marker_sigma_m = 0.00012;
  tool.tip_sigma_m = 0.00034;
  const std::string text = tool_toml_text(tool, "two\nlines = of comment");
  const Tool read = tool_from_toml_text(text, "written.toml");
  EXPECT_EQ(read.name, tool.name);
  EXPECT_EQ(read.shape, tool.shape);
  EXPECT_DOUBLE_EQ(read.marker_sigma_m, 0.00012);
  EXPECT_DOUBLE_EQ(read.tip_sigma_m, 0.00034);
  EXPECT_EQ(read.marker_radius_m, tool.marker_radius_m);
  EXPECT_LT((read.tip_m - tool.tip_m).norm(), 1e-7);
  ASSERT_EQ(read.marker_count, tool.marker_count);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LT((read.markers_m[i] - tool.markers_m[i]).norm(), 1e-7);
  }
}

TEST(ToolWriter, KeepsAToolsOwnDepthBias) {
  Tool tool = default_pen();
  tool.depth_bias = {0.0035, -0.012, 0.0021, 0.25, 0.9};
  const Tool read = tool_from_toml_text(tool_toml_text(tool, ""), "written.toml");
  EXPECT_DOUBLE_EQ(read.depth_bias.offset_m, 0.0035);
  EXPECT_DOUBLE_EQ(read.depth_bias.per_metre, -0.012);
  EXPECT_DOUBLE_EQ(read.depth_bias.low_signal_m, 0.0021);
  EXPECT_DOUBLE_EQ(read.depth_bias.range_min_m, 0.25);
  EXPECT_DOUBLE_EQ(read.depth_bias.range_max_m, 0.9);
}

TEST(ToolWriter, KeepsAwkwardNamesOutOfPathsAndInQuotes) {
  Tool tool = default_pen();
  constexpr std::string_view k_name = "../a \"b\"";
  tool.name = {};
  std::copy(k_name.begin(), k_name.end(), tool.name.begin());
  EXPECT_EQ(file_name_of(tool), "___a__b_");
  EXPECT_EQ(tool_from_toml_text(tool_toml_text(tool, ""), "written.toml").name, tool.name);
}

}  // namespace
}  // namespace glint

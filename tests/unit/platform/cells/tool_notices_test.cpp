#include "platform/cells/tool_notices.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "platform/cells/cell.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/cells/test_tools.hpp"

namespace glint {
namespace {

using test::asymmetric_tool;
using test::permuted_tool;
using test::set_of;
using test::tool_of;

// Returns the warnings for these tools, one a line, or the error message of the refusal.
std::string warnings_of(const ToolSet& set, const DistinctionSettings& settings = {}) {
  try {
    std::string text;
    for (const std::string& warning :
         tool_warnings(set, {"a.toml", "b.toml"}, "cell.toml:2", settings)) {
      text += warning + "\n";
    }
    return text;
  } catch (const InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Planar, and nearly symmetric under a rotation by pi.
Tool nearly_symmetric() { return tool_of({{-40, 0, 0}, {40, 0, 0}, {3, 55, 0}, {0, 20, 0}}); }

TEST(ToolNotices, SayNothingOfToolsThatAreToldApart) {
  const Tool other = tool_of({{0, 0, 0}, {61, 0, 0}, {0, 103, 0}, {30, 40, 82}});
  EXPECT_EQ(warnings_of(set_of({asymmetric_tool(), other})), "");
}

TEST(ToolNotices, RefuseEqualToolsByNameFileAndMarkers) {
  const std::string warnings = warnings_of(set_of({asymmetric_tool(), asymmetric_tool()}));
  EXPECT_EQ(warnings.rfind("refused: cell.toml:2: tools \"a\" (a.toml) and \"b\" (b.toml): markers "
                           "1, 2, 3, 4 of the first match 1, 2, 3, 4 of the second, 0.0 sigma "
                           "apart at 1.5 mm of range noise: in up to 50 % of frames",
                           0),
            0u)
      << warnings;
  EXPECT_TRUE(has(warnings, "; expected more than 1.0, better 6.2; e.g. move marker ")) << warnings;
}

TEST(ToolNotices, RefuseAToolWhoseMarkersAreFourOfAnothers) {
  const Tool part = tool_of({{22, 24, 129}, {-40, 45, 115}, {45, 45, 240}, {-8, -45, 115}});
  const std::string warnings = warnings_of(set_of({part, asymmetric_tool()}));
  EXPECT_TRUE(has(warnings,
                  "refused: cell.toml:2: tools \"a\" (a.toml) and \"b\" (b.toml): markers 1, 2, 3, "
                  "4 of the first match 5, 2, 3, 4 of the second, 0.0 sigma"))
      << warnings;
}

TEST(ToolNotices, RefuseAnEquilateralToolOfThreeMarkersByItsOwnExchange) {
  const std::string warnings =
      warnings_of(set_of({tool_of({{0, 0, 0}, {80, 0, 0}, {40, 80 * std::sqrt(0.75), 0}})}));
  EXPECT_TRUE(has(warnings, "refused: cell.toml:2: tool \"a\" (a.toml): its markers ")) << warnings;
  EXPECT_TRUE(has(warnings, " may be mistaken for its own ")) << warnings;
}

TEST(ToolNotices, WarnOfANearlySymmetricToolWithItsDistance) {
  const std::string warnings = warnings_of(set_of({nearly_symmetric()}));
  EXPECT_EQ(
      warnings.rfind("tool \"a\" (a.toml): its markers 1, 2 may be mistaken for its own 2, 1, ", 0),
      0u)
      << warnings;
  EXPECT_TRUE(has(warnings, "; expected at least 6.2; e.g. move marker ")) << warnings;
}

TEST(ToolNotices, WarnWithinTheLimitAndRefuseWithinOneSigma) {
  const ToolSet set = set_of({nearly_symmetric()});
  const double distance_m = distinguish(set, {}).wrong_labelings.at(0).distance_sigmas * 0.0015;
  const auto notices_at = [&](double sigmas) {
    DistinctionSettings settings;
    settings.sigma_m = distance_m / sigmas;
    return warnings_of(set, settings);
  };
  EXPECT_EQ(notices_at(6.21), "");
  EXPECT_TRUE(has(notices_at(6.19), ", 6.1 sigma apart at 0.7 mm of range noise"))
      << notices_at(6.19);
  EXPECT_EQ(notices_at(1.01).rfind("tool ", 0), 0u) << notices_at(1.01);
  EXPECT_EQ(notices_at(0.99).rfind("refused: cell.toml:2: tool ", 0), 0u) << notices_at(0.99);
}

TEST(ToolNotices, NameTheLeastMoveThatIsEnoughForThatLabeling) {
  const Tool similar_tool = permuted_tool(asymmetric_tool(), [](const Vector3& point) {
    return Vector3(point.x() + 3e-5 * point.z(), 1.02 * point.y(), point.z());
  });
  for (const ToolSet& set :
       {set_of({nearly_symmetric()}), set_of({asymmetric_tool(), similar_tool})}) {
    const WrongLabeling labeling = distinguish(set, {}).wrong_labelings.at(0);
    const auto move = separating_move(set, labeling, {});
    ASSERT_TRUE(move);
    const auto distance_with = [&](int mm) {
      ToolSet moved = set;
      moved.items[static_cast<std::size_t>(move->tool)]
          .markers_m[static_cast<std::size_t>(move->marker)](move->axis) += 1e-3 * mm;
      const double left = residual_squares_m2(moved.items[static_cast<std::size_t>(labeling.seen)],
                                              moved.items[static_cast<std::size_t>(labeling.other)],
                                              labeling.assignment);
      return std::sqrt(left) / 0.0015;
    };
    EXPECT_NEAR(distance_with(0), labeling.distance_sigmas, 1e-6);
    EXPECT_GE(distance_with(move->mm), k_distinct_sigmas);
    EXPECT_LT(distance_with(move->mm - (move->mm > 0 ? 1 : -1)), k_distinct_sigmas);
  }
}

TEST(ToolNotices, ClaimNothingWhereTheStepsRanOut) {
  DistinctionSettings settings;
  settings.steps_max = 5;
  EXPECT_EQ(warnings_of(set_of({asymmetric_tool()}), settings),
            "tool \"a\" (a.toml): not all labelings were compared in 5 steps; separation is not "
            "proved to be 6.2 sigma; expected tools with more different geometry\n");
}

TEST(ToolNotices, AreNoneOfTheBuiltInCell) {
  EXPECT_TRUE(default_cell().warnings.empty());
  DistinctionSettings settings;
  settings.limit_sigmas = 1e6;
  const WrongLabeling nearest =
      distinguish(set_of({default_pen()}), settings).wrong_labelings.at(0);
  std::printf("  the built-in pen, its own markers exchanged: %.1f sigma\n",
              nearest.distance_sigmas);
}

TEST(ToolNotices, ComeWithACellReadFromFiles) {
  const std::filesystem::path folder =
      testing::TempDir() + "tool_notices_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  const std::string rest = "radius_mm = 5\ntip_mm = [0, 0, 0]\n";
  std::ofstream(folder / "near.toml")
      << "name = \"near\"\nmarkers_mm = [[-40,0,0],[40,0,0],[3,55,0],[0,20,0]]\n"
      << rest;
  std::ofstream(folder / "twin.toml")
      << "name = \"twin\"\nmarkers_mm = [[40,0,0],[-40,0,0],[-3,55,0],[0,20,0]]\n"
      << rest;
  const std::string file = (folder / "cell.toml").string();
  const Cell cell = cell_from_text("tools = [\"pen\", \"near.toml\"]\n", file);
  ASSERT_EQ(cell.warnings.size(), 1u);
  EXPECT_TRUE(has(cell.warnings[0], "tool \"near\" (near.toml): its markers 1, 2"))
      << cell.warnings[0];
  try {
    (void)cell_from_text("name = \"x\"\ntools = [\"near.toml\", \"twin.toml\"]\n", file);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "cell.toml:2: tools \"near\" (near.toml) and \"twin\""))
        << error.what();
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace glint

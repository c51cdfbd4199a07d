#include "platform/cells/tool_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "kernels/pose/fit_covariance.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

const std::string k_valid = R"(name = "probe"
markers_mm = [[0, 0, 0], [50, 0, 0], [0, 70.5, 0], [0, 0, 90]]
radius_mm = 6
tip_mm = [1, 2, -120]
shape = "disc"
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

template <class Reader>
std::string error_message_of(Reader&& read) {
  try {
    const Tool tool = read();
    return std::string("accepted ") + tool.name.data();
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string toml_complaint(const std::string& text) {
  return error_message_of([&] { return tool_from_toml_text(text, "tool.toml"); });
}

TEST(ToolFile, ReadsEveryKeyOfItsOwnFormat) {
  const Tool tool = tool_from_toml_text(k_valid, "tool.toml");
  EXPECT_STREQ(tool.name.data(), "probe");
  EXPECT_EQ(tool.marker_count, 4);
  EXPECT_LT((tool.markers_m[2] - Vector3(0, 0.0705, 0)).norm(), 1e-15);
  EXPECT_NEAR(tool.distance_m[0][3], 0.09, 1e-15);
  EXPECT_DOUBLE_EQ(tool.marker_radius_m, 0.006);
  EXPECT_LT((tool.tip_m - Vector3(0.001, 0.002, -0.12)).norm(), 1e-15);
  EXPECT_EQ(tool.shape, MarkerShape::disc);
  EXPECT_EQ(tool_from_toml_text(replaced(k_valid, "shape = \"disc\"\n", ""), "t").shape,
            MarkerShape::sphere);
}

TEST(ToolFile, RefusesKeysThatAreUnknownOrMissing) {
  EXPECT_EQ(toml_complaint(k_valid + "colour = \"red\"\n"),
            "tool.toml:6: unknown key colour; expected name, markers_mm, marker_sigma_mm, "
            "radius_mm, tip_mm, tip_sigma_mm, shape or depth_bias");
  for (const std::string key : {"name", "markers_mm", "radius_mm", "tip_mm"}) {
    const std::string found = toml_complaint(replaced(k_valid, key + " =", "shape2 ="));
    EXPECT_NE(found.find("shape2"), std::string::npos) << found;
    std::istringstream rows(k_valid);
    std::string kept, row;
    while (std::getline(rows, row)) {
      if (row.rfind(key, 0) != 0) kept += row + "\n";
    }
    const std::string missing = toml_complaint(kept);
    EXPECT_EQ(missing.rfind("tool.toml:1: " + key + " is missing; expected ", 0), 0u) << missing;
  }
}

TEST(ToolFile, RefusesMarkersThatFixNoPose) {
  const std::string markers = "[[0, 0, 0], [50, 0, 0], [0, 70.5, 0], [0, 0, 90]]";
  EXPECT_EQ(toml_complaint(replaced(k_valid, markers, "[[0, 0, 0], [50, 0, 0]]")),
            "tool.toml:2: 2 markers; expected 3 to 8");
  EXPECT_EQ(toml_complaint(replaced(k_valid, markers, "[[0, 0, 0], [50, 1, 0], [100, 2, 0]]")),
            "tool.toml:2: the markers are collinear; expected at least one off the line");
  EXPECT_EQ(
      toml_complaint(replaced(k_valid, markers, "[[0, 0, 0], [50, 0, 0], [0, 9, 0], [0, 9, 0.5]]")),
      "tool.toml:2: two markers coincide; expected at least 1 mm between any two");
  std::string nine = "[[0,0,0]";
  for (int i = 1; i < 9; ++i)
    nine += ",[" + std::to_string(i * i) + ",0," + std::to_string(9 * i) + "]";
  EXPECT_EQ(toml_complaint(replaced(k_valid, markers, nine + "]")),
            "tool.toml:2: 9 markers; expected 3 to 8");
}

TEST(ToolFile, RefusesValuesOfTheWrongKind) {
  EXPECT_EQ(toml_complaint(replaced(k_valid, "70.5", "nan")),
            "tool.toml:2: markers_mm[2] is nan; expected a number from -2000 to 2000");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "70.5", "inf")),
            "tool.toml:2: markers_mm[2] is inf; expected a number from -2000 to 2000");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "70.5", "\"a\"")),
            "tool.toml:2: markers_mm[2] is not a number; expected a number from -2000 to 2000");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "[0, 0, 90]", "[0, 90]")),
            "tool.toml:2: markers_mm[3] is not a point; expected [x, y, z] in millimetres");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "radius_mm = 6", "radius_mm = -6")),
            "tool.toml:3: radius_mm is -6; expected a number from 0 to 100");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "\"disc\"", "\"cube\"")),
            "tool.toml:5: shape is \"cube\"; expected \"sphere\" or \"disc\"");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "\"probe\"", "7")),
            "tool.toml:1: name is not text; expected text in quotes");
  EXPECT_EQ(toml_complaint(replaced(k_valid, "\"probe\"", "\"" + std::string(32, 'x') + "\"")),
            "tool.toml:1: name \"" + std::string(32, 'x') + "\" has 32 bytes; expected 1 to 31");
  EXPECT_EQ(toml_complaint("name = \n").rfind("tool.toml:1: ", 0), 0u);
}

TEST(ToolFile, MayHaveADepthBiasOfItsOwnMarkers) {
  const std::string bias = "[depth_bias]\noffset_mm = 12\nrange_mm = [300, 800]\n";
  const Tool tool = tool_from_toml_text(k_valid + bias, "tool.toml");
  EXPECT_DOUBLE_EQ(tool.depth_bias.offset_m, 0.012);
  EXPECT_NE(tool.identity, tool_from_toml_text(k_valid, "tool.toml").identity);
  EXPECT_FALSE(tool_from_toml_text(k_valid, "tool.toml").depth_bias.is_measured());
  EXPECT_EQ(
      toml_complaint(k_valid + "[depth_bias]\noffset_mm = 12\n"),
      "tool.toml:6: depth_bias.range_mm is missing; expected [from, to], the measured ranges");
  EXPECT_EQ(toml_complaint(k_valid + "depth_bias = 3\n"),
            "tool.toml:6: depth_bias is not a table; expected [depth_bias], as in a file of `glint "
            "calibrate depth`");
}

const std::string k_ini =
    "[geometry]\r\ncount=3\r\nid=101\r\n[fiducial0]\r\nx=-24.3\r\ny=-29.5\r\nz=0.1\r\n"
    "[fiducial1]\r\nx=-66.7\r\ny=14\r\nz=-6.8\r\n[fiducial2]\r\nx=20.8\r\ny=3.5\r\nz=1.4\r\n"
    "[pivot]\r\nx=0\r\ny=0\r\nz=-150\r\n";

std::string ini_complaint(const std::string& text) {
  return error_message_of([&] { return tool_from_ini_text(text, "folder/arm.ini"); });
}

TEST(ToolFile, ReadsAnAtracsysGeometry) {
  const Tool tool = tool_from_ini_text(k_ini, "folder/arm.ini");
  EXPECT_STREQ(tool.name.data(), "arm");
  EXPECT_EQ(tool.marker_count, 3);
  EXPECT_LT((tool.markers_m[1] - Vector3(-0.0667, 0.014, -0.0068)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(tool.tip_m.z(), -0.15);
  EXPECT_DOUBLE_EQ(tool.marker_radius_m, 0.00575);
}

TEST(ToolFile, NamesTheLineOfWhatIsWrongInAnAtracsysGeometry) {
  EXPECT_EQ(ini_complaint(replaced(k_ini, "y=14", "y=l4")),
            "folder/arm.ini:10: fiducial1/y is \"l4\"; expected a number from -2000 to 2000 mm");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "y=14\r\n", "")),
            "folder/arm.ini:1: [fiducial1] y is missing; expected it in an Atracsys geometry");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "count=3", "count=2")),
            "folder/arm.ini:2: 2 markers; expected 3 to 8");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "count=3", "count=4")),
            "folder/arm.ini:1: [fiducial3] x is missing; expected it in an Atracsys geometry");
  EXPECT_EQ(
      ini_complaint(replaced(k_ini, "[pivot]", "[fiducial3]")),
      "folder/arm.ini:2: count is 3 but [fiducial3] follows; expected as many fiducials as count");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "id=101", "hello")),
            "folder/arm.ini:3: \"hello\"; expected [section] or key=value");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "z=0.1", "y=0.1")),
            "folder/arm.ini:7: fiducial0/y occurs twice; expected it once");
  EXPECT_EQ(ini_complaint(replaced(k_ini, "z=0.1", "z=nan")),
            "folder/arm.ini:7: fiducial0/z is \"nan\"; expected a number from -2000 to 2000 mm");
}

void put(std::string& bytes, std::size_t at, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) {
    bytes[at + static_cast<std::size_t>(i)] = static_cast<char>((value >> (8 * i)) & 0xFF);
  }
}

void put_sum(std::string& bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 6; i < bytes.size(); ++i) sum += static_cast<unsigned char>(bytes[i]);
  put(bytes, 4, sum & 0xFFFF, 2);
}

std::string rom_of(const std::vector<std::array<float, 3>>& markers_mm) {
  std::string bytes(752, '\0');
  std::memcpy(bytes.data(), "NDI", 3);
  put(bytes, 28, static_cast<std::uint32_t>(markers_mm.size()), 1);
  std::size_t at = 72;
  for (const auto& marker : markers_mm) {
    for (const float value : marker) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      put(bytes, at, bits, 4);
      at += 4;
    }
  }
  put_sum(bytes);
  return bytes;
}

std::string rom_complaint(const std::string& bytes) {
  return error_message_of([&] { return tool_from_rom_bytes(bytes, "tool.rom"); });
}

TEST(ToolFile, ReadsAnNdiToolDefinition) {
  const Tool tool = tool_from_rom_bytes(
      rom_of({{0, 0, 0}, {0, 28.59F, 41.02F}, {0, 0, 88}, {0, -44.32F, 40.45F}}), "8700339.rom");
  EXPECT_STREQ(tool.name.data(), "8700339");
  EXPECT_EQ(tool.marker_count, 4);
  EXPECT_NEAR(tool.markers_m[3].y(), -0.04432, 1e-9);
  EXPECT_DOUBLE_EQ(tool.marker_radius_m, 0.00575);
  EXPECT_EQ(tool.tip_m, Vector3::Zero());
}

TEST(ToolFile, NoticesEveryChangedByteOfAnNdiToolDefinition) {
  const std::string whole = rom_of({{0, 0, 0}, {0, 28, 41}, {0, 0, 88}});
  ASSERT_EQ(rom_complaint(whole), "accepted tool");
  for (std::size_t at = 4; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_EQ(rom_complaint(changed).rfind("tool.rom:byte 4: checksum ", 0), 0u) << at;
  }
  EXPECT_EQ(rom_complaint(whole.substr(0, 60)).rfind("tool.rom:byte 0: is not an NDI tool", 0), 0u);
  EXPECT_EQ(rom_complaint("XYZ" + whole.substr(3)).rfind("tool.rom:byte 0: is not an NDI tool", 0),
            0u);
}

TEST(ToolFile, RefusesAnNdiToolDefinitionWhoseMarkersFixNoPose) {
  EXPECT_EQ(rom_complaint(rom_of({{0, 0, 0}, {0, 0, 88}})),
            "tool.rom:byte 28: 2 markers; expected 3 to 8");
  EXPECT_EQ(rom_complaint(rom_of({{0, 0, 0}, {0, 0, 44}, {0, 0, 88}})),
            "tool.rom:byte 72: the markers are collinear; expected at least one off the line");
  EXPECT_NE(rom_complaint(rom_of({{0, 0, 0}, {0, NAN, 44}, {0, 0, 88}})).find("byte 88"),
            std::string::npos);
  std::string cut = rom_of({{0, 0, 0}, {0, 28, 41}, {0, 0, 88}}).substr(0, 100);
  put_sum(cut);
  EXPECT_EQ(rom_complaint(cut),
            "tool.rom:byte 100: ends here; expected 3 markers of 12 bytes from byte 72");
}

TEST(ToolFile, IsToldApartByItsEnding) {
  const std::string folder = testing::TempDir() + "tool_file_" + std::to_string(getpid()) + "/";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "a.toml") << k_valid;
  std::ofstream(folder + "b.ini") << k_ini;
  std::ofstream(folder + "c.rom", std::ios::binary) << rom_of({{0, 0, 0}, {0, 28, 41}, {0, 0, 88}});
  EXPECT_STREQ(load_tool(folder + "a.toml").name.data(), "probe");
  EXPECT_STREQ(load_tool(folder + "b.ini").name.data(), "b");
  EXPECT_STREQ(load_tool(folder + "c.rom").name.data(), "c");
  EXPECT_NE(error_message_of([&] { return load_tool(folder + "d.toml"); }).find("is not a file"),
            std::string::npos);
  EXPECT_NE(
      error_message_of([&] { return load_tool(folder + "a.json"); }).find(".toml, .rom or .ini"),
      std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST(ToolFile, OfRealNdiToolsHasTheListedMarkers) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/tool_defs/";
  std::ifstream list(folder + "tools_mm.csv");
  if (!list) GTEST_SKIP() << "no " << folder << "tools_mm.csv; set GLINT_TEST_DATA";
  int compared = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.rfind("NDI_", 0) != 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    std::string name;
    std::size_t marker = 0;
    Vector3 mm;
    row >> name >> marker >> mm.x() >> mm.y() >> mm.z();
    const Tool tool = load_tool(folder + name.substr(4) + ".rom");
    EXPECT_LT((tool.markers_m[marker - 1] - 1e-3 * mm).norm(), 1e-8) << name << " " << marker;
    ++compared;
  }
  EXPECT_EQ(compared, 12);
}

TEST(DefaultPen, HasSidesThatNoNoiseConfuses) {
  const Tool pen = default_pen();
  EXPECT_EQ(pen.marker_count, 5);
  std::set<double> sides;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < i; ++j) sides.insert(pen.distance_m[i][j]);
  }
  ASSERT_EQ(sides.size(), 10u);
  EXPECT_GE(*sides.begin(), 0.05);  // adjacent markers do not merge into one blob
  EXPECT_LE(*sides.rbegin(), 0.165);
  double previous = 0;
  for (const double side : sides) {
    EXPECT_GE(side - previous, 0.008);  // nearly 4 sigma of a side at 1.5 mm range noise
    previous = side;
  }
}

TEST(DefaultPen, HasNoFourMarkersInAPlane) {
  const Tool pen = default_pen();
  for (std::size_t left_out = 0; left_out < 5; ++left_out) {
    std::vector<Vector3> corner;
    for (std::size_t i = 0; i < 5; ++i) {
      if (i != left_out) corner.push_back(pen.markers_m[i]);
    }
    Matrix3 edges;
    edges << corner[1] - corner[0], corner[2] - corner[0], corner[3] - corner[0];
    EXPECT_GE(std::abs(edges.determinant()), 5e-5) << left_out;  // cubic metres: (37 mm)^3
  }
}

TEST(DefaultPen, ShowsItsTipWithinFourMillimetresAtArmsLength) {
  const Tool pen = default_pen();
  test::Random random(1);
  double place = 0, angle = 0;
  constexpr int views = 500;
  for (int view = 0; view < views; ++view) {
    const Quaternion rotation = random.rotation();
    const Pose pose{rotation, Vector3(0, 0, 0.5) - rotation * Vector3(0, 0, 0.166)};
    std::vector<Vector3> points;
    std::vector<Matrix3> covariances;
    for (std::size_t i = 0; i < 5; ++i) {
      points.push_back(pose * pen.markers_m[i]);
      covariances.push_back(marker_covariance(points.back().normalized(), 0.0015, 0.5 * 0.1 / 253));
    }
    const auto covariance = fit_covariance(points, covariances, pose * pen.tip_m);
    ASSERT_TRUE(covariance);
    place += covariance.value.topLeftCorner<3, 3>().trace() / views;
    angle += covariance.value.bottomRightCorner<3, 3>().trace() / views;
  }
  std::printf("  tip %.2f mm rms, angle %.2f deg rms over all orientations\n",
              1e3 * std::sqrt(place), 57.29578 * std::sqrt(angle));
  EXPECT_LE(std::sqrt(place), 0.004);
  EXPECT_LE(std::sqrt(angle), 0.0524);
}

}  // namespace
}  // namespace glint

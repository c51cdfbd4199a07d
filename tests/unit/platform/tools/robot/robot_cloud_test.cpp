#include "platform/tools/robot/robot_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/tools/robot/sample_robot.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;

constexpr std::size_t k_point_bytes = 26;

// A box of 0.2 x 0.1 x 0.3 m (0.22 m2), and a sphere of radius 0.1 m (0.126 m2) on a mimic joint.
RobotModel robot(const Files& files) {
  return load_robot(
      {files.write(
           "arm.urdf",
           test::robot_xml(
               "<link name='base'><collision><geometry><box size='0.2 0.1 "
               "0.3'/></geometry></collision>"
               "</link><link name='slide'/><link name='the ball'><collision><geometry><sphere "
               "radius='0.1'/></geometry></collision></link>"
               "<joint name='j' type='continuous'><parent link='base'/><child link='slide'/>"
               "<origin xyz='0.1 -0.2 0.3' rpy='0.1 0.2 -0.3'/><axis xyz='0.6 0 -0.8'/></joint>"
               "<joint name='k' type='prismatic'><parent link='slide'/><child link='the ball'/>"
               "<origin xyz='0 0.3 0'/><axis xyz='0 1 0'/><mimic joint='j' multiplier='0.3' "
               "offset='0.01'/><limit effort='1' velocity='1' lower='-9' upper='9'/></joint>")),
       {}});
}

std::string bytes_of(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

TEST(RobotCloud, ComesBackAsItWasWritten) {
  const Files files;
  const RobotCloud cloud = sample_robot(robot(files), 5000);
  const std::string path = files.folder() + "/arm.ply";
  write_robot_cloud(path, cloud);
  const RobotCloud back = read_robot_cloud(path);
  EXPECT_EQ(back.name, cloud.name);
  EXPECT_EQ(back.links, (std::vector<std::string>{"base", "slide", "the ball"}));
  EXPECT_EQ(back.inputs, (std::vector<std::string>{"j"}));
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.normals, cloud.normals);
  EXPECT_EQ(back.point_links, cloud.point_links);
  EXPECT_EQ(back.spacing_m, cloud.spacing_m);
  // The forward kinematics of the file and of the URDF are bit-identical.
  const double values[] = {0.7};
  LinkPoses from_urdf, from_file;
  ASSERT_EQ(forward_kinematics(cloud.tree, values, from_urdf), Reason::none);
  ASSERT_EQ(forward_kinematics(back.tree, values, from_file), Reason::none);
  ASSERT_EQ(from_file.count, 3);
  for (std::size_t l = 0; l < 3; ++l) {
    EXPECT_EQ(from_file.T_root_link[l].translation, from_urdf.T_root_link[l].translation);
    EXPECT_EQ(from_file.T_root_link[l].rotation.coeffs(),
              from_urdf.T_root_link[l].rotation.coeffs());
  }
}

TEST(RobotCloud, LiesEvenlyOnTheSurface) {
  const Files files;
  const int count = 20'000;
  const RobotCloud cloud = sample_robot(robot(files), count);
  ASSERT_EQ(cloud.points.size(), static_cast<std::size_t>(count));
  const double area = 0.22 + 4 * M_PI * 0.01;
  EXPECT_NEAR(static_cast<double>(cloud.spacing_m), std::sqrt(area / count), 2e-5);
  // The number of points is proportional to area, by side of the box and by quarter of the largest.
  int sides[3] = {}, quarters[4] = {}, ball = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vector3f &p = cloud.points[i], &n = cloud.normals[i];
    ASSERT_NEAR(n.norm(), 1, 1e-5f);
    if (cloud.point_links[i] != 0) {
      ++ball;
      ASSERT_GT(p.dot(n), 0.09f);
      ASSERT_LT(p.norm(), 0.10001f);
      continue;
    }
    const Vector3f half(0.1f, 0.05f, 0.15f);
    const int axis = std::abs(n.x()) > 0.5f ? 0 : std::abs(n.y()) > 0.5f ? 1 : 2;
    ASSERT_NEAR(std::abs(p(axis)), half(axis), 1e-6f);
    ASSERT_TRUE(((p.cwiseAbs() - half).array() < 1e-6f).all());
    ++sides[axis];
    if (axis == 1) ++quarters[(p.x() > 0 ? 1 : 0) + (p.z() > 0 ? 2 : 0)];
  }
  const auto expect_share = [&](int points, double square_metres) {
    const double expected = count * square_metres / area;
    EXPECT_NEAR(points, expected, 4 * std::sqrt(expected));
  };
  expect_share(sides[0], 0.06);
  expect_share(sides[1], 0.12);
  expect_share(sides[2], 0.04);
  for (const int quarter : quarters) expect_share(quarter, 0.03);
  EXPECT_EQ(sides[0] + sides[1] + sides[2] + ball, count);
}

TEST(RobotCloud, RefusesCountsThatAreNone) {
  const Files files;
  expect_input_error([&] { (void)sample_robot(robot(files), 0); }, {"0 points", "expected 1"});
  expect_input_error([&] { (void)sample_robot(robot(files), 2'000'000); }, {"expected 1"});
  expect_input_error([&] { write_robot_cloud(files.folder() + "/no/a.ply", {}); }, {"no/a.ply"});
}

TEST(RobotCloud, RefusesFilesByNameAndLine) {
  const Files files;
  const std::string path = files.folder() + "/arm.ply";
  write_robot_cloud(path, sample_robot(robot(files), 100));
  const std::string good = bytes_of(path);
  const auto expect_error = [&](const std::string& from, const std::string& to,
                                std::initializer_list<const char*> words) {
    std::string bytes = good;
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    bytes.replace(at, from.size(), to);
    expect_input_error([&] { (void)read_robot_cloud(files.write("bad.ply", bytes)); }, words);
  };
  expect_error("ply\n", "plx\n", {"bad.ply:line 1", "ply"});
  expect_error("glint robot cloud 1", "made by hand", {"bad.ply", "glint robot cloud 1"});
  expect_error("binary_little_endian", "ascii", {"bad.ply:line 2", "binary_little_endian"});
  expect_error("vertex 100", "vertex 101", {"bad.ply", "2600 bytes for 101 points"});
  expect_error("vertex 100", "vertex 4000000000", {"bad.ply", "a count up to"});
  expect_error("ushort link", "uint link", {"bad.ply", "ushort link"});
  expect_error("joint turning 0", "joint turning 1", {"bad.ply", "a count up to 0"});
  expect_error("joint turning", "joint bending", {"bad.ply", "fixed, turning or sliding"});
  expect_error("sliding 1 0", "sliding 1 7", {"bad.ply", "input 7"});
  expect_error("comment input j\n", "", {"bad.ply", "input 0"});
  expect_error("comment link the ball\n", "", {"bad.ply", "2 links and 2 joints"});
  expect_error("spacing_m", "spacing", {"bad.ply", "spacing_m"});
  expect_error("0.59999999999999998", "5", {"bad.ply", "length 1"});
  expect_input_error(
      [&] { (void)read_robot_cloud(files.write("short.ply", good.substr(0, good.size() - 1))); },
      {"short.ply", "2599 bytes"});
  expect_input_error(
      [&] {
        (void)read_robot_cloud(files.write("head.ply", good.substr(0, good.find("comment link"))));
      },
      {"head.ply", "end_header"});
  std::string malformed = good;
  malformed.replace(malformed.size() - 2, 2, "\x09\x00", 2);  // link index of the last point
  expect_input_error([&] { (void)read_robot_cloud(files.write("link.ply", malformed)); },
                     {"link.ply", "point 99"});
  malformed = good;
  malformed.replace(malformed.size() - k_point_bytes, 4, "\xff\xff\xff\xff");
  expect_input_error([&] { (void)read_robot_cloud(files.write("nan.ply", malformed)); },
                     {"nan.ply", "point 99"});
}

}  // namespace
}  // namespace glint

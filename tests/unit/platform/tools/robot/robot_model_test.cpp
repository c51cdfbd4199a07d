#include "platform/tools/robot/robot_model.hpp"

#include <gtest/gtest.h>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/tools/robot/primitives.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;
using test::joint_xml;
using test::robot_xml;

const std::string k_box = "<collision><geometry><box size='0.1 0.2 0.3'/></geometry></collision>";

std::string link_xml(const std::string& name, const std::string& inside = "") {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}

RobotModel load(const Files& files, const std::string& inside) {
  return load_robot({files.write("arm.urdf", robot_xml(inside)), {}});
}

TEST(RobotModel, CountsInputsInTheOrderOfTheFileNotOfTheirNames) {
  const Files files;
  const RobotModel robot = load(files, link_xml("c") + link_xml("b") + link_xml("a", k_box) +
                                           link_xml("d") + joint_xml("z", "revolute", "b", "c") +
                                           joint_xml("y", "continuous", "a", "b") +
                                           joint_xml("x", "prismatic", "c", "d"));
  EXPECT_EQ(robot.inputs, (std::vector<std::string>{"z", "y", "x"}));
  EXPECT_EQ(robot.links, (std::vector<std::string>{"a", "b", "c", "d"}));
}

TEST(RobotModel, LetsAMimicFollowThroughAnother) {
  const Files files;
  const RobotModel robot =
      load(files, link_xml("a", k_box) + link_xml("b") + link_xml("c") + link_xml("d") +
                      joint_xml("j1", "prismatic", "a", "b") +
                      joint_xml("j2", "prismatic", "a", "c",
                                "<mimic joint='j1' multiplier='-2' offset='0.5'/>") +
                      joint_xml("j3", "prismatic", "a", "d",
                                "<mimic joint='j2' multiplier='3' offset='0.25'/>"));
  ASSERT_EQ(robot.inputs.size(), 1u);
  LinkPoses poses;
  ASSERT_EQ(forward_kinematics(robot.tree, std::vector<double>{0.125}, poses), Reason::none);
  EXPECT_DOUBLE_EQ(poses.T_root_link[2].translation.z(), -2 * 0.125 + 0.5);
  EXPECT_DOUBLE_EQ(poses.T_root_link[3].translation.z(), 3 * (-2 * 0.125 + 0.5) + 0.25);
}

TEST(RobotModel, RefusesWhatFormsNoTree) {
  const Files files;
  const std::string links = link_xml("a", k_box) + link_xml("b") + link_xml("c");
  expect_input_error(
      [&] {
        (void)load(files,
                   links + joint_xml("j", "fixed", "a", "b") + joint_xml("k", "fixed", "c", "b"));
      },
      {"arm.urdf", "'b'", "'j'", "'k'", "tree"});
  expect_input_error(
      [&] {
        (void)load(files,
                   links + joint_xml("j", "fixed", "b", "c") + joint_xml("k", "fixed", "c", "b"));
      },
      {"arm.urdf", "loop"});
  expect_input_error(
      [&] {
        (void)load(files, links + joint_xml("j", "fixed", "a", "b") +
                              joint_xml("k", "fixed", "b", "a") +
                              joint_xml("l", "fixed", "a", "c"));
      },
      {"arm.urdf", "loop"});
  expect_input_error([&] { (void)load(files, links + joint_xml("j", "fixed", "a", "nobody")); },
                     {"arm.urdf", "nobody"});
}

TEST(RobotModel, RefusesMimicsThatFollowNobody) {
  const Files files;
  const std::string links = link_xml("a", k_box) + link_xml("b") + link_xml("c");
  expect_input_error(
      [&] {
        (void)load(files, links + joint_xml("j", "revolute", "a", "b", "<mimic joint='ghost'/>") +
                              joint_xml("k", "fixed", "a", "c"));
      },
      {"'j'", "ghost"});
  expect_input_error(
      [&] {
        (void)load(files, links + joint_xml("j", "revolute", "a", "b", "<mimic joint='k'/>") +
                              joint_xml("k", "revolute", "a", "c", "<mimic joint='j'/>"));
      },
      {"mimics"});
}

TEST(RobotModel, RefusesWhatIsNoUrdfWithItsLine) {
  const Files files;
  expect_input_error(
      [&] {
        (void)load_robot({files.write("x.urdf", "<robot>\n<link"), {}});
      },
      {"x.urdf:"});
  expect_input_error([&] { (void)load_robot({files.write("x.urdf", ""), {}}); }, {"x.urdf"});
  expect_input_error(
      [&] {
        (void)load_robot({files.folder() + "/none.urdf", {}});
      },
      {"none.urdf", "cannot be read"});
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  expect_input_error(
      [&] {
        (void)load_robot({files.write("deep.urdf", deep), {}});
      },
      {"deep.urdf", "nested"});
  expect_input_error([&] { (void)load(files, link_xml("a")); }, {"no link has a surface"});
}

TEST(RobotModel, NamesAMissingMeshAndWhereItLooked) {
  const Files files;
  const std::string mesh =
      "<collision><geometry><mesh filename='package://arm/m/part.stl'/>"
      "</geometry></collision>";
  const std::string path = files.write("arm.urdf", robot_xml(link_xml("a", mesh)));
  expect_input_error(
      [&] {
        (void)load_robot({path, {files.folder()}});
      },
      {"arm.urdf", "part.stl", files.folder().c_str()});
  const std::string stl = test::stl_bytes(box_surface({0.1, 0.1, 0.1}));
  files.write("m/part.stl", stl);
  EXPECT_EQ(load_robot({path, {files.folder()}}).surfaces.at(0).faces.size(), 12u);
  EXPECT_EQ(load_robot({path, {"arm=" + files.folder()}}).surfaces.size(), 1u);
  expect_input_error([&] { (void)load_robot({path, {"leg=" + files.folder()}}); }, {"part.stl"});
}

TEST(RobotModel, PutsASurfaceWhereItsJointsHaveTurnedIt) {
  const Files files;
  const RobotModel robot =
      load(files, link_xml("a") +
                      link_xml("b",
                               "<visual><origin xyz='1 0 0' rpy='0 0 0'/>"
                               "<geometry><sphere radius='0.1'/></geometry></visual>") +
                      joint_xml("j", "revolute", "a", "b", "<origin xyz='0 0 2' rpy='0 0 0'/>"));
  const PosedSurface surface = posed_surface(robot, std::vector<double>{M_PI / 2}, "test");
  Vector3f sum = Vector3f::Zero();
  for (const Vector3f& corner : surface.corners) sum += corner;
  sum /= static_cast<float>(surface.corners.size());
  EXPECT_LT((sum - Vector3f(0, 1, 2)).norm(), 1e-4f);
  expect_input_error([&] { (void)posed_surface(robot, std::vector<double>{}, "joints.txt"); },
                     {"joints.txt", "expected 1"});
}

}  // namespace
}  // namespace glint

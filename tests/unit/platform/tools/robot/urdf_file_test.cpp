#include "platform/tools/robot/urdf_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::joint_xml;
using test::robot_xml;

constexpr std::size_t k_300_kB = 300'000;

std::string repeated(const std::string& piece) {
  std::string text;
  while (text.size() < k_300_kB) text += piece;
  return text;
}

void expect_refused(const std::string& text, const char* what) {
  expect_input_error([&] { (void)read_urdf_text(text, "/robot_description"); },
                     {"/robot_description", what});
}

// Each case caused SIGSEGV: urdfdom's parser recurses for every open element.
TEST(UrdfFile, RefusesDeepNestingWhateverHidesIt) {
  const std::string links = "<link name='a'/>";
  expect_refused(robot_xml(links + repeated("<a>")), "nested");
  expect_refused(robot_xml(links + repeated("<a>/>")), "nested");
  expect_refused(robot_xml(links + repeated("<a b=\"/>\">")), "nested");
  expect_refused("<robot name='<!--'>" + links + repeated("<a>"), "nested");
  expect_refused(robot_xml("<a b='<!--'/>" + links + repeated("<a>")), "nested");
  expect_refused(robot_xml(links + "<![CDATA[-->]]>" + repeated("<a>")), "nested");
}

// The text passed to urdfdom contains nothing that tinyxml2 skips, so that both see the same
// elements.
TEST(UrdfFile, HidesNoElementsFromItsOwnCheck) {
  const std::string deep = repeated("<a>");
  const std::string arm = "<robot name='arm'><link name='a'/></robot>";
  EXPECT_EQ(read_urdf_text("<!DOCTYPE r [<!ENTITY e '" + std::string("x") + "'>]>" + arm, "x")
                .model->getName(),
            "arm");
  EXPECT_EQ(read_urdf_text("<?skip " + deep + "?>" + arm, "x").model->getName(), "arm");
  EXPECT_EQ(read_urdf_text("<!-- " + deep + " -->" + arm, "x").model->getName(), "arm");
  EXPECT_EQ(
      read_urdf_text("<robot name='arm'><![CDATA[" + deep + "]]><link name='a'/></robot>", "x")
          .model->getName(),
      "arm");
}

TEST(UrdfFile, TakesSlashesAndCommentMarksInTextAndAttributes) {
  const UrdfFile file = read_urdf_text(
      "<robot name='a/>b'>text /> more <!-- -- <c> -->\n<link name='<!--'/><link name='l'/>" +
          joint_xml("j/>", "fixed", "&lt;!--", "l") + "</robot>",
      "x");
  EXPECT_EQ(file.model->getName(), "a/>b");
  ASSERT_EQ(file.joints.size(), 1u);
  EXPECT_EQ(file.joints[0], "j/>");
  EXPECT_NE(file.model->getLink("<!--"), nullptr);
}

TEST(UrdfFile, BoundsAttributesAndJoints) {
  std::string many;
  for (int i = 0; i < 100; ++i) many.append(" a").append(std::to_string(i)).append("='1'");
  expect_refused(robot_xml("<link name='a'" + many + "/>"), "attributes");
  std::string joints;
  for (int i = 0; i < 300; ++i) joints += joint_xml(std::to_string(i), "fixed", "a", "b");
  expect_refused(robot_xml(joints), "joints");
  expect_refused(robot_xml("<\xC3\xA4/>"), "name");
}

TEST(UrdfFile, CleansTheNamesOfJoints) {
  const UrdfFile file = read_urdf_text(robot_xml("<link name='a'/><link name='b'/>" +
                                                 joint_xml("j&#27;]0;x\n", "revolute", "a", "b")),
                                       "x");
  ASSERT_EQ(file.joints.size(), 1u);
  EXPECT_EQ(file.joints[0], "j?]0;x ");
  EXPECT_NE(file.model->getJoint(file.joints[0]), nullptr);
}

}  // namespace
}  // namespace glint

// Forward kinematics compared with Orocos KDL; the test builds KDL's tree from the XML itself.
#include <gtest/gtest.h>
#include <tinyxml.h>

#include <cstdlib>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <map>
#include <random>
#include <sstream>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/tools/robot/robot_model.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

KDL::Vector vector_of(const TiXmlElement* element, const char* attribute, KDL::Vector otherwise) {
  if (element == nullptr || element->Attribute(attribute) == nullptr) return otherwise;
  std::istringstream text(element->Attribute(attribute));
  KDL::Vector v;
  text >> v[0] >> v[1] >> v[2];
  return v;
}

struct KdlRobot {
  KDL::Tree tree;
  std::map<std::string, std::string> mimics;  // joint -> mimicked joint, multiplier 1
};

KdlRobot kdl_robot(const std::string& path) {
  TiXmlDocument document;
  EXPECT_TRUE(document.LoadFile(path.c_str()));
  std::vector<const TiXmlElement*> left;
  std::map<std::string, bool> is_child;
  const TiXmlElement* robot = document.FirstChildElement("robot");
  for (auto* j = robot->FirstChildElement("joint"); j; j = j->NextSiblingElement("joint")) {
    left.push_back(j);
    is_child[j->FirstChildElement("child")->Attribute("link")] = true;
  }
  std::string root;
  for (auto* l = robot->FirstChildElement("link"); l; l = l->NextSiblingElement("link")) {
    if (!is_child[l->Attribute("name")]) root = l->Attribute("name");
  }
  KdlRobot out{KDL::Tree(root), {}};
  while (!left.empty()) {
    std::vector<const TiXmlElement*> later;
    for (const TiXmlElement* j : left) {
      const TiXmlElement* origin = j->FirstChildElement("origin");
      const KDL::Vector xyz = vector_of(origin, "xyz", KDL::Vector::Zero());
      const KDL::Vector rpy = vector_of(origin, "rpy", KDL::Vector::Zero());
      const KDL::Frame frame(KDL::Rotation::RPY(rpy[0], rpy[1], rpy[2]), xyz);
      const KDL::Vector axis =
          frame.M * vector_of(j->FirstChildElement("axis"), "xyz", KDL::Vector(1, 0, 0));
      const std::string type = j->Attribute("type"), name = j->Attribute("name");
      KDL::Joint joint(name, KDL::Joint::Fixed);
      if (type == "revolute" || type == "continuous")
        joint = KDL::Joint(name, frame.p, axis, KDL::Joint::RotAxis);
      if (type == "prismatic") joint = KDL::Joint(name, frame.p, axis, KDL::Joint::TransAxis);
      const KDL::Segment segment(j->FirstChildElement("child")->Attribute("link"), joint, frame);
      if (!out.tree.addSegment(segment, j->FirstChildElement("parent")->Attribute("link"))) {
        later.push_back(j);
      }
      if (const TiXmlElement* mimic = j->FirstChildElement("mimic")) {
        out.mimics[name] = mimic->Attribute("joint");
      }
    }
    EXPECT_LT(later.size(), left.size());
    if (later.size() == left.size()) break;
    left = later;
  }
  return out;
}

void expect_equal_to_kdl(const std::string& urdf, const std::vector<std::string>& packages) {
  const RobotModel robot = load_robot({urdf, packages});
  const KdlRobot kdl = kdl_robot(urdf);
  // The solver copies the tree, and a copy renumbers the joints; copies of a copy agree.
  const KDL::Tree tree(kdl.tree);
  KDL::TreeFkSolverPos_recursive solver(tree);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-3.2, 3.2);
  std::map<std::string, std::size_t> input;
  for (std::size_t i = 0; i < robot.inputs.size(); ++i) input[robot.inputs[i]] = i;
  double worst = 0;
  for (int state = 0; state < 1000; ++state) {
    std::vector<double> values(robot.inputs.size());
    for (double& value : values) value = any(random);
    KDL::JntArray positions(tree.getNrOfJoints());
    for (const auto& [name, element] : tree.getSegments()) {
      const KDL::Joint& joint = element.segment.getJoint();
      if (joint.getType() == KDL::Joint::None || joint.getType() == KDL::Joint::Fixed) continue;
      const auto mimic = kdl.mimics.find(joint.getName());
      positions(element.q_nr) =
          values[input.at(mimic == kdl.mimics.end() ? joint.getName() : mimic->second)];
    }
    LinkPoses poses;
    ASSERT_EQ(forward_kinematics(robot.tree, values, poses), Reason::none);
    for (std::size_t l = 0; l < robot.links.size(); ++l) {
      KDL::Frame frame;
      ASSERT_GE(solver.JntToCart(positions, frame, robot.links[l]), 0) << robot.links[l];
      const Matrix3 rotation = poses.T_root_link[l].rotation.toRotationMatrix();
      for (int r = 0; r < 3; ++r) {
        worst = std::max(worst, std::abs(poses.T_root_link[l].translation(r) - frame.p[r]));
        for (int c = 0; c < 3; ++c) {
          worst = std::max(worst, std::abs(rotation(r, c) - frame.M(r, c)));
        }
      }
    }
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(ForwardKinematicsBesideKdl, AgreesOnABranchedRobotOfEveryKindOfJoint) {
  const test::Files files;
  std::string xml =
      "<link name='l0'><collision><geometry><box size='1 1 1'/></geometry></collision>"
      "</link>";
  const char* types[] = {"revolute", "prismatic", "continuous", "fixed"};
  for (int i = 1; i <= 12; ++i) {
    const std::string n = std::to_string(i);
    xml += "<link name='l" + n + "'/><joint name='j" + n + "' type='" + types[i % 4] +
           "'><parent link='l" + std::to_string(i / 2) + "'/><child link='l" + n +
           "'/><origin xyz='0.1 -0." + n + " 0.3' rpy='0." + n + " -1.2 2." + n +
           "'/><axis xyz='0.6 0 -0.8'/><limit effort='1' velocity='1' lower='-9' upper='9'/>" +
           (i == 9 ? "<mimic joint='j5'/>" : "") + "</joint>";
  }
  expect_equal_to_kdl(files.write("arm.urdf", test::robot_xml(xml)), {});
}

TEST(ForwardKinematicsBesideKdl, AgreesOnThreeRealRobots) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/robots/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  expect_equal_to_kdl(folder + "ur5/ur5_robot.urdf", {folder + "ur5"});
  expect_equal_to_kdl(folder + "panda/panda.urdf", {folder + "panda"});
  expect_equal_to_kdl(folder + "xarm7/xarm7.urdf", {folder + "xarm7"});
}

}  // namespace
}  // namespace glint

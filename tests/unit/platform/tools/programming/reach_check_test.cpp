// Points planted in strokes that a six-axis arm cannot run, judged by the closed form of the arm.
#include "platform/tools/programming/reach_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/tools/programming/arm_strokes.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using Arm = test::SixAxisArm;
using Joints = Arm::Joints;
using namespace test::arm_strokes;

std::string lines_of(const DrawnPath& path, const std::vector<ReachFailure>& failures) {
  std::string text;
  for (const ReachFailure& one : failures) text += failure_text(path, one) + '\n';
  return text;
}

TEST(ReachCheck, ReadsTheChainOfTheTip) {
  const Arm arm;
  const Robot robot(arm);
  EXPECT_EQ(robot.chain.joints, (std::vector<std::string>{"j1", "j2", "j3", "j4", "j5", "j6"}));
  EXPECT_NEAR(robot.chain.lower[1], -0.2, 1e-9);
  EXPECT_NEAR(robot.chain.reach_m, 1.37, 1e-9);
  EXPECT_THROW((void)read_chain(robot.files.folder() + "/arm.urdf", "tool9"), InputError);
  EXPECT_THROW((void)read_chain(robot.files.folder() + "/arm.urdf", "l0"), InputError);
}

// Newton steps from a distant guess may turn a joint several times.
TEST(InverseKinematics, SolutionIsWithinHalfATurnOfTheGuess) {
  Arm arm;
  arm.low.fill(-20);
  arm.high.fill(20);
  const Robot robot(arm);
  InverseKinematics solver(robot.chain, {});
  const Pose pose = Arm::forward({0.4, 0.6, 1.2, 0.3, 0.8, 0.2});
  test::Random random(9);
  int converged = 0;
  for (int n = 0; n < 200; ++n) {
    KDL::JntArray guess(6);
    for (unsigned i = 0; i < 6; ++i) guess(i) = random.within(-15, 15);
    const JointSolution one = solver.solve(pose, guess);
    if (!one.converged) continue;
    ++converged;
    EXPECT_LE((one.joints.data - guess.data).cwiseAbs().maxCoeff(), 3.1416) << n;
    Joints q{};
    for (unsigned i = 0; i < 6; ++i) q[i] = one.joints(i);
    EXPECT_LT((Arm::forward(q).translation - pose.translation).norm(), 1e-4);
  }
  EXPECT_GT(converged, 50);
}

// The closed form itself: forward of each inverse is the pose.
TEST(SixAxisArm, InverseIsOfForward) {
  test::Random random(3);
  for (int n = 0; n < 200; ++n) {
    Joints q{};
    for (double& one : q) one = random.within(-3, 3);
    const Pose pose = Arm::forward(q);
    const auto all = Arm::inverse(pose);
    ASSERT_EQ(all.size(), 8u);
    for (const Joints& one : all) {
      const Pose again = Arm::forward(one);
      EXPECT_LT((again.translation - pose.translation).norm(), 1e-9);
      EXPECT_GT(std::abs(again.rotation.dot(pose.rotation)), 1 - 1e-12);
    }
  }
}

TEST(ReachCheck, InventsNoFailureOn30Strokes) {
  const Arm arm;
  const Robot robot(arm);
  for (const std::uint64_t random_seed : {1u, 77u, 4021u}) {
    const DrawnPath path = strokes_of(arm, random_seed);
    EXPECT_EQ(lines_of(path, check_reach(path, robot.chain, {})), "") << random_seed;
  }
}

TEST(ReachCheck, FindsEveryPlantedPointAndNoOther) {
  const Arm arm;
  const Robot robot(arm);
  for (const std::uint64_t random_seed : {2u, 919u, 60601u}) {
    DrawnPath path = strokes_of(arm, random_seed);
    test::Random random(random_seed + 5);
    std::map<std::pair<std::size_t, std::size_t>, ReachFault> planted;
    for (std::size_t e = 0; e < path.size(); e += 2) {
      const int kind = static_cast<int>(e / 2) % 4;
      const Pose pose = kind == 0   ? unreachable_pose(random)
                        : kind == 1 ? limited_pose(arm, random)
                                    : singular_pose(arm, random, kind - 2);
      const std::size_t p =
          static_cast<std::size_t>(random.below(static_cast<int>(path[e].points.size())));
      path[e].points[p].pose = pose;
      const auto fault = truth(arm, pose);
      ASSERT_TRUE(fault.has_value());
      planted[{e + 1, p + 1}] = *fault;
    }
    const auto failures = check_reach(path, robot.chain, {});
    std::map<std::pair<std::size_t, std::size_t>, ReachFault> found;
    for (const ReachFailure& one : failures) found[{one.element, one.point}] = one.fault;
    EXPECT_EQ(found, planted) << random_seed << '\n' << lines_of(path, failures);
    std::printf("%zu of %zu points planted, %zu found\n", planted.size(), point_count(path),
                failures.size());
  }
}

// Universal Robots UR5, away from its three singularities: elbow, wrist, wrist above the shoulder
// (Hawkins 2013, Analytic Inverse Kinematics for the Universal Robots UR-5/UR-10 Arms).
TEST(ReachCheck, InventsNoFailureForARealRobot) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/robots/ur5";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const RobotModel robot = load_robot({folder + "/ur5_robot.urdf", {folder}});
  const KinematicChain chain = read_chain(folder + "/ur5_robot.urdf", "ee_link");
  ASSERT_EQ(chain.joints, robot.inputs);
  const auto tip = static_cast<std::size_t>(
      std::find(robot.links.begin(), robot.links.end(), "ee_link") - robot.links.begin());
  const auto away = [](const std::vector<double>& q) {
    const double shoulder = -0.425 * std::cos(q[1]) - 0.39225 * std::cos(q[1] + q[2]) +
                            0.09465 * std::sin(q[1] + q[2] + q[3]);
    return std::min({std::abs(std::sin(q[2])), std::abs(std::sin(q[4])), 2 * std::abs(shoulder)});
  };
  test::Random random(17);
  DrawnPath path;
  while (path.size() < 30) {
    std::vector<double> q(6), rate(6);
    for (std::size_t i = 0; i < 6; ++i) {
      q[i] = random.within(-2.8, 2.8);
      rate[i] = random.within(-0.03, 0.03);
    }
    PathElement stroke{PathKind::stroke, {}};
    while (stroke.points.size() < 20 && away(q) > 0.4) {
      LinkPoses poses;
      ASSERT_EQ(forward_kinematics(robot.tree, q, poses), Reason::none);
      stroke.points.push_back(point_at(poses.T_root_link[tip]));
      for (std::size_t i = 0; i < 6; ++i) q[i] += rate[i];
    }
    if (stroke.points.size() == 20) path.push_back(stroke);
  }
  EXPECT_EQ(lines_of(path, check_reach(path, chain, {})), "");
}

// Joint 1 alone moves beyond its limit.
TEST(ReachCheck, NamesTheJointAtItsLimit) {
  const Arm arm;
  const Robot robot(arm);
  DrawnPath path{{PathKind::stroke, {}}};
  for (double turn = 2.6; turn < 2.95; turn += 0.02) {
    path[0].points.push_back(point_at(Arm::forward({turn, 0.6, 1.2, 0.3, 0.8, 0.2})));
  }
  const auto failures = check_reach(path, robot.chain, {});
  ASSERT_EQ(failures.size(), 7u) << lines_of(path, failures);  // 2.82 to 2.94
  for (const ReachFailure& one : failures) EXPECT_EQ(one.joint, "j1");
  EXPECT_EQ(failure_text(path, failures[0]), "stroke 1, point 12: joint limit of j1");
}

TEST(ReachCheck, NamesAStepOfJointsAndAPointOutsideOfTheBox) {
  const Arm arm;
  const Robot robot(arm);
  DrawnPath path{{PathKind::stroke, {}}, {PathKind::waypoint, {}}};
  for (const double turn : {0.0, 0.2, 1.4, 1.5}) {
    path[0].points.push_back(point_at(Arm::forward({turn, 0.6, 1.2, 0.3, 0.8, 0.2})));
  }
  path[1].points.push_back(path[0].points[0]);
  PathCheckSettings settings;
  settings.start = {0, 0.6, 1.2, 0.3, 0.8, 0.2};
  auto failures = check_reach(path, robot.chain, settings);
  ASSERT_EQ(failures.size(), 1u) << lines_of(path, failures);
  EXPECT_EQ(failure_text(path, failures[0]), "stroke 1, point 3: step of joint j1");
  const Vector3& at = path[1].points[0].pose.translation;
  settings.workspace_m = {-2, -2, -2, 2, 2, at.z() - 0.001};
  failures = check_reach({path[1]}, robot.chain, settings);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_EQ(failure_text({path[1]}, failures[0]), "waypoint 1: outside of the workspace");
  settings.start.pop_back();
  EXPECT_THROW((void)check_reach(path, robot.chain, settings), InputError);
}

}  // namespace
}  // namespace glint

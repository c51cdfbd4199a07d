// Collisions of a six-axis arm with voxels placed at its links, judged by distances in closed form:
// sphere to box, and separating axes of two boxes.
#include "platform/tools/programming/collision_check.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "platform/input_error.hpp"
#include "platform/tools/mapping/host_cloud.hpp"
#include "platform/tools/mapping/occupancy.hpp"
#include "platform/tools/robot/primitives.hpp"
#include "tests/unit/platform/tools/programming/arm_strokes.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

using namespace test::arm_strokes;

constexpr double k_voxel_m = 0.02;
const Vector3 k_upper_box(0.08, 0.1, 0.3), k_hand_box(0.012, 0.012, 0.06);
constexpr double k_ball_m = 0.05;

struct Box {
  Pose pose;  // of its centre
  Vector3 half;
};

// Largest gap between two boxes along the 15 axes that can separate them; negative: they overlap.
// Gottschalk, Lin and Manocha 1996, OBBTree, section 5.
double gap_of(const Box& a, const Box& b) {
  const Matrix3 ra = a.pose.rotation.toRotationMatrix(), rb = b.pose.rotation.toRotationMatrix();
  const Vector3 apart = b.pose.translation - a.pose.translation;
  double gap = -1e9;
  const auto along = [&](const Vector3& axis) {
    if (axis.norm() < 1e-9) return;
    const Vector3 n = axis.normalized();
    const double extent =
        (ra.transpose() * n).cwiseAbs().dot(a.half) + (rb.transpose() * n).cwiseAbs().dot(b.half);
    gap = std::max(gap, std::abs(apart.dot(n)) - extent);
  };
  for (int i = 0; i < 3; ++i) {
    along(ra.col(i));
    along(rb.col(i));
    for (int j = 0; j < 3; ++j) along(ra.col(i).cross(rb.col(j)));
  }
  return gap;
}

double gap_of(const Vector3& centre, double radius, const Box& box) {
  const Vector3 local = box.pose.inverse() * centre;
  return (local.cwiseAbs() - box.half).cwiseMax(0).norm() - radius;
}

// Upper arm: a box. Forearm: three balls. Hand: a mesh that is thinner than a voxel.
std::string shapes() {
  const auto shape = [](const std::string& what, double z) {
    return "<collision><origin xyz='0 0 " + std::to_string(z) + "'/><geometry>" + what +
           "</geometry></collision>";
  };
  const std::string ball = "<sphere radius='0.05'/>";
  return "<link name='l1'/><link name='l2'>" + shape("<box size='0.08 0.1 0.3'/>", 0.2) +
         "</link><link name='l3'>" + shape(ball, 0.1) + shape(ball, 0.2) + shape(ball, 0.3) +
         "</link><link name='l4'/><link name='l5'/><link name='l6'>" +
         shape("<mesh filename='hand.stl'/>", 0.05) + "</link>";
}

struct ArmLinks {
  explicit ArmLinks(const KDL::JntArray& joints) {
    Joints q{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = joints(static_cast<unsigned>(i));
    tip = Arm::forward(q);
    const Quaternion r2 = Arm::turn(2, q[0]) * Arm::turn(1, q[1]);
    upper = {r2, Vector3(0, 0, Arm::base)};
    fore = {r2 * Arm::turn(1, q[2]), upper * Vector3(0, 0, Arm::upper)};
  }
  // Smallest gap of each link to the voxels.
  [[nodiscard]] std::array<double, 3> gaps(const std::vector<Box>& voxels) const {
    std::array<double, 3> gaps{1e9, 1e9, 1e9};
    const Box upper_box{{upper.rotation, upper * Vector3(0, 0, 0.2)}, 0.5 * k_upper_box};
    const Box hand_box{{tip.rotation, tip * Vector3(0, 0, 0.05 - Arm::hand)}, 0.5 * k_hand_box};
    for (const Box& voxel : voxels) {
      gaps[0] = std::min(gaps[0], gap_of(upper_box, voxel));
      for (const double z : {0.1, 0.2, 0.3})
        gaps[1] = std::min(gaps[1], gap_of(fore * Vector3(0, 0, z), k_ball_m, voxel));
      gaps[2] = std::min(gaps[2], gap_of(hand_box, voxel));
    }
    return gaps;
  }

  Pose upper, fore, tip;
};

// A map whose frame differs from the robot's, with voxels at points of the robot's frame.
struct VoxelMap {
  const Pose T_map_robot{Quaternion(Eigen::AngleAxisd(0.5, Vector3(1, 2, 3).normalized())),
                         {0.3, -0.2, 0.7}};
  std::vector<Box> voxels;  // in the robot's frame

  void add(const Vector3& point) {
    const Vector3 at = T_map_robot * point;
    const Vector3 centre = k_voxel_m * ((at / k_voxel_m).array().floor() + 0.5).matrix();
    voxels.push_back({{T_map_robot.rotation.conjugate(), T_map_robot.inverse() * centre},
                      Vector3::Constant(k_voxel_m / 2)});
  }
  [[nodiscard]] std::string bytes() const {
    OwnedCloud cloud(static_cast<int>(voxels.size()));
    for (const Box& voxel : voxels) {
      const Eigen::Vector3f at = (T_map_robot * voxel.pose.translation).cast<float>();
      EXPECT_TRUE(cloud.points().add(at.x(), at.y(), at.z()));
    }
    Occupancy occupancy({.resolution_m = k_voxel_m});
    occupancy.add_surface(cloud.points());
    return occupancy.file_bytes();
  }
};

// Element, point, link.
using Found = std::set<std::tuple<std::size_t, std::size_t, std::string>>;

Found found_in(const std::vector<PathCollision>& collisions) {
  Found found;
  for (const PathCollision& one : collisions) found.insert({one.element, one.point, one.link});
  return found;
}

Found judged(const PathMotion& motion, const std::vector<Box>& voxels) {
  const char* const links[] = {"l2", "l3", "l6"};
  Found found;
  for (const MotionSample& sample : motion.samples) {
    const auto gaps = ArmLinks(sample.joints).gaps(voxels);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(std::abs(gaps[i]), 1e-7) << "undecided";
      if (gaps[i] < 0) found.insert({sample.element, sample.point, links[i]});
    }
  }
  return found;
}

struct CollidingArm : Robot {
  CollidingArm() : Robot(Arm(), shapes()) {
    files.write("hand.stl", test::stl_bytes(box_surface(k_hand_box)));
    model = load_robot({urdf, {}});
  }
  RobotModel model;
};

TEST(CollisionCheck, FindsEveryPlantedPointOf30StrokesAndNoOther) {
  const Arm arm;
  const CollidingArm robot;
  constexpr std::array<std::uint64_t, 2> k_random_seeds{3, 512};
  for (int i = 0; i < test::repetitions(2, 1); ++i) {
    const std::uint64_t random_seed = k_random_seeds[static_cast<std::size_t>(i)];
    DrawnPath path = strokes_of(arm, random_seed);
    test::Random random(random_seed + 9);
    const FollowedPath clean = follow_path(path, robot.chain, {});
    ASSERT_TRUE(clean.failures.empty());
    std::set<std::tuple<std::size_t, std::size_t, ReachFault>> planted;
    Found planted_collisions;
    VoxelMap map;
    for (std::size_t e = 0; e < path.size(); e += 2) {
      const auto p =
          static_cast<std::size_t>(random.below(static_cast<int>(path[e].points.size())));
      const std::size_t kind = e / 2 % 5;
      if (kind < 2) {
        path[e].points[p].pose =
            kind == 0 ? unreachable_pose(random) : singular_pose(arm, random, 0);
        planted.insert({e + 1, p + 1, kind == 0 ? ReachFault::unreachable : ReachFault::singular});
        continue;
      }
      const ArmLinks links(*clean.joints[e][p]);
      map.add(kind == 2   ? links.upper * Vector3(0.05, 0, 0.3)
              : kind == 3 ? links.fore * Vector3(0, 0.05, 0.2)
                          : links.tip * Vector3(0, 0, 0.05 - Arm::hand));
      planted_collisions.insert({e + 1, p + 1, kind == 2 ? "l2" : kind == 3 ? "l3" : "l6"});
    }
    CollisionSettings settings;
    settings.octomap = robot.files.write("map.bt", map.bytes());
    settings.T_map_robot = map.T_map_robot;
    const FollowedPath followed = follow_path(path, robot.chain, {});
    std::set<std::tuple<std::size_t, std::size_t, ReachFault>> failures;
    for (const ReachFailure& one : followed.failures)
      failures.insert({one.element, one.point, one.fault});
    EXPECT_EQ(failures, planted);
    const PathMotion motion = path_motion(path, followed, robot.chain, {}, {});
    const auto collisions = check_collisions(motion, robot.model, robot.chain, settings);
    const Found found = found_in(collisions), truth = judged(motion, map.voxels);
    EXPECT_EQ(found, truth) << random_seed;
    for (const auto& one : planted_collisions)
      EXPECT_TRUE(found.count(one)) << std::get<0>(one) << ' ' << std::get<1>(one);
    std::printf("%zu samples; %zu planted voxels, %zu colliding moves\n", motion.samples.size(),
                map.voxels.size(), found.size());
  }
}

TEST(CollisionCheck, EqualsDistancesInClosedForm) {
  const Arm arm;
  const CollidingArm robot;
  test::Random random(77);
  VoxelMap map;
  PathMotion motion;
  const auto samples = static_cast<std::size_t>(test::repetitions(1500, 150));
  for (std::size_t i = 1; i <= samples; ++i) {
    KDL::JntArray joints(6);
    for (unsigned j = 0; j < 6; ++j) joints(j) = random.within(arm.low[j], arm.high[j]);
    motion.samples.push_back({i, 1, true, joints});
    if (i % 5 == 0) map.add(ArmLinks(joints).fore * random.in_box(0.8));
  }
  CollisionSettings settings;
  settings.octomap = robot.files.write("map.bt", map.bytes());
  settings.T_map_robot = map.T_map_robot;
  const Found found = found_in(check_collisions(motion, robot.model, robot.chain, settings));
  EXPECT_EQ(found, judged(motion, map.voxels));
  EXPECT_GT(found.size(), static_cast<std::size_t>(test::repetitions(500, 5)));
  EXPECT_LT(found.size(), 7 * samples / 3);
}

TEST(CollisionCheck, NamesPointAndLinkAndLeavesOutLinksThatMayTouch) {
  const CollidingArm robot;
  DrawnPath path{{PathKind::stroke, {}}};
  for (const double turn : {0.0, 0.4, 0.8})
    path[0].points.push_back(point_at(Arm::forward({turn, 0.6, 1.2, 0.3, 0.8, 0.2})));
  const FollowedPath followed = follow_path(path, robot.chain, {});
  const PathMotion motion = path_motion(path, followed, robot.chain, {}, {});
  EXPECT_EQ(motion.moves, 2);
  EXPECT_EQ(motion.not_followed, 0);
  const ArmLinks last(*followed.joints[0][2]);
  VoxelMap map;
  map.add(last.fore * Vector3(0, 0, 0.3));
  CollisionSettings settings;
  settings.octomap = robot.files.write("map.bt", map.bytes());
  settings.T_map_robot = map.T_map_robot;
  auto collisions = check_collisions(motion, robot.model, robot.chain, settings);
  ASSERT_EQ(collisions.size(), 1u);
  EXPECT_EQ(collision_text(path, collisions[0]), "stroke 1, point 3: link l3 touches the map");
  settings.touching = {"l3"};
  EXPECT_TRUE(check_collisions(motion, robot.model, robot.chain, settings).empty());
  settings.touching = {"l9"};
  EXPECT_THROW((void)check_collisions(motion, robot.model, robot.chain, settings), InputError);
  // Between two points only.
  VoxelMap between;
  const auto middle = static_cast<std::size_t>(motion.samples.size() / 4);
  ASSERT_FALSE(motion.samples[middle].at_point);
  between.add(ArmLinks(motion.samples[middle].joints).tip * Vector3(0, 0, 0.05 - Arm::hand));
  settings.touching = {"l3", "l2"};
  settings.octomap = robot.files.write("between.bt", between.bytes());
  collisions = check_collisions(motion, robot.model, robot.chain, settings);
  ASSERT_EQ(collisions.size(), 1u);
  EXPECT_EQ(collision_text(path, collisions[0]),
            "move to stroke 1, point 2: link l6 touches the map");
}

// Shapes of 0.2 m and voxels of 0.02 m at their centres, away from the surfaces.
TEST(CollisionCheck, FindsAVoxelInsideASolidAndOfAMeshOnlyAtItsSurface) {
  const auto link = [](const std::string& name, const std::string& shape) {
    return "<link name='" + name + "'><collision><geometry>" + shape +
           "</geometry></collision></link>";
  };
  const std::string arm_shapes = "<link name='l1'/>" + link("l2", "<box size='0.2 0.2 0.2'/>") +
                                 link("l3", "<cylinder radius='0.1' length='0.2'/>") +
                                 "<link name='l4'/><link name='l5'/>";
  const Joints q{0.3, 0.6, 1.2, 0.3, 0.8, 0.2};
  KDL::JntArray joints(6);
  for (unsigned i = 0; i < 6; ++i) joints(i) = q[i];
  PathMotion motion;
  motion.samples.push_back({1, 1, true, joints});
  const ArmLinks links(joints);
  VoxelMap map;
  for (const Vector3& centre : {links.upper.translation, links.fore.translation,
                                Vector3(links.tip * Vector3(0, 0, -Arm::hand))})
    map.add(centre);
  const auto found = [&](const std::string& shape) {
    const Robot robot(Arm(), arm_shapes + link("l6", shape));
    robot.files.write("cube.stl", test::stl_bytes(box_surface(Vector3::Constant(0.2))));
    CollisionSettings settings;
    settings.octomap = robot.files.write("map.bt", map.bytes());
    settings.T_map_robot = map.T_map_robot;
    return found_in(check_collisions(motion, load_robot({robot.urdf, {}}), robot.chain, settings));
  };
  const std::string mesh = "<mesh filename='cube.stl'/>";
  const Found inside{{1, 1, "l2"}, {1, 1, "l3"}}, all{{1, 1, "l2"}, {1, 1, "l3"}, {1, 1, "l6"}};
  EXPECT_EQ(found("<sphere radius='0.1'/>"), all);
  EXPECT_EQ(found(mesh), inside);
  map.add(links.tip.translation);  // on a face of the cube
  EXPECT_EQ(found(mesh), all);
}

TEST(CollisionCheck, FindsLinksThatTouchEachOther) {
  const std::string ball = "<collision><geometry><sphere radius='RADIUS'/></geometry></collision>";
  const auto link = [&](const std::string& name, const std::string& radius) {
    std::string shape = ball;
    return "<link name='" + name + "'>" + shape.replace(shape.find("RADIUS"), 6, radius) +
           "</link>";
  };
  const Robot robot(Arm(), link("l1", "0.3") + "<link name='l2'/>" + link("l3", "0.2") +
                               "<link name='l4'/><link name='l5'/>" + link("l6", "0.05"));
  const RobotModel model = load_robot({robot.urdf, {}});
  DrawnPath path{{PathKind::stroke, {}}};
  for (double elbow = 1.2; elbow < 2.35; elbow += 0.05)
    path[0].points.push_back(point_at(Arm::forward({0.3, 0.6, elbow, 0.3, 0.8, 0.2})));
  const PathMotion motion =
      path_motion(path, follow_path(path, robot.chain, {}), robot.chain, {}, {});
  CollisionSettings settings;
  settings.links = true;
  Found truth;
  for (const MotionSample& sample : motion.samples) {
    const ArmLinks links(sample.joints);
    const Vector3 wrist = links.tip * Vector3(0, 0, -Arm::hand);
    if ((wrist - links.upper.translation).norm() < 0.35)  // l1 and l3 are neighbours
      truth.insert({sample.element, sample.point, "l1"});
  }
  const auto collisions = check_collisions(motion, model, robot.chain, settings);
  EXPECT_EQ(found_in(collisions), truth);
  ASSERT_FALSE(collisions.empty());
  EXPECT_LT(collisions.size(), path[0].points.size());
  EXPECT_NE(collision_text(path, collisions.back()).find("link l1 touches link l6"),
            std::string::npos);
}

TEST(CollisionCheck, RefusesAFileThatIsNoMap) {
  const CollidingArm robot;
  const DrawnPath path{
      {PathKind::waypoint, {point_at(Arm::forward({0, 0.6, 1.2, 0.3, 0.8, 0.2}))}}};
  const PathMotion motion =
      path_motion(path, follow_path(path, robot.chain, {}), robot.chain, {}, {});
  CollisionSettings settings;
  for (const std::string& name :
       {robot.files.write("text.bt", "no map at all\n"), robot.files.folder() + "/absent.bt"}) {
    settings.octomap = name;
    try {
      (void)check_collisions(motion, robot.model, robot.chain, settings);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
    }
  }
}

// Steps on the straight line, at most the declared distance apart, solved by the closed form's arm.
TEST(PathMotion, SamplesLieOnTheLine) {
  const Arm arm;
  const Robot robot(arm);
  const DrawnPath path = strokes_of(arm, 41);
  const MotionSteps steps{0.003, 0.02};
  const PathMotion motion =
      path_motion(path, follow_path(path, robot.chain, {}), robot.chain, {}, steps);
  EXPECT_EQ(motion.moves, static_cast<std::int64_t>(point_count(path)) - 1);
  EXPECT_LT(motion.not_followed, 30);  // all are between strokes
  for (std::size_t i = 1; i < motion.samples.size(); ++i) {
    const MotionSample& sample = motion.samples[i];
    if (sample.point == 1) continue;
    const Vector3 from = path[sample.element - 1].points[sample.point - 2].pose.translation;
    const Vector3 to = path[sample.element - 1].points[sample.point - 1].pose.translation;
    const Vector3 at = ArmLinks(sample.joints).tip.translation;
    const Vector3 before = ArmLinks(motion.samples[i - 1].joints).tip.translation;
    EXPECT_LT((at - from).cross(to - from).norm(), 2e-4 * (to - from).norm() + 1e-12);
    EXPECT_LE((at - before).norm(), steps.distance_m + 2e-4);
  }
}

}  // namespace
}  // namespace glint

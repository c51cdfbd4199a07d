#include "platform/tools/reference/find_reference.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "platform/tools/robot/primitives.hpp"
#include "tests/unit/platform/tools/reference/post_arm.hpp"

namespace glint {
namespace {

PosedSurface surface_of(const std::vector<std::pair<Vector3, Vector3>>& boxes) {
  PosedSurface surface;
  for (const auto& [size, middle] : boxes) {
    for (const Triangle& t : box_surface(size)) {
      const auto first = static_cast<std::int32_t>(surface.corners.size());
      for (const Vector3f& p : {t.a, t.b, t.c}) {
        surface.corners.push_back(p + middle.cast<float>());
      }
      surface.faces.push_back({first, first + 1, first + 2});
    }
  }
  return surface;
}

// Surfaces of a post with a horizontal arm, and of a post with fourfold symmetry.
PosedSurface arm() {
  return surface_of({{{0.2, 0.2, 0.5}, {0, 0, 0.25}},
                     {{0.5, 0.11, 0.1}, {0.2, 0, 0.45}},
                     {{0.08, 0.12, 0.3}, {0.41, 0, 0.35}}});
}
PosedSurface post() { return surface_of({{{0.2, 0.2, 0.5}, {0, 0, 0.25}}}); }

// A view from above, oblique to all sides of a box: an edge-on side leaves a direction
// undetermined. The yaw is applied before the roll, as a roll first would tilt the robot.
const Pose k_truth{pose_from_xyz_rpy({0, 0, 0, 2.094, 0, 0}).rotation *
                       pose_from_xyz_rpy({0, 0, 0, 0, 0, 0.7}).rotation,
                   {-0.1, 0.15, 1.3}};

std::vector<SceneFrame> scene_of(const PosedSurface& model, const Pose& T_camera_base) {
  SceneFrame frame;
  frame.camera = {160, 120, 150, 150, 80, 60};
  frame.model = model;
  frame.depth_m.resize(160 * 120);
  std::vector<std::int32_t> face(frame.depth_m.size());
  std::vector<ProjectedCorner> corners(model.corners.size());
  EXPECT_EQ(
      render_depth(model.surface(), T_camera_base, frame.camera, {frame.depth_m, face, corners}),
      Reason::none);
  for (float& z : frame.depth_m) z = z == 0 ? 2.2f : z;
  return {frame};
}

Pose off(double shift_m, double radians) {
  return Pose{pose_from_xyz_rpy({0, 0, 0, radians, -radians, radians}).rotation * k_truth.rotation,
              k_truth.translation + Vector3(shift_m, -shift_m, shift_m)};
}

TEST(FindReference, AcceptsTheRobotThatIsThere) {
  const Reference r = find_reference(scene_of(arm(), k_truth), off(0.05, 0.08), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::accepted) << r.reason;
  EXPECT_LT((r.found.alignment.T_world_base.translation - k_truth.translation).norm(), 1e-3);
  EXPECT_GT(r.starts, 1);
}

TEST(FindReference, CallsAPostThatLooksAlikeFromFourSidesAmbiguous) {
  const Reference r = find_reference(scene_of(post(), k_truth), off(0.02, 0.03), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::ambiguous) << r.reason;
  ASSERT_FALSE(r.alternatives.empty());
  EXPECT_TRUE(SearchRange{}.contains(off(0.02, 0.03), r.found.alignment.T_world_base));
  EXPECT_FALSE(SearchRange{}.contains(off(0.02, 0.03), r.alternatives[0].alignment.T_world_base));
  const double turn = r.alternatives[0].alignment.T_world_base.rotation.angularDistance(
      r.found.alignment.T_world_base.rotation);
  EXPECT_NEAR(std::fmod(turn + 0.01, M_PI / 2), 0.01, 0.02);
}

TEST(FindReference, RefusesAnEmptyRoomAndSaysWhy) {
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  for (float& z : frames[0].depth_m) z = 2.2f;
  const Reference r = find_reference(frames, off(0.05, 0.08), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_FALSE(r.reason.empty());
}

TEST(FindReference, RefusesWhatLiesFlatOnAWall) {
  std::vector<SceneFrame> frames = scene_of(post(), k_truth);
  frames[0].model = surface_of({{{0.3, 0.5, 0.02}, {0, 0, 0}}, {{0.02, 0.3, 0.02}, {0.2, 0, 0}}});
  for (float& z : frames[0].depth_m) z = 1.3f;
  FindReferenceSettings settings;
  settings.sigma_max_m = settings.sigma_max_rad = 1e9;  // a wall leaves 3 dof open
  settings.alignment.gate_count = 0;
  settings.search_alternatives = false;
  const Pose flat{Quaternion::Identity(), {0, 0, 1.31}};
  const Reference r = find_reference(frames, flat, settings);
  EXPECT_EQ(r.found.judgement.inlier_share(), 1);
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_NE(r.reason.find("outline"), std::string::npos) << r.reason;
}

TEST(FindReference, RefusesWhatIsMostlyHidden) {
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  for (std::size_t i = 0; i < frames[0].depth_m.size(); ++i) {
    if (i % 160 < 100) frames[0].depth_m[i] = 0.7f;
  }
  EXPECT_EQ(find_reference(frames, k_truth, {}).verdict, ReferenceVerdict::refused);
}

TEST(FindReference, WantsAMaskOrASecondPlaceWhereHalfIsHidden) {
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  std::vector<std::uint8_t> mask;
  for (std::size_t i = 0; i < frames[0].depth_m.size(); ++i) {
    mask.push_back(frames[0].depth_m[i] < 2 && i % 160 >= 74 ? 1 : 0);
    if (i % 160 < 74) frames[0].depth_m[i] = 0.7f;
  }
  const Reference alone = find_reference(frames, off(0.02, 0.03), {});
  EXPECT_LT(alone.found.judgement.visible_share(), 0.75);
  EXPECT_GT(alone.found.judgement.visible_share(), 0.4);
  EXPECT_EQ(alone.verdict, ReferenceVerdict::refused);
  EXPECT_NE(alone.reason.find("from one viewpoint without a mask"), std::string::npos)
      << alone.reason;
  frames[0].mask = mask;
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::accepted);
  frames[0].mask.clear();
  frames.push_back(frames[0]);
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::refused);
  // From a second position the occluding object no longer covers the robot.
  const Pose aside{pose_from_xyz_rpy({0, 0, 0, 0, 0.2, 0}).rotation, {-0.3, 0, 0.1}};
  frames[1] = scene_of(arm(), aside * k_truth)[0];
  frames[1].T_camera_world = aside;
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::accepted);
}

TEST(FindReference, FindsTheRobotFromAFarCornerOfTheRange) {
  const Pose start{pose_from_xyz_rpy({0, 0, 0, 0.5, -0.5, 0.4}).rotation * k_truth.rotation,
                   k_truth.translation + Vector3(0.3, -0.3, 0.3)};
  const Reference r = find_reference(scene_of(arm(), k_truth), start, {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::accepted) << r.reason;
  EXPECT_LT((r.found.alignment.T_world_base.translation - k_truth.translation).norm(), 1e-3);
}

TEST(FindReference, AcceptsNoPoseBeyondTheRange) {
  FindReferenceSettings settings;
  settings.range = {0.03, 0.05};
  const Reference r = find_reference(scene_of(arm(), k_truth), off(0.08, 0.02), settings);
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_NE(r.reason.find("range"), std::string::npos) << r.reason;
}

TEST(FindReference, CallsOnePictureAmbiguousIfNoRivalWasSearched) {
  FindReferenceSettings settings;
  settings.search_alternatives = false;
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  const Reference alone = find_reference(frames, off(0.02, 0.03), settings);
  EXPECT_EQ(alone.verdict, ReferenceVerdict::ambiguous) << alone.reason;
  for (const float z : frames[0].depth_m) frames[0].mask.push_back(z < 2 ? 1 : 0);
  const Reference masked = find_reference(frames, off(0.02, 0.03), settings);
  EXPECT_EQ(masked.verdict, ReferenceVerdict::accepted) << masked.reason;
}

TEST(FindReference, StatesTheErrorsThatAPictureShares) {
  FindReferenceSettings settings;
  settings.search_alternatives = false;
  const std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  settings.shared_errors = {0, 0};
  const Matrix6 without = find_reference(frames, k_truth, settings).found.alignment.covariance;
  settings.shared_errors.depth_sigma_m = 0.008;
  const Matrix6 with = find_reference(frames, k_truth, settings).found.alignment.covariance;
  const auto sigma = [](const Matrix6& c) { return std::sqrt(c.topLeftCorner<3, 3>().trace()); };
  EXPECT_LT(sigma(without), 0.002);
  EXPECT_GT(sigma(with), 0.006);
}

TEST(FindReference, StatesHowFarTheEndsOfItsPicturesLieApart) {
  FindReferenceSettings settings;
  settings.search_alternatives = false;
  settings.shared_errors = {0, 0};
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  frames.push_back(frames[0]);
  const Matrix6 alike = find_reference(frames, k_truth, settings).found.alignment.covariance;
  for (float& z : frames[1].depth_m) z += 0.02f;
  const Matrix6 apart = find_reference(frames, k_truth, settings).found.alignment.covariance;
  const auto sigma = [](const Matrix6& c) { return std::sqrt(c.topLeftCorner<3, 3>().trace()); };
  EXPECT_LT(sigma(alike), 0.002);
  EXPECT_GT(sigma(apart), 0.008);
}

TEST(FindReference, RefusesOtherJointValuesAndNamesTheLink) {
  const test::Files files;
  const RobotModel robot = load_robot({files.write("arm.urdf", post_arm_xml()), {}});
  std::vector<SceneFrame> frames = post_arm_scene(robot, std::array{0.4, 0.02});
  for (const float z : frames[0].depth_m) frames[0].mask.push_back(z < 2 ? 1 : 0);
  const Reference right = find_reference(frames, k_post_arm_guess, {});
  EXPECT_EQ(right.verdict, ReferenceVerdict::accepted) << right.reason;
  frames[0].model = posed_surface(robot, std::array{0.4, 0.14}, "a test");
  FindReferenceSettings lenient;
  lenient.inlier_share_min = 0;
  lenient.seen_through_share_max = 1;
  lenient.mask_share_min = 0;
  const Reference slid = find_reference(frames, k_post_arm_guess, lenient);
  EXPECT_EQ(slid.verdict, ReferenceVerdict::refused);
  EXPECT_NE(slid.reason.find("link 2"), std::string::npos) << slid.reason;
}

TEST(FindReference, RefusesAPictureThatDisagreesWithTheOthers) {
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  for (const char* name : {"b", "c", "d", "e", "f"}) {
    frames.push_back(frames[0]);
    frames.back().name = name;
  }
  Pose elsewhere = k_truth;
  elsewhere.translation.x() += 0.2;
  frames[3].depth_m = scene_of(arm(), elsewhere)[0].depth_m;
  FindReferenceSettings lenient;
  lenient.inlier_share_min = 0.6;
  lenient.seen_through_share_max = 0.3;
  const Reference r = find_reference(frames, k_truth, lenient);
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_EQ(r.reason.rfind("d: ", 0), 0u) << r.reason;
}

TEST(FindReference, GivesTheSameBitsAgain) {
  const std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  const Reference a = find_reference(frames, off(0.05, 0.08), {});
  const Reference b = find_reference(frames, off(0.05, 0.08), {});
  EXPECT_EQ(a.found.alignment.T_world_base.translation, b.found.alignment.T_world_base.translation);
  EXPECT_EQ(a.found.judgement.inliers, b.found.judgement.inliers);
}

TEST(Seed, TurnsAboutFixedAxes) {
  const Pose pose = pose_from_xyz_rpy({1, 2, 3, M_PI / 2, 0, M_PI / 2});
  // Roll about x is applied first: y goes to z, which the yaw keeps; the yaw moves x to y.
  EXPECT_LT((pose.rotation * Vector3::UnitY() - Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((pose.rotation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(pose.translation, Vector3(1, 2, 3));
}

}  // namespace
}  // namespace glint

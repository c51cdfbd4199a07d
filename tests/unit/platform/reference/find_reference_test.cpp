#include "platform/reference/find_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/robot/primitives.hpp"

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

// Of an arm that reaches out, and of a post that looks alike from four sides.
PosedSurface arm() {
  return surface_of({{{0.2, 0.2, 0.5}, {0, 0, 0.25}},
                     {{0.5, 0.11, 0.1}, {0.2, 0, 0.45}},
                     {{0.08, 0.12, 0.3}, {0.41, 0, 0.35}}});
}
PosedSurface post() { return surface_of({{{0.2, 0.2, 0.5}, {0, 0, 0.25}}}); }

// Seen from above, all sides of a box aslant: where one is seen edge on a direction stays open.
// Roll before yaw would lean the robot: the yaw comes first.
const Pose k_truth{
    pose_of_seed({0, 0, 0, 2.094, 0, 0}).rotation * pose_of_seed({0, 0, 0, 0, 0, 0.7}).rotation,
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
  return Pose{pose_of_seed({0, 0, 0, radians, -radians, radians}).rotation * k_truth.rotation,
              k_truth.translation + Vector3(shift_m, -shift_m, shift_m)};
}

TEST(FindReference, AcceptsTheRobotThatIsThere) {
  const Reference r = find_reference(scene_of(arm(), k_truth), off(0.05, 0.08), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::accepted) << r.why;
  EXPECT_LT((r.found.alignment.T_world_base.translation - k_truth.translation).norm(), 1e-3);
  EXPECT_GT(r.starts, 1);
}

TEST(FindReference, CallsAPostThatLooksAlikeFromFourSidesAmbiguous) {
  const Reference r = find_reference(scene_of(post(), k_truth), off(0.02, 0.03), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::ambiguous) << r.why;
  ASSERT_FALSE(r.rivals.empty());
  const double turn = r.rivals[0].alignment.T_world_base.rotation.angularDistance(
      r.found.alignment.T_world_base.rotation);
  EXPECT_NEAR(std::fmod(turn + 0.01, M_PI / 2), 0.01, 0.02);
}

TEST(FindReference, RefusesAnEmptyRoomAndSaysWhy) {
  std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  for (float& z : frames[0].depth_m) z = 2.2f;
  const Reference r = find_reference(frames, off(0.05, 0.08), {});
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_FALSE(r.why.empty());
}

TEST(FindReference, RefusesWhatLiesFlatOnAWall) {
  std::vector<SceneFrame> frames = scene_of(post(), k_truth);
  frames[0].model = surface_of({{{0.3, 0.5, 0.02}, {0, 0, 0}}, {{0.02, 0.3, 0.02}, {0.2, 0, 0}}});
  for (float& z : frames[0].depth_m) z = 1.3f;
  FindReferenceSettings settings;
  settings.sigma_max_m = settings.sigma_max_rad = 1e9;  // a wall leaves three directions open
  settings.alignment.gate_count = 0;
  settings.other_starts = false;
  const Pose flat{Quaternion::Identity(), {0, 0, 1.31}};
  const Reference r = find_reference(frames, flat, settings);
  EXPECT_EQ(r.found.judgement.inlier_share(), 1);
  EXPECT_EQ(r.verdict, ReferenceVerdict::refused);
  EXPECT_NE(r.why.find("outline"), std::string::npos) << r.why;
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
  EXPECT_NE(alone.why.find("from one place without a mask"), std::string::npos) << alone.why;
  frames[0].mask = mask;
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::accepted);
  frames[0].mask.clear();
  frames.push_back(frames[0]);
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::refused);
  // Seen from elsewhere, too, what hides it is no longer in the way.
  const Pose aside{pose_of_seed({0, 0, 0, 0, 0.2, 0}).rotation, {-0.3, 0, 0.1}};
  frames[1] = scene_of(arm(), aside * k_truth)[0];
  frames[1].T_camera_world = aside;
  EXPECT_EQ(find_reference(frames, off(0.02, 0.03), {}).verdict, ReferenceVerdict::accepted);
}

TEST(FindReference, GivesTheSameBitsAgain) {
  const std::vector<SceneFrame> frames = scene_of(arm(), k_truth);
  const Reference a = find_reference(frames, off(0.05, 0.08), {});
  const Reference b = find_reference(frames, off(0.05, 0.08), {});
  EXPECT_EQ(a.found.alignment.T_world_base.translation, b.found.alignment.T_world_base.translation);
  EXPECT_EQ(a.found.judgement.inliers, b.found.judgement.inliers);
}

TEST(Seed, TurnsAboutFixedAxes) {
  const Pose pose = pose_of_seed({1, 2, 3, M_PI / 2, 0, M_PI / 2});
  // Rolled about x first: y goes to z, which the yaw leaves; x goes to y by the yaw.
  EXPECT_LT((pose.rotation * Vector3::UnitY() - Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((pose.rotation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(pose.translation, Vector3(1, 2, 3));
}

}  // namespace
}  // namespace glint

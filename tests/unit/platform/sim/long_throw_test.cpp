#include "platform/sim/long_throw.hpp"

#include <gtest/gtest.h>

#include "platform/sources/scenario_of.hpp"
#include "platform/tools/robot/primitives.hpp"

namespace glint {
namespace {

constexpr int k_frame = 450;
constexpr std::size_t k_middle = 36 * 80 + 40;

PosedSurface box(double side_m) {
  PosedSurface surface;
  for (const Triangle& t : box_surface(Vector3(side_m, side_m, side_m))) {
    const auto first = static_cast<std::int32_t>(surface.corners.size());
    surface.corners.insert(surface.corners.end(), {t.a, t.b, t.c});
    surface.faces.push_back({first, first + 1, first + 2});
  }
  return surface;
}

class LongThrowTest : public testing::Test {
 protected:
  // Depth image with an upright box of 20 cm in front of the camera, its centre at range_m.
  std::vector<float> with_box_at(double range_m) {
    sim::SimFrame frame;
    simulator_.describe(k_frame, frame);
    const Pose ahead{Quaternion::Identity(), Vector3(0, 0, range_m)};
    MappingCamera camera(simulator_, box(0.2), frame.truth.T_world_camera * ahead);
    return camera.depth(k_frame, frame);
  }

  sim::Simulator simulator_{scenario_of(default_cell())};
};

TEST_F(LongThrowTest, DrawsTheRobotWhereItStands) {
  const std::vector<float> near = with_box_at(0.3), far = with_box_at(5);
  EXPECT_NEAR(near[k_middle], 0.2, 6 * k_long_throw_sigma_m);
  EXPECT_GT(far[k_middle], 0.3);  // behind the room's walls it occludes nothing
  EXPECT_LT(far[k_middle], 3.5);
  // Outside the box the images are bit-identical.
  EXPECT_EQ(near[0], far[0]);
  for (const float z : far) EXPECT_TRUE(z > 0.1f && z < 6.0f) << z;
}

TEST_F(LongThrowTest, GivesTheSamePictureTwice) { EXPECT_EQ(with_box_at(0.5), with_box_at(0.5)); }

}  // namespace
}  // namespace glint

#include "platform/reference/depth_picture.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "platform/reference/scene.hpp"
#include "platform/sensors/npy.hpp"
#include "tests/unit/platform/calibrate/expect_message.hpp"
#include "tests/unit/platform/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;

CameraModel camera(int width, int height) {
  CameraModel model;
  model.width = width;
  model.height = height;
  model.fx = model.fy = 500;
  model.cx = width / 2.0;
  model.cy = height / 2.0;
  return model;
}

TEST(DepthPicture, TakesMetresAndLeavesOutWhatIsNone) {
  const Files files;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string path =
      files.write("d.npy", npy_float32_bytes({{2, 3}, {1, nan, -1, 0, 1.5f, 1e9f}}));
  const DepthImage depth = read_depth(path, camera(3, 2));
  EXPECT_EQ(depth.z_m, (std::vector<float>{1, 0, 0, 0, 1.5f, 0}));
}

TEST(DepthPicture, RefusesAnotherSizeNoDepthAndUnknownKinds) {
  const Files files;
  const std::string path = files.write("d.npy", npy_float32_bytes({{2, 3}, {1, 1, 1, 1, 1, 1}}));
  expect_input_error([&] { (void)read_depth(path, camera(2, 3)); }, {"d.npy", "3 x 2", "2 x 3"});
  const std::string none = files.write("n.npy", npy_float32_bytes({{1, 2}, {0, -1}}));
  expect_input_error([&] { (void)read_depth(none, camera(2, 1)); }, {"n.npy", "no pixel"});
  expect_input_error([&] { (void)read_depth("a.jpg", camera(2, 1)); }, {"a.jpg", ".npy"});
  expect_input_error([&] { (void)read_depth(files.write("a.png", "no"), camera(2, 1)); },
                     {"a.png", "PNG"});
  expect_input_error([&] { (void)read_mask(files.folder() + "/m.png", camera(2, 1)); },
                     {"m.png", "cannot be opened"});
}

TEST(DepthImage, TakesTheNearestOfAPixelsPoints) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vector3f> points = {{0, 0, 2}, {0, 0, 1.5f}, {0, 0, 3},
                                        {9, 9, 1}, {0, 0, -1},   {nan, 0, 1}};
  const DepthImage depth = depth_of_points(points, camera(5, 3));
  for (std::size_t i = 0; i < 15; ++i) EXPECT_FLOAT_EQ(depth.z_m[i], i == 7 ? 1.5f : 0) << i;
}

TEST(SceneFrame, MergesBlocksWithoutMixingNearAndFar) {
  DepthImage depth{640, 4, std::vector<float>(640 * 4, 1.0f)};
  depth.z_m[0] = 3;  // one far pixel of the first block
  depth.z_m[2] = depth.z_m[3] = depth.z_m[642] = depth.z_m[643] = 0;  // the second has none
  const SceneFrame frame = scene_frame(depth, nullptr, camera(640, 4));
  EXPECT_EQ(frame.camera.width, 320);
  EXPECT_EQ(frame.camera.height, 2);
  EXPECT_DOUBLE_EQ(frame.camera.fx, 250);
  EXPECT_DOUBLE_EQ(frame.camera.cx, 160);
  EXPECT_FLOAT_EQ(frame.depth_m[0], 1);
  EXPECT_EQ(frame.depth_m[1], 0);
}

TEST(SceneFrame, StraightensALens) {
  CameraModel bent = camera(320, 240);
  bent.lens = Lens::brown;
  bent.distortion[0] = -0.2;
  DepthImage depth{320, 240, std::vector<float>(320 * 240, 1.0f)};
  const Result<Vector2> at = project(bent, {(300.5 - 160) / 500, (20.5 - 120) / 500, 1});
  ASSERT_TRUE(at);
  const auto pixel =
      static_cast<std::size_t>(at.value.y()) * 320 + static_cast<std::size_t>(at.value.x());
  EXPECT_NE(pixel, 20u * 320 + 300);
  depth.z_m[pixel] = 2;
  EXPECT_FLOAT_EQ(scene_frame(depth, nullptr, bent).depth_m[20 * 320 + 300], 2);
}

}  // namespace
}  // namespace glint

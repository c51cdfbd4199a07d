#include "platform/tools/reference/depth_image.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "platform/formats/npy.hpp"
#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/reference/scene.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

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
  expect_input_error([&] { (void)read_depth("a.jpg", camera(2, 1)); }, {"a.jpg", ".npy", ".ply"});
  expect_input_error([&] { (void)read_depth(files.write("a.png", "no"), camera(2, 1)); },
                     {"a.png", "PNG"});
  expect_input_error([&] { (void)read_mask(files.folder() + "/m.png", camera(2, 1)); },
                     {"m.png", "cannot be read"});
}

// OpenCV allocates memory for every pixel that a file's header states.
TEST(DepthPicture, RefusesAPngThatSaysItIsEnormous) {
  const Files files;
  for (const std::string& size :
       {std::string("\0\0\xEA\x60\0\0\0\1", 8), std::string("\0\0\x27\x10\0\0\x27\x10", 8)}) {
    const std::string head = std::string("\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR", 16) + size;
    const std::string path = files.write("a.png", head + std::string("\x10\0\0\0\0", 5));
    expect_input_error([&] { (void)read_depth(path, camera(2, 1)); },
                       {"a.png:byte 16", "0 x ", "pixels; expected at most"});
  }
}

TEST(SceneFrame, TakesPointsThatAreFewerThanThePicturesPixels) {
  // An image of 1280 x 720 is processed at 320 x 180; one point for every four of those pixels.
  const CameraModel large = camera(1280, 720);
  std::vector<Vector3f> points;
  for (int y = 1; y < 180; y += 2) {
    for (int x = 1; x < 320; x += 2) {
      const float z = x < 160 ? 1.0f : 2.0f;
      points.emplace_back((static_cast<float>(x) - 159.5f) / 125 * z,
                          (static_cast<float>(y) - 89.5f) / 125 * z, z);
    }
  }
  points.emplace_back(0.0f, 0.0f, 1.5f);  // isolated: x is 160, y is 90
  points.emplace_back(9.0f, 0.0f, 1.0f);  // outside the image
  const SceneFrame frame = scene_frame(points, nullptr, large);
  ASSERT_EQ(frame.depth_m.size(), 320u * 180);
  for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
    const std::size_t x = i % 320, y = i / 320;
    const float z = x == 160 && y == 90 ? 1.5f : x % 2 == 0 || y % 2 == 0 ? 0 : x < 160 ? 1 : 2;
    ASSERT_EQ(frame.depth_m[i], z) << x << ", " << y;
  }
}

TEST(SceneFrame, IsTheSameOfAPictureAndOfItsPoints) {
  const CameraModel large = camera(960, 540);
  DepthImage picture{960, 540, {}};
  std::vector<Vector3f> points;
  for (int y = 0; y < 540; ++y) {
    for (int x = 0; x < 960; ++x) {
      const float z = 1.0f + 3e-4f * static_cast<float>(x) + (y > 200 ? 0.5f : 0.0f);
      picture.z_m.push_back(z);
      points.emplace_back((static_cast<float>(x) - 479.5f) / 500 * z,
                          (static_cast<float>(y) - 269.5f) / 500 * z, z);
    }
  }
  const SceneFrame a = scene_frame(picture, nullptr, large),
                   b = scene_frame(points, nullptr, large);
  ASSERT_EQ(a.depth_m.size(), 320u * 180);
  for (std::size_t i = 0; i < a.depth_m.size(); ++i) ASSERT_NEAR(a.depth_m[i], b.depth_m[i], 1e-6f);
}

TEST(SceneFrame, MergesPointsWithoutMixingNearAndFar) {
  const std::vector<Vector3f> points = {{0, 0, 2}, {0, 0, 1.000f}, {0, 0, 1.004f}, {0, 0, 1.002f}};
  const SceneFrame frame = scene_frame(points, nullptr, camera(5, 3));
  for (std::size_t i = 0; i < 15; ++i) EXPECT_FLOAT_EQ(frame.depth_m[i], i == 7 ? 1.002f : 0) << i;
}

TEST(DepthPoints, TakeWhatIsFiniteAndBeforeTheCamera) {
  const Files files;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string name : {"a.ply", "a.pcd"}) {
    const std::string path = files.folder() + "/" + name;
    write_cloud(path, {{{0.1f, 0, 1}, {0, 0, -1}, {nan, 0, 1}, {0, 0, nan}, {0, 0, 30}}, {}});
    EXPECT_TRUE(is_cloud_file(path));
    const std::vector<Vector3f> points = read_depth_points(path);
    ASSERT_EQ(points.size(), 1u) << name;
    EXPECT_EQ(points[0], Vector3f(0.1f, 0, 1));
  }
  const std::string empty = files.folder() + "/e.pcd", none = files.folder() + "/n.ply";
  write_cloud(empty, {});
  expect_input_error([&] { (void)read_depth_points(empty); }, {"e.pcd", "of 0 points", "metres"});
  write_cloud(none, {{{nan, nan, nan}, {0, 0, -2}}, {}});
  expect_input_error([&] { (void)read_depth_points(none); }, {"n.ply", "of 2 points", "metres"});
}

TEST(SceneFrame, MergesBlocksWithoutMixingNearAndFar) {
  DepthImage depth{640, 4, std::vector<float>(640 * 4, 1.0f)};
  depth.z_m[0] = 3;  // one far pixel in the first block
  depth.z_m[2] = depth.z_m[3] = depth.z_m[642] = depth.z_m[643] = 0;  // no depth in the second
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

#include "platform/sim/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/input_error.hpp"
#include "small_scene.hpp"

namespace glint::sim {
namespace {

FrameBuffer exposed(const Camera& camera, const NoiseSettings& noise, float signal, float range) {
  Planes planes;
  planes.resize(camera.model.width, camera.model.height);
  planes.signal.assign(planes.signal.size(), signal);
  planes.range_m.assign(planes.range_m.size(), range);
  FrameBuffer out;
  Sensor(camera, noise, 1).expose(planes, LensRays(camera.model), 5, out);
  return out;
}

TEST(Sensor, RoundsToItsUnits) {
  const FrameBuffer frame = exposed(small_camera(), no_noise(), 1234.6f, 0.5004f);
  EXPECT_EQ(frame.reflectivity_16[0], 1235);
  EXPECT_EQ(frame.depth[0], 500);
  EXPECT_TRUE(frame.reflectivity_8.empty());
}

TEST(Sensor, ClipsEightBitsAndStillHasDepth) {
  Camera camera = small_camera();
  camera.reflectivity_bits = 8;
  const FrameBuffer frame = exposed(camera, no_noise(), 900.0f, 0.5f);
  EXPECT_EQ(frame.reflectivity_8[0], 255);
  EXPECT_EQ(frame.depth[0], 500);
  EXPECT_TRUE(frame.reflectivity_16.empty());
}

TEST(Sensor, WrapsItsRange) {
  Camera camera = small_camera();
  camera.depth.wrap_range_m = 1.055;
  EXPECT_EQ(exposed(camera, no_noise(), 500, 0.9f).depth[0], 900);
  EXPECT_EQ(exposed(camera, no_noise(), 500, 1.255f).depth[0], 200);
  EXPECT_EQ(exposed(camera, no_noise(), 500, 2.31f).depth[0], 200);
}

TEST(Sensor, HasNoDepthWhereItIsSaturatedTooWeakOrTooFar) {
  const NoiseSettings noise = no_noise();
  const Camera camera = small_camera();
  EXPECT_EQ(exposed(camera, noise, 70'000, 0.5f).depth[0], 0);
  EXPECT_EQ(exposed(camera, noise, 70'000, 0.5f).reflectivity_16[0], 65535);
  EXPECT_EQ(exposed(camera, noise, 19, 0.5f).depth[0], 0);
  EXPECT_EQ(exposed(camera, noise, 21, 0.5f).depth[0], 500);
  EXPECT_EQ(exposed(camera, noise, 500, 4.2f).depth[0], 0);
  EXPECT_EQ(exposed(camera, noise, 500, 0).depth[0], 0);
}

TEST(Sensor, GivesDepthAlongTheAxisWhereTheCameraDoes) {
  Camera camera = small_camera();
  camera.depth.kind = DepthKind::z;
  const FrameBuffer frame = exposed(camera, no_noise(), 500, 1.0f);
  const double z = unproject(camera.model, {0.5, 0.5}).value.normalized().z();
  EXPECT_NEAR(frame.depth[0], 1000 * z, 0.6);
  EXPECT_NEAR(frame.depth[80 * 160 + 80], 1000, 0.6);
}

TEST(Sensor, IsBlackWhereTheLensMapsNothing) {
  Camera camera = small_camera();
  camera.model.lens = Lens::brown;
  camera.model.field_tangent_max = 0.2;  // an image circle of 50 px radius
  NoiseSettings noise;
  const FrameBuffer frame = exposed(camera, noise, 500, 0.5f);
  EXPECT_EQ(frame.reflectivity_16[0], 0);
  EXPECT_EQ(frame.depth[0], 0);
  EXPECT_GT(frame.reflectivity_16[80 * 160 + 80], 300);
}

struct Moments {
  double mean = 0, sigma = 0;
};

template <class Values>
Moments moments(const Values& values) {
  double sum = 0, squares = 0;
  for (const auto value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const auto value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

TEST(Sensor, HasItsDeclaredNoiseInEveryPixel) {
  NoiseSettings noise = no_noise();
  noise.read_sigma = 6;
  noise.shot_counts = 0.35;
  noise.depth_floor_m = 0.003;
  noise.depth_at_100_counts_m = 0.008;
  const FrameBuffer frame = exposed(small_camera(), noise, 400, 0.8f);
  const Moments light = moments(frame.reflectivity_16), depth = moments(frame.depth);
  EXPECT_NEAR(light.mean, 400, 0.3);
  EXPECT_NEAR(light.sigma, std::sqrt(36 + 140), 0.3);
  EXPECT_NEAR(depth.mean, 800, 0.15);
  EXPECT_NEAR(depth.sigma, std::sqrt(9 + 64.0 / 4), 0.15);
}

TEST(Background, ReplacesTheRoomAndKeepsItsMissingDepth) {
  const Camera camera = small_camera();
  FrameBuffer picture;
  picture.width = picture.height = 160;
  picture.reflectivity_16.assign(160 * 160, 321);
  picture.depth.assign(160 * 160, 777);
  picture.depth[3] = 0;
  picture.depth[4] = 5000;
  Scenario scenario = dark_scene();
  scenario.tools.clear();
  scenario.background = background_from_frame(picture, camera);
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  EXPECT_EQ(frame.pixels.reflectivity_16, picture.reflectivity_16);
  EXPECT_EQ(frame.pixels.depth[2], 777);
  EXPECT_EQ(frame.pixels.depth[3], 0);
  EXPECT_EQ(frame.pixels.depth[4], 0);
}

TEST(Background, RefusesAFrameOfAnotherSizeOrWithoutDepth) {
  FrameBuffer picture;
  picture.width = 160;
  picture.height = 120;
  picture.reflectivity_16.assign(160 * 120, 1);
  picture.depth.assign(160 * 120, 1);
  EXPECT_THROW((void)background_from_frame(picture, small_camera()), InputError);
  picture.height = 160;
  picture.reflectivity_16.assign(160 * 160, 1);
  picture.depth.clear();
  EXPECT_THROW((void)background_from_frame(picture, small_camera()), InputError);
}

}  // namespace
}  // namespace glint::sim

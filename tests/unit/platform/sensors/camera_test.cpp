#include "platform/sensors/camera.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "platform/input_error.hpp"
#include "tests/unit/platform/sensors/temporary_folder.hpp"

namespace glint {
namespace {

using test::message_of;
using test::TemporaryFolder;

std::string npy(const std::string& kind, const std::string& shape,
                const std::vector<float>& values) {
  std::string header =
      "{'descr': '" + kind + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  while ((header.size() + 11) % 64 != 0) header += ' ';
  header += '\n';
  std::string out = std::string("\x93NUMPY\x01") + '\0';
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  const std::size_t at = out.size();
  out.resize(at + values.size() * sizeof(float));
  std::memcpy(out.data() + at, values.data(), values.size() * sizeof(float));
  return out;
}

// A camera of 3 x 2 pixels.
Camera small_camera() {
  Camera camera = hololens2_ahat();
  camera.model.width = 3;
  camera.model.height = 2;
  return camera;
}

std::vector<float> small_rays() {
  std::vector<float> rays;
  for (int i = 0; i < 6; ++i) {
    const Vector3 ray = Vector3(0.1 * (i % 3), 0.1 * (i / 3), 1).normalized();
    for (int k = 0; k < 3; ++k) rays.push_back(static_cast<float>(ray[k]));
  }
  return rays;
}

TEST(Cameras, HaveTheSizesAndRatesOfTheTwoHeadsets) {
  const Camera one = hololens1_short_throw(), two = hololens2_ahat();
  EXPECT_EQ(one.model.width, 448);
  EXPECT_EQ(one.model.height, 450);
  EXPECT_EQ(one.reflectivity_bits, 8);
  EXPECT_EQ(one.threshold, 250);
  EXPECT_NEAR(one.period.seconds(), 1.0 / 30, 1e-8);
  EXPECT_EQ(one.depth.wrap_range_m, 0);
  EXPECT_EQ(two.model.width, 512);
  EXPECT_EQ(two.model.height, 512);
  EXPECT_EQ(two.reflectivity_bits, 16);
  EXPECT_NEAR(two.period.seconds(), 1.0 / 45, 1e-8);
  EXPECT_EQ(two.depth.wrap_range_m, 1.055);
  EXPECT_EQ(two.depth.kind, DepthKind::radial);
  EXPECT_EQ(two.depth.invalid_from, 4090);
}

TEST(RayTableFile, IsReadInBothShapes) {
  const TemporaryFolder folder;
  for (const char* shape : {"6, 3", "2, 3, 3"}) {
    const Camera camera =
        with_ray_table(small_camera(), folder.write("a.npy", npy("<f4", shape, small_rays())));
    EXPECT_EQ(camera.model.lens, Lens::lut);
    const Vector3 ray = unproject(camera.model, {2.5, 1.5}).value;
    EXPECT_NEAR(ray.x() / ray.z(), 0.2, 1e-6);
    EXPECT_NEAR(ray.y() / ray.z(), 0.1, 1e-6);
  }
}

TEST(RayTableFile, StaysValidInACopyOfTheCamera) {
  const TemporaryFolder folder;
  Camera copy;
  {
    const Camera camera =
        with_ray_table(small_camera(), folder.write("a.npy", npy("<f4", "6, 3", small_rays())));
    copy = camera;
  }
  EXPECT_TRUE(unproject(copy.model, {1.5, 0.5}));
}

TEST(RayTableFile, IsRefusedByNameWithWhatWasExpected) {
  const TemporaryFolder folder;
  std::vector<float> long_ray = small_rays();
  const std::vector<float> short_list(15, 0.5f), no_rays(18, 0.0f);
  long_ray[2] = 2;
  const struct {
    std::string bytes, expected;
  } cases[] = {
      {"P5 1 1 255 x", "expected a .npy file"},
      {npy("<f8", "6, 3", small_rays()), "expected little-endian float32"},
      {npy("<f4", "5, 3", short_list), "expected 6 x 3"},
      {npy("<f4", "6, 3", small_rays()).substr(0, 150),
       "22 bytes of data; expected 4 for each value"},
      {npy("<f4", "6, 3", long_ray), "row 0: not a unit vector"},
      {npy("<f4", "6, 3", no_rays), "every ray is zero"},
      {npy("<f4", "6, 3", small_rays()).substr(0, 40), "longer than the file"},
  };
  for (const auto& c : cases) {
    const std::string path = folder.write("bad.npy", c.bytes);
    const std::string message =
        message_of<InputError>([&] { (void)with_ray_table(small_camera(), path); });
    EXPECT_EQ(message.rfind(path, 0), 0u) << message;
    EXPECT_NE(message.find(c.expected), std::string::npos) << message;
  }
  EXPECT_NE(message_of<InputError>([&] {
              (void)with_ray_table(small_camera(), folder.path("none.npy"));
            }).find("cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace glint

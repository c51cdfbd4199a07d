#include "platform/formats/camera.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "platform/input_error.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

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

template <class Numbers>
std::string raw(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0])};
}

// StreamRecorder's table holds unit rays only; hl2ss's calibration holds x and y at z = 1, then
// more.
TEST(RayTableFile, IsReadAsRecordersOfHeadsetsWriteIt) {
  const TemporaryFolder folder;
  const Camera camera = small_camera();
  const std::vector<float> rays = small_rays();
  const Camera unit = with_ray_table(camera, folder.write("lut.bin", raw(rays)));
  EXPECT_EQ(*unit.table, rays);
  for (const bool alias : {false, true}) {
    std::vector<float> planes(hl2ss_calibration_bytes(camera.model, alias) / sizeof(float), 9.0f);
    for (std::size_t i = 0; i < 6; ++i) {
      planes[i] = rays[3 * i] / rays[3 * i + 2];
      planes[6 + i] = rays[3 * i + 1] / rays[3 * i + 2];
    }
    planes[4] = NAN;
    planes[5] = planes[11] = 0;  // as pixel 0, whose ray is the optical axis
    const Camera read = with_ray_table(camera, folder.write("hl2ss.bin", raw(planes)));
    for (std::size_t i = 3; i < 12; ++i) EXPECT_NEAR((*read.table)[i], rays[i], 1e-6f) << i;
    for (std::size_t i = 12; i < 18; ++i) EXPECT_EQ((*read.table)[i], 0.0f) << i;
  }
}

TEST(Cameras, AreNamedAndHaveALensOrNone) {
  EXPECT_FALSE(camera_named("kinect"));
  for (const char* name : {"hololens2_ahat", "hololens1_short_throw"}) {
    EXPECT_TRUE(has_lens(*camera_named(name))) << name;
    EXPECT_GT(camera_named(name)->threshold, 0) << name;
  }
  for (const char* name :
       {"hololens2_long_throw", "azure_kinect_wfov_binned", "azure_kinect_nfov_binned",
        "azure_kinect_wfov", "azure_kinect_nfov", "magic_leap2", "generic"}) {
    EXPECT_FALSE(has_lens(*camera_named(name))) << name;
    EXPECT_EQ(camera_named(name)->threshold, 0) << name;
    EXPECT_NE(camera_names().find(name), std::string::npos);
  }
  EXPECT_EQ(camera_named("azure_kinect_nfov_binned")->depth.kind, DepthKind::z);
  EXPECT_EQ(camera_named("hololens2_long_throw")->depth.kind, DepthKind::radial);
  EXPECT_EQ(camera_named("magic_leap2")->depth.kind, DepthKind::radial);
}

// A camera without a lens gets a pinhole model as the initial guess of the search.
TEST(RayTableFile, GivesABareCameraAPinholeNearIt) {
  const Camera camera = *camera_named("azure_kinect_nfov_binned");
  std::vector<float> rays;
  for (int y = 0; y < 288; ++y) {
    for (int x = 0; x < 320; ++x) {
      const Vector3 ray = Vector3((x + 0.5 - 150) / 250, (y + 0.5 - 140) / 250, 1).normalized();
      for (int axis = 0; axis < 3; ++axis) rays.push_back(static_cast<float>(ray[axis]));
    }
  }
  const Camera with = with_rays(camera, rays, "rays");
  EXPECT_NEAR(with.model.fx, 250, 0.5);
  EXPECT_NEAR(with.model.cx, 150, 1);
  EXPECT_NEAR(with.model.cy, 140, 1);
  const Vector3 point(0.3, -0.2, 0.7);
  const Result<Vector2> pixel = project(with.model, point);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel.value.x(), 250 * 0.3 / 0.7 + 150, 1e-3);
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

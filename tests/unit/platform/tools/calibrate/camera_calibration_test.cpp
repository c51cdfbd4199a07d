#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "expect_message.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/npy.hpp"
#include "platform/tools/calibrate/board.hpp"
#include "platform/tools/calibrate/lens_fit.hpp"

namespace glint {
namespace {

class CameraCalibration : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "camera_calibration_" + std::to_string(getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
    return folder_ + "/" + name;
  }

  // Images of a chessboard with 9 x 6 inner corners, 20 mm apart, rendered with 3 x 3 rays a pixel.
  std::vector<std::string> chessboard_images(const CameraModel& camera, double tilt_rad,
                                             int views) const {
    std::vector<std::string> paths;
    for (int view = 0; view < views; ++view) {
      const double turn = 1.9 * view;
      const Pose T_camera_board{
          from_rotation_vector(tilt_rad * Vector3(std::cos(turn), std::sin(turn), 0.2)),
          {-0.08 + 0.05 * std::cos(2.0 * turn), -0.05 + 0.05 * std::sin(turn),
           0.27 + 0.005 * view}};
      std::string bytes =
          "P5\n" + std::to_string(camera.width) + " " + std::to_string(camera.height) + "\n255\n";
      for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u)
          bytes += static_cast<char>(pixel(camera, T_camera_board.inverse(), u, v));
      paths.push_back(write("view" + std::to_string(view) + ".pgm", bytes));
    }
    return paths;
  }

  static int pixel(const CameraModel& camera, const Pose& T_board_camera, int u, int v) {
    int sum = 0;
    for (int i = 0; i < 9; ++i) {
      const Vector2 at(u + (i % 3 + 0.5) / 3.0, v + (i / 3 + 0.5) / 3.0);
      const Vector3 ray = T_board_camera.rotation * unproject(camera, at).value;
      const Vector3 hit =
          T_board_camera.translation - ray * (T_board_camera.translation.z() / ray.z());
      const int column = static_cast<int>(std::floor(hit.x() / 0.02));
      const int row = static_cast<int>(std::floor(hit.y() / 0.02));
      const bool board = column >= -1 && column < 9 && row >= -1 && row < 6;
      sum += board && (column + row) % 2 == 0 ? 20 : 220;
    }
    return sum / 9;
  }

  std::string folder_;
};

CameraModel small_camera() {
  CameraModel camera;
  camera.lens = Lens::brown;
  camera.width = 320;
  camera.height = 288;
  camera.fx = 250;
  camera.fy = 252;
  camera.cx = 163.2;
  camera.cy = 141.7;
  camera.distortion = {-0.1, 0.02, 0.001, -0.0005, 0, 0, 0, 0};
  return camera;
}

TEST_F(CameraCalibration, FindsARationalLensAgainFromItsRays) {
  const CameraModel truth = hololens2_ahat().model;
  const std::string path =
      write("rays.npy", npy_float32_bytes({{512, 512, 3}, ray_table_of(truth)}));
  const LensFit fit = fit_lens_to_table(path, 0);
  EXPECT_LT(fit.rms_px, 1e-3);
  EXPECT_NEAR(fit.model.cx, truth.cx, 0.01);
  EXPECT_NEAR(fit.model.fy, truth.fy, 0.05);
}

TEST_F(CameraCalibration, FindsTheLensFromPicturesOfABoard) {
  CameraCalibrationSettings settings;
  settings.spacing_m = 0.02;
  settings.lens = Lens::brown;
  const CameraFit fit = calibrate_camera(chessboard_images(small_camera(), 0.5, 14), settings);
  EXPECT_GE(fit.images_used, 6);
  EXPECT_LT(fit.rms_px, 0.1);
  EXPECT_NEAR(fit.model.fx, 250, 1.0);
  EXPECT_NEAR(fit.model.fy, 252, 1.0);
  EXPECT_NEAR(fit.model.cx, 163.2, 0.45);  // half a pixel: mixed pixel conventions
  EXPECT_NEAR(fit.model.cy, 141.7, 0.45);
}

TEST_F(CameraCalibration, SaysThatTheBoardMayHaveAnotherSizeOrHardlyTilted) {
  CameraCalibrationSettings settings;
  settings.lens = Lens::brown;
  const std::vector<std::string> pictures = chessboard_images(small_camera(), 0.4, 5);
  settings.columns = 8;
  settings.rows = 7;
  test::expect_input_error([&] { (void)calibrate_camera(pictures, settings); },
                           {"8 x 7", "0 of 5", "count the inner corners"});
  settings.columns = 9;
  settings.rows = 6;
  const std::vector<std::string> flat = chessboard_images(small_camera(), 0.02, 6);
  test::expect_input_error([&] { (void)calibrate_camera(flat, settings); }, {"tilt the target"});
  test::expect_input_error(
      [&] { (void)calibrate_camera({write("no.png", "no picture")}, settings); },
      {"no.png", "not an image"});
}

TEST_F(CameraCalibration, RefusesTablesThatHoldNoRays) {
  std::vector<float> rays(3 * 64 * 64, 0.5f);
  test::expect_input_error(
      [&] {
        (void)fit_lens_to_table(write("long.npy", npy_float32_bytes({{64, 64, 3}, rays})), 0);
      },
      {"long.npy", "unit"});
  rays.assign(rays.size(), 0);
  test::expect_input_error(
      [&] {
        (void)fit_lens_to_table(write("zero.npy", npy_float32_bytes({{64, 64, 3}, rays})), 0);
      },
      {"zero.npy", "0 rays", "at least"});
}

TEST(CameraCalibrationData, FitsADevicesTableWithin007Px) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(data == nullptr ? "" : data) +
                           "/hololens2_ahat_lut/ahat_lut_512x512x3_float32.npy";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set GLINT_TEST_DATA";
  const LensFit fit = fit_lens_to_table(path, 0);
  std::printf("  %d rays: rms %.4f px an axis, largest %.4f px\n", fit.pixels, fit.rms_px,
              fit.error_max_px);
  EXPECT_LE(fit.rms_px, 0.07);
  EXPECT_LE(fit.error_max_px, 0.3);
}

}  // namespace
}  // namespace glint

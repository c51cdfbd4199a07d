#include "platform/tools/reference/camera_info.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;

CameraModel read(const Files& files, const std::string& text) {
  return read_camera_info(files.write("camera.yaml", text));
}

const std::string k_size = "height: 480\nwidth: 640\n";

TEST(CameraInfo, CountsPixelsFromTheirCorners) {
  const Files files;
  const CameraModel camera =
      read(files, k_size +
                      "distortion_model: plumb_bob\nd:\n- 0.0\n- 0.0\nk:\n- 500.0\n- 0.0\n"
                      "- 319.5\n- 0.0\n- 501.0\n- 239.5\n- 0.0\n- 0.0\n- 1.0\n");
  EXPECT_EQ(camera.lens, Lens::pinhole);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_DOUBLE_EQ(camera.fy, 501);
  EXPECT_DOUBLE_EQ(camera.cx, 320);
  EXPECT_DOUBLE_EQ(camera.cy, 240);
}

TEST(CameraInfo, ReadsListsInBracketsAndCalibrationFiles) {
  const Files files;
  const CameraModel camera = read(
      files,
      "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0,"
      " 320,\n    0, 500, 240, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n"
      "  data: [0.1, -0.2, 0.001, 0.002, 0.03]\n");
  EXPECT_EQ(camera.lens, Lens::brown);
  EXPECT_DOUBLE_EQ(camera.distortion[4], 0.03);
  EXPECT_DOUBLE_EQ(camera.cy, 240.5);
}

TEST(CameraInfo, NamesWhatIsMissingOrWrong) {
  const Files files;
  expect_input_error([&] { (void)read(files, "height: 480\n"); }, {"camera.yaml", "width"});
  expect_input_error([&] { (void)read(files, k_size); }, {"camera.yaml", "k"});
  expect_input_error([&] { (void)read(files, k_size + "k: [1, 2]\n"); }, {"camera.yaml:3", "9"});
  expect_input_error([&] { (void)read(files, k_size + "k: [nan,0,1,0,1,1,0,0,1]\n"); },
                     {"camera.yaml:3", "focal"});
  expect_input_error([&] { (void)read(files, "height: -1\nwidth: 640\n"); }, {"height"});
  expect_input_error(
      [&] {
        (void)read(files, k_size +
                              "k: [1,0,1,0,1,1,0,0,1]\nd: [1,1,1,1]\n"
                              "distortion_model: equidistant\n");
      },
      {"camera.yaml:4", "equidistant"});
  expect_input_error([&] { (void)read_camera_info(files.folder() + "/no.yaml"); }, {"no.yaml"});
}

TEST(CameraInfo, NamesItsFrameOnlyWhereAMessageDoes) {
  const Files files;
  const std::string k = "width: 4\nheight: 3\nk: [2, 0, 1, 0, 2, 1, 0, 0, 1]\n";
  const std::string header = "header:\n  stamp:\n    sec: 7\n  frame_id: 'tof_optical'\n";
  EXPECT_EQ(read_camera_frame(files.write("message.yaml", header + k)), "tof_optical");
  EXPECT_EQ(read_camera_frame(files.write("file.yaml", "camera_name: tof\n" + k)), "");
}

}  // namespace
}  // namespace glint

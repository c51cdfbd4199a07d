// A cell that names files of `glint calibrate`: values read, and bad files refused.
#include "platform/cells/calibration_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

const std::string k_lens =
    "rms_px = 0.1\n[camera]\nlens = \"rational\"\nwidth = 512\nheight = 512\nfx_px = 250.0\n"
    "fy_px = 251.0\ncx_px = 255.5\ncy_px = 257.0\n"
    "k1_k2_p1_p2_k3_k4_k5_k6 = [0.48, 0.19, 0.001, 0.0, 0.01, 0.8, 0.29, 0.06]\n"
    "field_tangent = 1.7\n";
const std::string k_motion =
    "[motion]\nlinear_noise_m2_s5 = 3.5\nlinear_damping_1_s = 2.0\n"
    "angular_noise_rad2_s5 = 700.0\nangular_damping_1_s = 40.0\n";
const std::string k_correction =
    "[correction]\nframe = \"camera\"\nshift_mm = [1.0, -2.0, 0.5]\nturn_deg = [0.0, 90.0, 0.0]\n"
    "range_mm = [400, 600]\noff_axis_deg = [0, 60]\ntilt_deg = [90, 120]\n";

Cell cell_with(const std::string& text, const std::map<std::string, std::string>& named) {
  CellFiles files;
  files.tools = default_cell().tools;
  files.named = named;
  return cell_from_text(text, "cell.toml", &files);
}

// Error message for a cell that names this one file.
std::string error_message(const std::string& section, const std::string& text) {
  try {
    std::map<std::string, std::string> named{
        {"camera.depth_bias", text}, {"motion.file", text}, {"correction.file", text}};
    // A carried lens applies even if the cell does not name it: the source may supply it.
    if (section.find("[camera]\nfile") == 0) named["camera.file"] = text;
    (void)cell_with(section + "\n", named);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string without(std::string text, const std::string& line) {
  const std::size_t at = text.find(line);
  return text.erase(at, text.find('\n', at) + 1 - at);
}

TEST(CalibrationFiles, GiveACellItsLens) {
  const Cell cell = cell_with("[camera]\nfile = \"camera.toml\"\n", {{"camera.file", k_lens}});
  const CameraModel& lens = cell.camera.model;
  EXPECT_EQ(lens.lens, Lens::rational);
  EXPECT_EQ(lens.fx, 250.0);
  EXPECT_EQ(lens.cy, 257.0);
  EXPECT_EQ(lens.distortion[7], 0.06);
  EXPECT_EQ(lens.field_tangent_max, 1.7);
  ASSERT_EQ(cell.named_files.size(), 1u);
  EXPECT_EQ(cell.named_files[0].key, "camera.file");
  EXPECT_EQ(cell.named_files[0].text, k_lens);
}

TEST(CalibrationFiles, GiveACellItsDepthBias) {
  const Cell cell = cell_with(
      "[camera]\ndepth_bias = \"depth.toml\"\n",
      {{"camera.depth_bias",
        "[depth_bias]\noffset_mm = 3\nmm_per_m = -10\ndim_mm = 0.5\nrange_mm = [250, 900]\n"}});
  EXPECT_DOUBLE_EQ(cell.camera.depth.bias.offset_m, 0.003);
  EXPECT_DOUBLE_EQ(cell.camera.depth.bias.per_metre, -0.01);
  EXPECT_DOUBLE_EQ(cell.camera.depth.bias.range_max_m, 0.9);
}

TEST(CalibrationFiles, GiveACellTheUncertaintyOfItsRanges) {
  const std::string bias = "[depth_bias]\noffset_mm = 3\nrange_mm = [250, 900]\n";
  const auto uncertainty_by = [](const std::string& text) {
    return cell_with("[camera]\ndepth_bias = \"depth.toml\"\n", {{"camera.depth_bias", text}})
        .camera.uncertainty;
  };
  const CameraUncertainty measured =
      uncertainty_by("offset_sigma_mm = 0.4\nmm_per_m_sigma = 2.0\n" + bias);
  // Adds the focal length error of another unit's lens, 0.3 %, and the periodic range error.
  EXPECT_NEAR(measured.range_offset_m, std::hypot(0.0004, 0.0015, 0.0007), 1e-12);
  EXPECT_NEAR(measured.range_scale, std::hypot(0.002, 0.003), 1e-12);
  EXPECT_THROW((void)uncertainty_by("offset_sigma_mm = -1\nmm_per_m_sigma = 2\n" + bias),
               InputError);
  EXPECT_THROW((void)uncertainty_by("offset_sigma_mm = 1\n" + bias), InputError);
  const CameraUncertainty unstated = uncertainty_by(bias);
  EXPECT_EQ(unstated.range_offset_m, CameraUncertainty{}.range_offset_m);
}

TEST(CalibrationFiles, GiveACellTheUncertaintyOfItsLens) {
  const auto uncertainty_by = [](const std::string& text) {
    return cell_with("[camera]\nfile = \"camera.toml\"\n", {{"camera.file", text}})
        .camera.uncertainty;
  };
  const CameraUncertainty own = uncertainty_by(k_lens);
  EXPECT_EQ(own.principal_point_px, 0.5);
  EXPECT_EQ(own.focal_scale, 0.001);
  const CameraUncertainty stated =
      uncertainty_by("principal_point_sigma_px = 0.8\nfocal_sigma = 0.002\n" + k_lens);
  EXPECT_EQ(stated.principal_point_px, 0.8);
  EXPECT_EQ(stated.focal_scale, 0.002);
  EXPECT_THROW((void)uncertainty_by("principal_point_sigma_px = 0.8\n" + k_lens), InputError);
  EXPECT_THROW((void)uncertainty_by("principal_point_sigma_px = 1\nfocal_sigma = -1\n" + k_lens),
               InputError);
}

TEST(CalibrationFiles, GiveACellItsMarkersCorrelatedErrors) {
  const Cell cell = cell_with("[camera]\nuncertainty = \"noise.toml\"\n",
                              {{"camera.uncertainty",
                                "poses = 900\n[uncertainty]\nslow_range_mm = 0.2\n"
                                "slow_centroid_px = 0.01\nfast_share = 0.7\nfast_s = 0.4\n"
                                "slow_s = 30\n"}});
  EXPECT_DOUBLE_EQ(cell.camera.uncertainty.correlated_range_m, 0.0002);
  EXPECT_DOUBLE_EQ(cell.camera.uncertainty.fast_share, 0.7);
  EXPECT_DOUBLE_EQ(cell.camera.correlation.slow_s, 30);
  EXPECT_EQ(cell.camera.uncertainty.range_offset_m, CameraUncertainty{}.range_offset_m);
  EXPECT_THROW((void)cell_with("[camera]\nuncertainty = \"noise.toml\"\n",
                               {{"camera.uncertainty", "poses = 900\n"}}),
               InputError);
}

TEST(CalibrationFiles, GiveACellItsMotion) {
  const Cell cell = cell_with("[motion]\nfile = \"motion.toml\"\n", {{"motion.file", k_motion}});
  EXPECT_EQ(cell.motion.linear_noise_m2_s5, 3.5);
  EXPECT_EQ(cell.motion.linear_damping_1_s, 2.0);
  EXPECT_EQ(cell.motion.angular_noise_rad2_s5, 700.0);
  EXPECT_EQ(cell.motion.angular_damping_1_s, 40.0);
  EXPECT_EQ(cell.motion.start_speed_m_s, MotionSettings{}.start_speed_m_s);
}

TEST(CalibrationFiles, GiveACellItsCorrection) {
  const Cell cell =
      cell_with("[correction]\nfile = \"bias.toml\"\n", {{"correction.file", k_correction}});
  EXPECT_EQ(cell.correction.frame, CorrectionFrame::camera);
  EXPECT_DOUBLE_EQ(cell.correction.translation_m.y(), -0.002);
  EXPECT_NEAR(cell.correction.rotation_rad.y(), 1.5707963267948966, 1e-15);
  EXPECT_DOUBLE_EQ(cell.correction.range_m.from, 0.4);
  EXPECT_NEAR(cell.correction.off_axis_cosine.from, 0.5, 1e-15);
  EXPECT_EQ(cell.correction.off_axis_cosine.to, 1.0);
  EXPECT_NEAR(cell.correction.tilt_cosine.from, -0.5, 1e-15);
  EXPECT_NEAR(cell.correction.tilt_cosine.to, 0, 1e-15);
}

TEST(CalibrationFiles, AreNotNeeded) {
  const Cell cell = default_cell();
  EXPECT_TRUE(cell.named_files.empty());
  EXPECT_EQ(cell.correction.frame, CorrectionFrame::none);
  EXPECT_EQ(cell.motion.linear_noise_m2_s5, MotionSettings{}.linear_noise_m2_s5);
}

TEST(CalibrationFiles, AreRefusedWithTheirPlace) {
  const std::string camera = "[camera]\nfile = \"camera.toml\"";
  EXPECT_EQ(error_message(camera, without(k_lens, "fx_px")),
            "camera.toml:2: camera.fx_px is missing; expected a number");
  EXPECT_EQ(error_message(camera, k_lens + "skew = 1\n").substr(0, 44),
            "camera.toml:12: unknown key camera.skew; exp");
  EXPECT_EQ(error_message(camera, "lens = 1\n"),
            "camera.toml:1: no table [camera]; expected a file of `glint calibrate camera`");
  std::string small = k_lens;
  small.replace(small.find("width = 512"), 11, "width = 448");
  EXPECT_EQ(error_message(camera, small),
            "camera.toml:4: camera has 448 x 512 pixels; expected 512 x 512, the size of the "
            "cell's camera.model");
  std::string nan = k_motion;
  nan.replace(nan.find("3.5"), 3, "nan");
  EXPECT_NE(error_message("[motion]\nfile = \"motion.toml\"", nan)
                .find("motion.toml:2: motion.linear_noise_m2_s5 is nan; expected a number"),
            std::string::npos);
  EXPECT_EQ(error_message("[motion]\nfile = \"motion.toml\"", without(k_motion, "angular_damping")),
            "motion.toml:1: motion.angular_damping_1_s is missing; expected a number");
  std::string turned = k_correction;
  turned.replace(turned.find("[90, 120]"), 9, "[120, 90]");
  EXPECT_EQ(
      error_message("[correction]\nfile = \"bias.toml\"", turned),
      "bias.toml:7: correction.tilt_deg is not a range; expected [from, to] within 0 and 180");
  EXPECT_EQ(
      error_message("[camera]\ndepth_bias = \"depth.toml\"", "[depth_bias]\noffset_mm = 1\n"),
      "depth.toml:1: depth_bias.range_mm is missing; expected [from, to], the measured ranges");
  EXPECT_NE(error_message("[camera]\nfile = \"c.toml\"\nray_table = \"r.npy\"", k_lens)
                .find("cell.toml:2: camera.file and camera.ray_table are both set"),
            std::string::npos);
}

TEST(CalibrationFiles, AreMissedWhereARecordingHasNone) {
  try {
    (void)cell_with("[motion]\nfile = \"motion.toml\"\n", {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no attachment motion.file.toml"), std::string::npos);
  }
}

}  // namespace
}  // namespace glint

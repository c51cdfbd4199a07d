// Sections [camera], [source] and [simulator] of a cell: presets, changed keys, lenses from other
// files.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "kernels/angles.hpp"
#include "kernels/pose/camera_model.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

constexpr const char* k_generic =
    "[camera]\nmodel = \"generic\"\nwidth = 4\nheight = 2\nthreshold = 100\n";
constexpr const char* k_lens_file =
    "[camera]\nlens = \"brown\"\nwidth = 4\nheight = 2\nfx_px = 3\nfy_px = 3\ncx_px = 2\n"
    "cy_px = 1\nk1_k2_p1_p2_k3_k4_k5_k6 = [0, 0, 0, 0, 0, 0, 0, 0]\nfield_tangent = 2\n";

Cell generic_cell() { return cell_from_text(k_generic, "cell.toml"); }

std::vector<float> eight_rays() {
  std::vector<float> rays;
  for (int i = 0; i < 8; ++i) {
    const Vector3 ray = Vector3(0.3 * (i % 4 - 1.5), 0.3 * (i / 4 - 0.5), 1).normalized();
    for (int axis = 0; axis < 3; ++axis) rays.push_back(static_cast<float>(ray[axis]));
  }
  return rays;
}

std::string refusal(const auto& call) {
  try {
    call();
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(CellCamera, LeavesThePresetsBitsWhereNothingIsStated) {
  const Cell cell = cell_from_text("[camera]\ndepth_unit_mm = 1\nperiod_ms = 22.222222\n", "c");
  const Camera preset = hololens2_ahat();
  EXPECT_EQ(cell.camera.depth.wrap_range_m, preset.depth.wrap_range_m);
  EXPECT_EQ(cell.camera.depth.unit_m, preset.depth.unit_m);
  EXPECT_EQ(cell.camera.range_sigma_m, preset.range_sigma_m);
  EXPECT_TRUE(cell.camera.estimate_noise);
  EXPECT_EQ(cell.camera.period, preset.period);
}

TEST(CellCamera, StatesTheUncertaintyOfItsCalibration) {
  const CameraUncertainty shipped = cell_from_text("[camera]\n", "c").camera.uncertainty;
  EXPECT_EQ(shipped.principal_point_px, CameraUncertainty{}.principal_point_px);
  const Cell camera_cell = cell_from_text(
      "[camera.uncertainty]\nrange_offset_mm = 1\nrange_scale = 0.002\n"
      "principal_point_px = 0.4\nfocal_scale = 0.0005\nslow_range_mm = 0.3\n"
      "slow_centroid_px = 0.02\nstamp_ms = 1\nfast_share = 0.3\nfast_s = 0.2\nslow_s = 9\n",
      "c");
  const CameraUncertainty& stated = camera_cell.camera.uncertainty;
  EXPECT_EQ(stated.fast_share, 0.3);
  EXPECT_EQ(camera_cell.camera.correlation.fast_s, 0.2);
  EXPECT_EQ(camera_cell.camera.correlation.slow_s, 9);
  EXPECT_DOUBLE_EQ(stated.range_offset_m, 0.001);
  EXPECT_DOUBLE_EQ(stated.range_scale, 0.002);
  EXPECT_DOUBLE_EQ(stated.principal_point_px, 0.4);
  EXPECT_DOUBLE_EQ(stated.focal_scale, 0.0005);
  EXPECT_DOUBLE_EQ(stated.correlated_range_m, 0.0003);
  EXPECT_DOUBLE_EQ(stated.correlated_centroid_px, 0.02);
  EXPECT_DOUBLE_EQ(stated.time_stamp_s, 0.001);
  EXPECT_THROW((void)cell_from_text("[camera.uncertainty]\nrange_scale = -1\n", "c"), InputError);
  EXPECT_THROW((void)cell_from_text("[camera.uncertainty]\nfocal = 0.1\n", "c"), InputError);
}

std::vector<float> rays_ahead() {
  std::vector<float> rays;
  for (int pixel = 0; pixel < 512 * 512; ++pixel) {
    const double x = 0.002 * (pixel % 512 - 256), y = 0.002 * (pixel / 512 - 256);
    const Vector3 ray = Vector3(x, y, 1).normalized();
    for (int axis = 0; axis < 3; ++axis) rays.push_back(static_cast<float>(ray[axis]));
  }
  return rays;
}

TEST(CellCamera, IsMoreCertainOfADevicesOwnLens) {
  const auto with_lens_of_its_own = [](const std::string& text) {
    Cell cell = cell_from_text(text, "c");
    set_lens(cell, {"lens", rays_ahead(), ""});
    return cell.camera.uncertainty;
  };
  const CameraUncertainty own = with_lens_of_its_own("[camera]\n");
  EXPECT_DOUBLE_EQ(own.principal_point_px, 0.5);
  EXPECT_DOUBLE_EQ(own.focal_scale, 0.001);
  EXPECT_EQ(own.range_offset_m, CameraUncertainty{}.range_offset_m);
  const CameraUncertainty stated =
      with_lens_of_its_own("[camera.uncertainty]\nprincipal_point_px = 2\n");
  EXPECT_DOUBLE_EQ(stated.principal_point_px, 2) << "what the cell states holds";
}

TEST(CellRobot, StatesTheUncertaintyOfItsPlace) {
  const Cell cell =
      cell_from_text("[robot]\nposition_sigma_mm = 1.5\nrotation_sigma_deg = 0.1\n", "c");
  EXPECT_DOUBLE_EQ(cell.robot_sigma_m, 0.0015);
  EXPECT_DOUBLE_EQ(cell.robot_sigma_rad, 0.1 * k_radians_per_degree);
  EXPECT_GT(cell_from_text("[robot]\n", "c").robot_sigma_m, 0.002) << "wide where none is stated";
}

TEST(CellSimulator, TakesTheMarkersNoise) {
  const SimulatorSettings none = cell_from_text("[simulator]\nseed = 2\n", "c").simulator;
  EXPECT_FALSE(none.marker_range_sigma_m || none.marker_pixel_sigma_px);
  const SimulatorSettings sim =
      cell_from_text("[simulator]\nmarker_range_sigma_mm = 3\nmarker_pixel_sigma_px = 0.2\n", "c")
          .simulator;
  EXPECT_DOUBLE_EQ(sim.marker_range_sigma_m.value_or(0), 0.003);
  EXPECT_DOUBLE_EQ(sim.marker_pixel_sigma_px.value_or(0), 0.2);
}

TEST(CellCamera, TakesWhatDiffersFromThePreset) {
  const Cell cell = cell_from_text(
      std::string(k_generic) +
          "depth = \"radial\"\ndepth_unit_mm = 0.25\ndepth_invalid_from = 60000\n"
          "depth_wraps_mm = 7500\nreflectivity_bits = 8\nperiod_ms = 10\nexposure_ms = 3\n"
          "transport_ms = 4\nrange_mm = [200, 3000]\nrange_sigma_mm = 3\n"
          "pixel_sigma_px = 0.25\nestimate_noise = false\n",
      "cell.toml");
  const Camera& camera = cell.camera;
  EXPECT_EQ(camera.model.width, 4);
  EXPECT_EQ(camera.model.height, 2);
  EXPECT_EQ(camera.threshold, 100);
  EXPECT_EQ(camera.depth.kind, DepthKind::radial);
  EXPECT_DOUBLE_EQ(camera.depth.unit_m, 0.00025);
  EXPECT_EQ(camera.depth.invalid_from, 60000);
  EXPECT_DOUBLE_EQ(camera.depth.wrap_range_m, 7.5);
  EXPECT_EQ(camera.reflectivity_bits, 8);
  EXPECT_EQ(camera.period, milliseconds(10));
  EXPECT_EQ(camera.exposure, milliseconds(3));
  EXPECT_EQ(camera.transport, milliseconds(4));
  EXPECT_DOUBLE_EQ(camera.range_min_m, 0.2);
  EXPECT_DOUBLE_EQ(camera.range_max_m, 3);
  EXPECT_DOUBLE_EQ(camera.range_sigma_m, 0.003);
  EXPECT_DOUBLE_EQ(camera.pixel_sigma_px, 0.25);
  EXPECT_FALSE(camera.estimate_noise);
  EXPECT_EQ(generic_cell().camera.depth.kind, DepthKind::z);
}

TEST(CellCamera, RefusesWhatNoCameraHas) {
  for (const auto& [text, part] :
       {std::pair{"[camera]\nmodel = \"ahat2\"\n",
                  "cell.toml:2: camera.model: \"ahat2\"; expected"},
        std::pair{"[camera]\nmodel = \"generic\"\nthreshold = 9\n", "width and height are missing"},
        std::pair{"[camera]\nmodel = \"hololens2_long_throw\"\n", "camera.threshold: missing"},
        std::pair{"[camera]\nreflectivity_bits = 12\n", "expected 8 or 16"},
        std::pair{"[camera]\nreflectivity_bits = 8\n", "threshold"},
        std::pair{"[camera]\ndepth = \"planar\"\n", "radial"},
        std::pair{"[camera]\nrange_mm = [900, 200]\n", "not a range"},
        std::pair{"[camera]\nwidth = 1025\n", "1024"},
        std::pair{"[camera]\nperiod_ms = 0\n", "period_ms"}}) {
    EXPECT_NE(error_message_for(text).find(part), std::string::npos)
        << text << error_message_for(text);
  }
}

TEST(CellCamera, NeedsALensFromSomewhere) {
  Cell cell = generic_cell();
  EXPECT_FALSE(names_lens(cell));
  EXPECT_NE(refusal([&] { require_lens(cell); }).find("generic has no lens"), std::string::npos);
  set_lens(cell, {"bag:/info", {}, k_lens_file});
  EXPECT_TRUE(names_lens(cell));
  EXPECT_EQ(cell.camera.model.fx, 3);
  EXPECT_EQ(refusal([&] { require_lens(cell); }), "accepted");
  Cell table = generic_cell();
  set_lens(table, {"lut.bin", eight_rays(), {}});
  EXPECT_TRUE(names_lens(table));
  EXPECT_TRUE(unproject(table.camera.model, {1.5, 0.5}));
  EXPECT_EQ(refusal([&] { require_lens(default_cell()); }), "accepted");
  Cell other = default_cell();
  EXPECT_NE(refusal([&] {
              set_lens(other, {"lut.bin", eight_rays(), {}});
            }).find("24 numbers"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              set_lens(other, {"bag", {}, k_lens_file});
            }).find("4 x 2 pixels"),
            std::string::npos);
}

// The cell's text names no lens; the recording stores the lens of the source.
TEST(CellCamera, ComesBackFromARecordingWithTheSourcesLens) {
  CellFiles carried;
  carried.named["camera.file"] = k_lens_file;
  EXPECT_EQ(cell_from_text(k_generic, "run.mcap", &carried).camera.model.fx, 3);
  CellFiles rays;
  rays.rays = std::make_shared<const std::vector<float>>(eight_rays());
  EXPECT_EQ(cell_from_text(k_generic, "run.mcap", &rays).camera.model.lens, Lens::lut);
}

TEST(CellSource, ReadsItsKeysAndRefusesThoseOfAnotherKind) {
  const Cell cell = cell_from_text(
      "[source]\nkind = \"rosbag\"\npath = \"bag\"\nreflectivity_topic = \"/ir\"\n"
      "depth_topic = \"/d\"\ncamera_info_topic = \"/i\"\npose_topic = \"/p\"\n"
      "world_frame = \"map\"\n",
      "dir/cell.toml");
  EXPECT_EQ(cell.source.path, "dir/bag");
  EXPECT_EQ(cell.source.reflectivity_topic, "/ir");
  EXPECT_EQ(cell.source.depth_topic, "/d");
  EXPECT_EQ(cell.source.camera_info_topic, "/i");
  EXPECT_EQ(cell.source.pose_topic, "/p");
  EXPECT_EQ(cell.source.world_frame, "map");
  const std::string why = error_message_for("[source]\nkind = \"folder\"\npose_topic = \"/p\"\n");
  EXPECT_NE(why.find("cell.toml:3: source.pose_topic: only for kind dds or rosbag"),
            std::string::npos)
      << why;
  EXPECT_NE(error_message_for("[source]\nkind = \"rosbag\"\ncalibration = \"c\"\n")
                .find("source.calibration"),
            std::string::npos);
}

}  // namespace
}  // namespace glint

#include "platform/tools/calibrate/depth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "depth_scene.hpp"
#include "expect_message.hpp"

namespace glint {
namespace {

using test::DepthScene;

DepthCalibration found_in(const DepthScene& scene, const DepthCalibrationSettings& settings = {}) {
  const Tool tool = test::scene_tool();
  const ObservationSeries seen = find_tool(test::blobs_of(scene), tool, {});
  return calibrate_depth(seen.observations, tool, settings, "scene.mcap");
}

Vector3 values_of(const DepthBias& bias) {
  return {bias.offset_m, bias.per_metre, bias.low_signal_m};
}

TEST(Depth, NamesTheMarkersAmongStraysThoughTheirRangesAreTooLong) {
  const DepthScene scene{.frames = 100, .strays = 4};
  const ObservationSeries seen = find_tool(test::blobs_of(scene), test::scene_tool(), {});
  EXPECT_EQ(seen.frames, 100);
  EXPECT_GE(seen.observations.size(), 90u);
  int wrong = 0;
  for (const ToolObservation& observation : seen.observations) {
    for (const ObservedMarker& marker : observation.markers) {
      // The scene adds the markers in the tool's order, so a blob's index is its marker's.
      const auto f = static_cast<std::size_t>(observation.pose.time.nanoseconds / 22'000'000);
      const BlobFrame frame = test::blobs_of(scene).frames[f];
      const auto m = static_cast<std::size_t>(marker.marker);
      wrong +=
          m >= frame.blobs.size() || frame.blobs[m].surface_range_m != marker.blob.surface_range_m
              ? 1
              : 0;
    }
  }
  EXPECT_LE(wrong, 5);
}

TEST(Depth, FindsTheBiasWithoutNoise) {
  const DepthScene scene{.pixel_sigma_px = 1e-6, .range_sigma_m = 1e-8, .frames = 120};
  const DepthCalibration found = found_in(scene);
  EXPECT_NEAR(found.bias.offset_m, scene.bias.offset_m, 1e-6);
  EXPECT_NEAR(found.bias.per_metre, scene.bias.per_metre, 1e-5);
  EXPECT_NEAR(found.bias.low_signal_m, scene.bias.low_signal_m, 1e-5);
}

TEST(Depth, FindsTheBiasAndTheNoiseAndWhatItTakesOff) {
  const DepthScene scene{.frames = 400};
  const DepthCalibration found = found_in(scene);
  const Vector3 off = values_of(found.bias) - values_of(scene.bias);
  EXPECT_LT(off.dot(found.covariance.llt().solve(off)), 16.3);  // chi-square, 3 dof, level 1e-3
  EXPECT_LT(std::sqrt(found.covariance(0, 0)), 0.0005);
  EXPECT_NEAR(found.range_sigma_m, scene.range_sigma_m, 0.15 * scene.range_sigma_m);
  EXPECT_NEAR(found.pixel_sigma_px, scene.pixel_sigma_px, 0.15 * scene.pixel_sigma_px);
  EXPECT_GT(found.rms_before_m, 1.5 * found.rms_after_m);
  EXPECT_NEAR(found.bias.range_min_m, 0.325, 0.05);
  EXPECT_NEAR(found.bias.range_max_m, 0.775, 0.05);
  EXPECT_LT(found.outliers, found.markers / 50);
}

// The mean NEES of 40 runs, 3 parameters each, is 1 +- 0.4 (3.1 standard deviations).
TEST(Depth, KnowsHowSureItIs) {
  double sum = 0;
  constexpr int k_runs = 40;
  for (int run = 0; run < k_runs; ++run) {
    const DepthScene scene{.frames = 150, .seed = static_cast<std::uint64_t>(run + 10)};
    const DepthCalibration found = found_in(scene);
    const Vector3 off = values_of(found.bias) - values_of(scene.bias);
    sum += off.dot(found.covariance.llt().solve(off)) / (3 * k_runs);
  }
  std::printf("depth: NEES/3 %.2f\n", sum);
  EXPECT_NEAR(sum, 1, 0.4);
}

// Marker position errors of 0.3 mm an axis limit the tool's size, the scale reference: its variance
// is that of one axis over the sum of squared distances to the centre.
TEST(Depth, CountsWhatTheToolsPlacesLeaveOfItsSize) {
  const DepthScene scene{.frames = 150};
  Tool drawn = test::scene_tool();
  const ObservationSeries seen = find_tool(test::blobs_of(scene), drawn, {});
  const Matrix3 exact = calibrate_depth(seen.observations, drawn, {}, "scene.mcap").covariance;
  drawn.marker_sigma_m = 0.0003;
  const Matrix3 more =
      calibrate_depth(seen.observations, drawn, {}, "scene.mcap").covariance - exact;
  double spread_m2 = 0;
  for (int i = 0; i < drawn.marker_count; ++i)
    spread_m2 += (drawn.markers_m[static_cast<std::size_t>(i)] - drawn.middle_m()).squaredNorm();
  const double size2 = 0.0003 * 0.0003 / spread_m2;
  EXPECT_NEAR(more(1, 1), size2, 1e-3 * size2);
  EXPECT_NEAR(more(0, 1), 0.5 * size2, 1e-3 * size2);
  EXPECT_NEAR(more(0, 0), 0.25 * size2, 1e-3 * size2);
  EXPECT_NEAR(more(2, 2), 0, 1e-3 * size2);
}

TEST(Depth, LeavesOutRangesThatFitNothing) {
  const DepthScene scene{.frames = 300};
  ObservationSeries seen = find_tool(test::blobs_of(scene), test::scene_tool(), {});
  for (std::size_t i = 0; i < seen.observations.size(); i += 3)
    seen.observations[i].markers[1].blob.surface_range_m += 0.05;
  const DepthCalibration found =
      calibrate_depth(seen.observations, test::scene_tool(), {}, "wild.mcap");
  EXPECT_GE(found.outliers, 95);
  EXPECT_LE(found.outliers, 130);
  const Vector3 off = values_of(found.bias) - values_of(scene.bias);
  EXPECT_LT(off.dot(found.covariance.llt().solve(off)), 16.3);
}

TEST(Depth, SaysWhichPartTheRunLeavesOpen) {
  const DepthScene near{.near_m = 0.49, .far_m = 0.5};
  test::expect_input_error(
      [&] { (void)found_in(near); },
      {"scene.mcap", "mm_per_m is not observable", "towards the camera and away"});
  const DepthScene even{.dim_part = 0.9, .peak_exponent = 0};
  test::expect_input_error([&] { (void)found_in(even); },
                           {"dim_mm is not observable", "--no-brightness"});
  DepthCalibrationSettings by_range;  // without this term the offset includes the dimness bias
  by_range.brightness = Brightness::left_out;
  EXPECT_EQ(found_in(even, by_range).bias.low_signal_m, 0);
  const DepthScene few{.frames = 20};
  test::expect_input_error([&] { (void)found_in(few); }, {"in 20 frames", "at least 50"});
}

// If brightness depends on range alone, the slope and the dimness term are not separable.
TEST(Depth, SaysWhenBrightnessFollowsRange) {
  const DepthScene tied{
      .peak = 3000, .dim_part = 0.999, .peak_exponent = 1, .range_sigma_m = 0.004, .frames = 60};
  test::expect_input_error(
      [&] { (void)found_in(tied); },
      {"dim_mm is not observable", "brightness follows range", "dim markers near"});
}

TEST(Depth, RefusesAnotherTool) {
  ObservationSeries seen = find_tool(test::blobs_of({}), test::scene_tool(), {});
  Tool larger = test::scene_tool();
  for (int m = 0; m < larger.marker_count; m += 2)
    larger.markers_m[static_cast<std::size_t>(m)] *= 1.2;
  test::expect_input_error(
      [&] { (void)calibrate_depth(seen.observations, larger, {}, "other.mcap"); },
      {"other.mcap", "do not fit", "tool file"});
}

TEST(BlobTable, IsReadAndRefusedWithItsLine) {
  const Camera camera = hololens2_ahat();
  const BlobSeries series = blobs_from_text(
      "time_s,x_px,y_px,range_m,peak\n0,256,256,0.5,3000\n0,300,200,0.6,2000\n0.02,256,256,0.5,9\n",
      "blobs.csv", camera);
  ASSERT_EQ(series.frames.size(), 2u);
  ASSERT_EQ(series.frames[0].blobs.size(), 2u);
  EXPECT_EQ(series.frames[0].blobs[1].peak, 2000);
  EXPECT_EQ(series.frames[0].blobs[1].surface_range_m, 0.6);
  EXPECT_LT(
      (project(camera.model, series.frames[0].blobs[1].rays.ray).value - Vector2(300, 200)).norm(),
      1e-6);
  const auto refused = [&](const char* text, std::initializer_list<const char*> words) {
    test::expect_input_error([&] { (void)blobs_from_text(text, "blobs.csv", camera); }, words);
  };
  refused("0,256,256,nan,3000\n", {"blobs.csv:1: range_m is \"nan\""});
  refused("0,256,256,0.5,0\n", {"blobs.csv:1: peak is \"0\""});
  refused("0,256,256,0.5\n", {"blobs.csv:1", "five columns"});
  refused("1,256,256,0.5,9\n0,256,256,0.5,9\n", {"blobs.csv:2: time_s decreases"});
  refused("0,-900,256,0.5,9\n", {"blobs.csv:1: the lens", "no ray"});
  refused("\n", {"holds no blob"});
}

}  // namespace
}  // namespace glint

#include "platform/tools/calibrate/tool_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "expect_message.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

const std::vector<Vector3> k_four{
    {0, 0, 0}, {0, 0.0286, 0.041}, {0, 0, 0.088}, {0, -0.0443, 0.0405}};
// Nearly mirror symmetric: two rows of three, half a millimetre from symmetry.
const std::vector<Vector3> k_grid{{0.002, -0.0158, 0.086},   {0.002, 0.0159, 0.0864},
                                  {0.002, 0.0160, 0.1309},   {0.0021, 0.0161, 0.1759},
                                  {0.0017, -0.0156, 0.1754}, {0.0018, -0.0156, 0.1305}};

struct Recording {
  std::vector<Vector3> markers = k_four;
  int frames = 300;
  double noise_m = 0.0003;
  double missing = 0.2;   // fraction of all points
  double strays = 0.1;    // fraction of frames with one false point
  double turn_rad = 0.5;  // amplitude about each axis
  int jump_at = -1;       // frame at which the tool's pose jumps; -1: none
  double slow_m = 0;      // amplitude of each marker's correlated error, period pi s
};

std::vector<PointFrame> recorded(const Recording& how) {
  const sim::RandomKey key{7, sim::Stream::hand, 1};
  std::vector<PointFrame> frames;
  std::uint64_t draw = 0;
  for (int f = 0; f < how.frames; ++f) {
    const double t = 0.02 * f;
    Pose pose{from_rotation_vector(how.turn_rad * Vector3(std::sin(1.1 * t), std::cos(0.7 * t),
                                                          std::sin(1.7 * t + 1))),
              {0.1 * std::sin(t), 0.05 * std::cos(1.3 * t), 0.6}};
    if (how.jump_at >= 0 && f >= how.jump_at) {
      pose = Pose{from_rotation_vector({0, 0, 3.0}), {0.4, 0.1, 0.2}} * pose;
    }
    PointFrame frame{Time{static_cast<std::int64_t>(1e9 * t)}, {}};
    double phase = 0;
    for (const Vector3& made : how.markers) {
      phase += 1;
      const Vector3 marker = made + how.slow_m * std::sin(2 * t + phase) * Vector3(0.5, 0.7, 0.5);
      const bool seen = sim::uniform(key, ++draw) >= how.missing;
      const Vector3 noise = how.noise_m * sim::gaussian_vector(key, 100'000 + draw);
      if (seen) frame.points_m.push_back(pose * marker + noise);
    }
    if (sim::uniform(key, ++draw) < how.strays) {
      frame.points_m.push_back(Vector3(0, 0, 0.6) +
                               0.1 * sim::gaussian_vector(key, 200'000 + draw));
    }
    // The order of the points carries no information.
    std::rotate(
        frame.points_m.begin(),
        frame.points_m.begin() + f % std::max<int>(1, static_cast<int>(frame.points_m.size())),
        frame.points_m.end());
    if (!frame.points_m.empty()) frames.push_back(frame);
  }
  return frames;
}

// The smallest rms error over all permutations of the found markers.
double error_of(const std::vector<Vector3>& found, const std::vector<Vector3>& truth) {
  if (found.size() != truth.size()) return 1;
  std::vector<std::size_t> order(found.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  double least = 1;
  do {
    std::vector<Vector3> ordered;
    for (const std::size_t i : order) ordered.push_back(found[i]);
    least = std::min(least, fit_rigid(truth, ordered).rms_m);
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(ToolGeometry, FindsTheMarkersDespiteFlickerAndStrays) {
  const ToolGeometry found = calibrate_tool(recorded({}), {}, "flicker.csv");
  EXPECT_LT(error_of(found.markers_m, k_four), 0.00006);
  EXPECT_NEAR(found.noise_m, 0.0003, 0.00002);
  for (const int count : found.frame_counts) EXPECT_NEAR(count, 240 * 0.8, 60);
}

TEST(ToolGeometry, KnowsHowSureItIs) {
  const ToolGeometry found = calibrate_tool(recorded({}), {}, "flicker.csv");
  for (const double sigma : found.marker_sigma_m) {
    EXPECT_GT(sigma, 0.0003 / std::sqrt(300.0) * 0.5);
    EXPECT_LT(sigma, 0.0003 / std::sqrt(240.0) * 3);
  }
}

// Correlated errors reduce the effective number of frames.
TEST(ToolGeometry, IsLessSureOfSlowErrors) {
  const ToolGeometry quick = calibrate_tool(recorded({}), {}, "quick.csv");
  Recording how;
  how.slow_m = 0.001;
  const ToolGeometry slow = calibrate_tool(recorded(how), {}, "slow.csv");
  for (std::size_t i = 0; i < k_four.size(); ++i) {
    EXPECT_GT(slow.marker_sigma_m[i], 2.5 * quick.marker_sigma_m[i]) << i;
    EXPECT_LT(slow.marker_sigma_m[i], 0.0003) << i;
  }
}

// A mean keeps all of an error with a long correlation time, and little of one with a short time.
TEST(ToolGeometry, CountsWhatSlowErrorsOfTheRangesLeave) {
  const std::vector<PointFrame> frames{{Time{}, {}}, {Time{40'000'000'000}, {}}};
  Camera camera;
  camera.uncertainty.correlated_range_m = 0.001;
  camera.uncertainty.fast_share = 0;
  camera.correlation.slow_s = 1e5;
  EXPECT_NEAR(slow_range_of_mean(frames, camera), 0.001, 1e-6);
  camera.correlation.slow_s = 0.2;
  EXPECT_NEAR(slow_range_of_mean(frames, camera), 0.001 * std::sqrt(2 * 0.2 / 40), 1e-6);
  ToolGeometrySettings settings;
  settings.correlated_range_m = 0.0004;
  const ToolGeometry plain = calibrate_tool(recorded({}), {}, "plain.csv"),
                     stated = calibrate_tool(recorded({}), settings, "stated.csv");
  for (std::size_t i = 0; i < k_four.size(); ++i)
    EXPECT_NEAR(stated.marker_sigma_m[i],
                std::hypot(plain.marker_sigma_m[i], 0.0004 / std::sqrt(3.0)), 1e-9);
}

TEST(ToolGeometry, KeepsANearlySymmetricToolApartFromItsMirrorOverAJump) {
  Recording how;
  how.markers = k_grid;
  how.noise_m = 0.0001;
  how.strays = 0;
  how.missing = 0.03;
  how.jump_at = 140;
  const ToolGeometry found = calibrate_tool(recorded(how), {}, "grid.csv");
  EXPECT_EQ(found.segments, 2);
  EXPECT_LT(error_of(found.markers_m, k_grid), 0.00003);
}

TEST(ToolGeometry, ScalesToAKnownSide) {
  Recording how;
  for (Vector3& marker : how.markers) marker *= 0.98;  // a tracker with a scale error of -2 %
  ToolGeometrySettings settings;
  settings.longest_side_m = 0.088;
  const ToolGeometry found = calibrate_tool(recorded(how), settings, "short.csv");
  EXPECT_NEAR(found.scale, 1 / 0.98, 0.001);
  EXPECT_LT(error_of(found.markers_m, k_four), 0.00006);
}

Tool drawn_tool(const std::vector<Vector3>& markers) {
  Tool tool;
  for (const Vector3& marker : markers)
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  EXPECT_EQ(prepare_tool(tool), Reason::none);
  return tool;
}

// Markers off by 0.4 mm, ranges 1.2 % too small: the result has the drawing's frame, order and
// scale.
TEST(ToolGeometry, IsLaidOnItsDrawing) {
  const std::vector<Vector3> drawn{
      {0.01, 0.02, 0.1}, {0.08, 0.02, 0.13}, {0.03, 0.09, 0.12}, {-0.04, 0.05, 0.18}, {0, 0, 0.2}};
  std::vector<Vector3> made = drawn;
  for (std::size_t i = 0; i < made.size(); ++i)
    made[i] += 0.0004 * sim::gaussian_vector({11, sim::Stream::hand, 1}, i);
  ToolGeometrySettings settings;
  settings.drawn = drawn_tool(drawn);
  const RigidFit as_made = fit_rigid(made, drawn);
  Recording how;
  how.markers = made;
  for (Vector3& marker : how.markers) marker *= 0.988;
  const ToolGeometry found = calibrate_tool(recorded(how), settings, "drawn.csv");
  ASSERT_EQ(found.markers_m.size(), drawn.size());
  EXPECT_NEAR(found.scale, 1 / 0.988, 0.006);
  EXPECT_NEAR(found.drawn_rms_m, as_made.rms_m, 0.0001);
  double off_m = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Vector3 off = found.markers_m[i] - as_made.transform * made[i];
    off_m = std::max(off_m, off.norm());
    // The drawing limits the scale: 0.3 mm over 0.19 m.
    EXPECT_GT(found.marker_sigma_m[i], 0.00002);
    EXPECT_LT(found.marker_sigma_m[i], 0.0002);
  }
  EXPECT_LT(off_m, 0.0004);

  settings.longest_side_m = (made[1] - made[3]).norm();
  const ToolGeometry sized = calibrate_tool(recorded(how), settings, "sized.csv");
  for (std::size_t i = 0; i < drawn.size(); ++i)
    EXPECT_LT((sized.markers_m[i] - as_made.transform * made[i]).norm(), 0.0001) << i;
}

TEST(ToolGeometry, RefusesAnotherToolThanTheDrawnOne) {
  ToolGeometrySettings settings;
  settings.drawn = drawn_tool(k_grid);
  test::expect_input_error([&] { (void)calibrate_tool(recorded({}), settings, "other.csv"); },
                           {"other.csv", "of 4 found markers", "6 drawn"});
}

TEST(ToolGeometry, RefusesWhatIsNoToolInMotion) {
  Recording how;
  how.frames = 10;
  test::expect_input_error([&] { (void)calibrate_tool(recorded(how), {}, "few.csv"); },
                           {"few.csv", "frames", "at least 20"});
  how = {};
  how.markers = {{0, 0, 0}, {0, 0, 0.1}};
  how.strays = 0;
  test::expect_input_error([&] { (void)calibrate_tool(recorded(how), {}, "two.csv"); },
                           {"two.csv", "3 to 8"});
  how.markers = {{0, 0, 0}, {0, 0, 0.05}, {0, 0, 0.12}};
  test::expect_input_error([&] { (void)calibrate_tool(recorded(how), {}, "line.csv"); },
                           {"line.csv", "collinear"});
  how = {};
  how.turn_rad = 0.01;
  test::expect_input_error([&] { (void)calibrate_tool(recorded(how), {}, "still.csv"); },
                           {"still.csv", "turned by only", "to all sides"});
}

}  // namespace
}  // namespace glint

#include "platform/tools/mapping/map_halves.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "platform/tools/mapping/depth_png.hpp"

namespace glint {
namespace {

DepthSequence recorded() {
  const char* const data = std::getenv("GLINT_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data != nullptr ? data : "") / "depth_sequence";
  return std::filesystem::is_directory(folder) ? load_depth_sequence(folder.string())
                                               : DepthSequence{};
}

TEST(MapHalves, OfARecordedDeskAgreeAndAreSmooth) {
  const DepthSequence sequence = recorded();
  if (sequence.frames.empty()) GTEST_SKIP() << "GLINT_TEST_DATA/depth_sequence is not there";
  const MapHalves halves = compare_halves(sequence, {});
  ASSERT_EQ(halves.planes.size(), 3u);
  for (const PlaneAgreement& plane : halves.planes) {
    std::printf(
        "%6d points: %.3f deg %.3f mm, rms %.3f -> %.3f mm (%.3f), held out %+.3f mm (%lld)\n",
        plane.points, plane.angle_deg, 1e3 * plane.offset_m, 1e3 * plane.voxel_rms_m,
        1e3 * plane.smooth_rms_m, plane.smooth_rms_m / plane.voxel_rms_m, 1e3 * plane.held_out_m,
        static_cast<long long>(plane.held_out));
    ASSERT_TRUE(plane.matched);
    EXPECT_LE(plane.angle_deg, 0.15);
    EXPECT_LE(plane.offset_m, 0.0005);
    EXPECT_LE(plane.smooth_rms_m, 0.5 * plane.voxel_rms_m);
    EXPECT_GT(plane.held_out, 1'000);
    EXPECT_LE(std::abs(plane.held_out_m), 0.0015);
  }
  std::printf("moved %.3f mm at most; %.4f of %lld swallowed\n", 1e3 * halves.displacement_max_m,
              halves.wrong_normal_share, static_cast<long long>(halves.evaluated));
  EXPECT_LE(halves.displacement_max_m, 0.010001);
  EXPECT_GT(2 * halves.evaluated, halves.projected);
  EXPECT_LE(halves.wrong_normal_share, 0.02);
}

}  // namespace
}  // namespace glint

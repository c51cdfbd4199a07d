#include "platform/lab/experiments/acquisition_experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace glint {
namespace {

constexpr int k_frames = 68;  // 1.5 s

const AcquisitionCase& case_named(const std::vector<AcquisitionCase>& cases,
                                  const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(),
                       [&](const AcquisitionCase& one) { return one.name == name; });
}

// A short version; `glint experiment acquire` runs 20 random seeds and more cases.
TEST(Acquisition, FindsAToolAmongStraysAndHotPixelsWithinASecond) {
  const std::vector<AcquisitionCase> cases = acquisition_cases();
  for (const char* name : {"200 strays", "1,000 hot pixels", "500 discs"}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      const std::vector<Acquisition> tools = acquire(case_named(cases, name), k_frames, seed);
      ASSERT_EQ(tools.size(), 1u);
      const Acquisition& tool = tools[0];
      EXPECT_TRUE(tool.found) << name << ", random seed " << seed;
      EXPECT_LE(tool.found_s, 1.0) << name << ", random seed " << seed;
      EXPECT_GE(100 * tool.fresh, 99 * tool.trackable) << name << ", random seed " << seed;
      EXPECT_EQ(tool.gross, 0) << name << ", random seed " << seed;
    }
  }
}

TEST(PaintedSpots, AreTheSameAgainAndSpareTheMarkers) {
  SpotSettings settings;
  settings.count = 50;
  settings.radius_max_px = 4;
  settings.speed_px_s = 50;
  const Camera camera = hololens2_ahat();
  sim::SimFrame frame;
  frame.pixels.width = frame.pixels.height = 512;
  frame.pixels.reflectivity_16.assign(512 * 512, 0);
  frame.pixels.depth.assign(512 * 512, 0);
  sim::SimFrame again = frame;
  EXPECT_EQ(PaintedSpots(settings, camera, 3).paint({}, frame), 50);
  EXPECT_EQ(PaintedSpots(settings, camera, 3).paint({}, again), 50);
  EXPECT_EQ(frame.pixels.reflectivity_16, again.pixels.reflectivity_16);
  ToolSet tools;
  tools.count = 1;
  tools.items[0].marker_count = 1;
  tools.items[0].marker_radius_m = 0.5;  // its sphere covers the whole image
  frame.truth.T_world_tool = {{Quaternion::Identity(), Vector3(0, 0, 0.5)}};
  EXPECT_LT(PaintedSpots(settings, camera, 3).paint(tools, frame), 50);
}

}  // namespace
}  // namespace glint

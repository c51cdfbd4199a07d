#include "platform/sim/crowded.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "platform/sim/simulator.hpp"

namespace glint::sim {
namespace {

TEST(Crowded, ShowsEveryToolToTheCamera) {
  const ToolSet tools = crowd_of_tools(k_tools_max, 1);
  const Simulator simulator(crowded_run(tools, 0, 1));
  SimFrame frame;
  simulator.render(5, frame);
  int whole = 0;
  for (const std::uint8_t mask : frame.truth.visible_mask) whole += mask == 0b11111;
  EXPECT_EQ(whole, k_tools_max);
}

TEST(Crowded, KeepsTheFirstToolsAndStraysWhenThereAreMore) {
  const ToolSet few = crowd_of_tools(3, 7), many = crowd_of_tools(9, 7);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_EQ(few.items[t].markers_m[4], many.items[t].markers_m[4]);
  }
  const Scenario a = crowded_run(few, 10, 7), b = crowded_run(few, 200, 7);
  ASSERT_EQ(b.clutter.size(), 200u);
  EXPECT_EQ(a.clutter[9].position_m, b.clutter[9].position_m);
}

TEST(Crowded, AddsABrightBlobForNearlyEveryStray) {
  const auto bright = [](int strays) {
    const Simulator simulator(crowded_run(ToolSet{}, strays, 3));
    auto frame = std::make_unique<SimFrame>();
    simulator.render(0, *frame);
    const Frame view = frame->view();
    int pixels = 0;
    for (int i = 0; i < view.width() * view.height(); ++i) {
      pixels += view.reflectivity_16.pixels[i] > simulator.scenario().camera.threshold;
    }
    return pixels;
  };
  const int none = bright(0);
  EXPECT_GT(bright(200), none + 1000);
}

}  // namespace
}  // namespace glint::sim

#include "tests/footprint/frames.hpp"

#include <functional>

#include "kernels/limits.hpp"
#include "platform/sim/crowded.hpp"
#include "platform/sim/simulator.hpp"

namespace glint::footprint {
namespace {

constexpr int k_crowd_frames = 24;
constexpr int k_strays = 40;
constexpr std::uint32_t k_worst_every = 128;
constexpr std::uint16_t k_bright = 4000;
constexpr std::uint16_t k_half_a_metre = 500;  // depth in millimetres

PlayedFrame painted(const CameraModel& camera, const std::function<bool(int x, int y)>& bright) {
  PlayedFrame frame;
  FrameBuffer& pixels = frame.pixels;
  pixels.width = camera.width;
  pixels.height = camera.height;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      pixels.reflectivity_16.push_back(bright(x, y) ? k_bright : 0);
      pixels.depth.push_back(k_half_a_metre);
    }
  }
  frame.head.valid = true;
  return frame;
}

TestFrames make_test_frames() {
  TestFrames frames;
  const ToolSet tools = sim::crowd_of_tools(k_tools_max, 1);
  const sim::Scenario scenario = sim::crowded_run(tools, k_strays, 1);
  const sim::Simulator simulator(scenario);
  frames.cell = default_cell();
  set_camera(frames.cell, scenario.camera);
  frames.cell.tools = tools;
  // The largest budget, so that every loop can run to its maximum.
  frames.cell.budget = {.tools = k_tools_max,
                        .blobs = k_blobs_max,
                        .runs_per_band = k_runs_per_band_max,
                        .search_steps = k_search_steps_max};
  sim::SimFrame rendered;
  for (int i = 0; i < k_crowd_frames; ++i) {
    simulator.render(i, rendered);
    frames.crowd.push_back({rendered.pixels, rendered.head});
  }
  const CameraModel& camera = frames.cell.camera.model;
  // A checkerboard (a run every second pixel); all bright; all dark; discs that fill every blob.
  frames.worst.push_back(painted(camera, [](int x, int y) { return (x + y) % 2 == 0; }));
  frames.worst.push_back(painted(camera, [](int, int) { return true; }));
  frames.worst.push_back(painted(camera, [](int, int) { return false; }));
  frames.worst.push_back(painted(camera, [](int x, int y) {
    const int dx = x % 24 - 12, dy = y % 24 - 12;
    return dx * dx + dy * dy <= 36;
  }));
  return frames;
}

}  // namespace

const TestFrames& test_frames() {
  static const TestFrames made = make_test_frames();
  return made;
}

const PlayedFrame& frame_of_cycle(std::uint32_t cycle) {
  const TestFrames& frames = test_frames();
  if (cycle % k_worst_every == k_worst_every - 1) {
    return frames.worst[cycle / k_worst_every % frames.worst.size()];
  }
  // Forwards and backwards, so that no tool jumps.
  const auto count = static_cast<std::uint32_t>(frames.crowd.size());
  const std::uint32_t at = cycle % (2 * count);
  return frames.crowd[at < count ? at : 2 * count - 1 - at];
}

}  // namespace glint::footprint

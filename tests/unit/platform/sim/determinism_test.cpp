// The same random seed gives the same bytes: in any order, from any thread, on any machine.
#include <gtest/gtest.h>

#include <thread>

#include "platform/sim/scenarios.hpp"
#include "small_scene.hpp"

namespace glint::sim {
namespace {

class Fnv1a {  // 64 bit
 public:
  void add(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) hash_ = (hash_ ^ ((value >> (8 * i)) & 0xFF)) * 0x100000001B3u;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

std::uint64_t hash_of(const SimFrame& frame) {
  Fnv1a hash;
  for (const auto pixel : frame.pixels.reflectivity_8) hash.add(pixel, 1);
  for (const auto pixel : frame.pixels.reflectivity_16) hash.add(pixel, 2);
  for (const auto pixel : frame.pixels.depth) hash.add(pixel, 2);
  hash.add(static_cast<std::uint64_t>(frame.arrival.nanoseconds), 8);
  hash.add(frame.sequence, 4);
  for (const Pose& pose : {frame.head.T_world_camera, frame.truth.T_world_camera,
                           frame.truth.T_world_tool.front(), frame.reference.front()}) {
    for (int i = 0; i < 4; ++i)
      hash.add(std::bit_cast<std::uint64_t>(pose.rotation.coeffs()[i]), 8);
    for (int i = 0; i < 3; ++i) hash.add(std::bit_cast<std::uint64_t>(pose.translation[i]), 8);
  }
  hash.add(frame.truth.visible_mask.front(), 1);
  return hash.value();
}

std::uint64_t hash_of(const Simulator& simulator, std::initializer_list<int> frames) {
  Fnv1a hash;
  SimFrame frame;
  for (const int i : frames) {
    simulator.render(i, frame);
    hash.add(hash_of(frame), 8);
  }
  return hash.value();
}

// Changes of a preset change these hashes; changes of compiler, flags or machine must not.
TEST(Determinism, GivesTheFramesOfTheDefaultRunTheirKnownBytes) {
  EXPECT_EQ(hash_of(Simulator(default_run()), {0, 333, 1290, 1800}), 407481027437288636u);
}

TEST(Determinism, GivesTheFramesOfAnEightBitCameraTheirKnownBytes) {
  Scenario scenario = still_run(hololens1_short_throw());
  scenario.duration = milliseconds(1000);
  scenario.noise = NoiseSettings{};
  scenario.signal = SignalSettings{};
  scenario.localisation = LocalisationSettings{};
  EXPECT_EQ(hash_of(Simulator(scenario), {0, 20}), 8845701419303937848u);
}

Scenario noisy_scene(std::uint64_t seed) {
  Scenario scenario = dark_scene();
  scenario.noise = NoiseSettings{};
  scenario.signal.wall = 400;
  scenario.seed = seed;
  return scenario;
}

TEST(Determinism, GivesTheSameBytesInAnyOrderAndFromAnyThread) {
  const Simulator simulator(noisy_scene(1));
  std::vector<std::uint64_t> forward(20), backward(20);
  SimFrame frame;
  for (int i = 0; i < 20; ++i) {
    simulator.render(i, frame);
    forward[static_cast<std::size_t>(i)] = hash_of(frame);
  }
  const auto render_every_other = [&](int first) {
    SimFrame own;
    for (int i = first; i >= 0; i -= 2) {
      simulator.render(i, own);
      backward[static_cast<std::size_t>(i)] = hash_of(own);
    }
  };
  std::thread other(render_every_other, 18);
  render_every_other(19);
  other.join();
  EXPECT_EQ(forward, backward);
}

TEST(Determinism, GivesOtherBytesForAnotherSeedOrFrame) {
  const Simulator one(noisy_scene(1)), two(noisy_scene(2));
  EXPECT_NE(hash_of(one, {3}), hash_of(two, {3}));
  EXPECT_NE(hash_of(one, {3}), hash_of(one, {4}));
}

TEST(Determinism, GivesADoubledFrameTheSamePixels) {
  Scenario scenario = noisy_scene(1);
  scenario.timing.faults.push_back({Fault::doubled, Time{}, milliseconds(3)});
  const Simulator simulator(scenario);
  SimFrame first, second;
  simulator.render(0, first);
  simulator.render(1, second);
  EXPECT_EQ(first.sequence, second.sequence);
  EXPECT_EQ(first.pixels.reflectivity_16, second.pixels.reflectivity_16);
  EXPECT_EQ(first.pixels.depth, second.pixels.depth);
}

TEST(Determinism, KeepsItsBuffersFromFrameToFrame) {
  const Simulator simulator(noisy_scene(1));
  SimFrame frame;
  simulator.render(0, frame);
  const void* const before[] = {frame.pixels.reflectivity_16.data(), frame.pixels.depth.data(),
                                frame.scratch.signal.data(), frame.reference.data(),
                                frame.truth.visible_mask.data()};
  simulator.render(7, frame);
  const void* const after[] = {frame.pixels.reflectivity_16.data(), frame.pixels.depth.data(),
                               frame.scratch.signal.data(), frame.reference.data(),
                               frame.truth.visible_mask.data()};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(before[i], after[i]);
}

}  // namespace
}  // namespace glint::sim

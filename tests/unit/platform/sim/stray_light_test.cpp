#include "platform/sim/stray_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glint::sim {
namespace {

constexpr int k_side = 64;

Planes uniform_planes(float signal, float range_m) {
  Planes planes;
  planes.resize(k_side, k_side);
  std::fill(planes.signal.begin(), planes.signal.end(), signal);
  std::fill(planes.range_m.begin(), planes.range_m.end(), range_m);
  return planes;
}

DeviceErrors hololens_light() {
  DeviceErrors device;
  device.spread_share = 0.14;
  device.halo_share = 0.2;
  return device;
}

double sum(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(StrayLight, LeavesAPictureAsItIsWhereADeviceHasNone) {
  Planes planes = uniform_planes(100, 0.5f), scratch;
  planes.signal[77] = 5000;
  const Planes before = planes;
  add_stray_light({}, scratch, planes);
  EXPECT_EQ(planes.signal, before.signal);
  EXPECT_EQ(planes.range_m, before.range_m);
}

// The real frame's glint: 9,000 counts in its core, 1 % of its peak at 3 pixels, 7 to 23 counts at
// 5 pixels, above a background of 5.
TEST(StrayLight, SpreadsAPointAsARealFrameHasIt) {
  Planes planes = uniform_planes(5, 0.5f), scratch;
  const std::size_t middle = planes.at(32, 32);
  planes.signal[middle] = 11'000;
  const double light = sum(planes.signal);
  add_stray_light(hololens_light(), scratch, planes);
  EXPECT_NEAR(sum(planes.signal), light, 1e-4 * light) << "none is lost";
  const auto peak = static_cast<double>(planes.signal[middle]);
  const auto at = [&](int right) {
    return static_cast<double>(planes.signal[middle + static_cast<std::size_t>(right)]) - 5;
  };
  EXPECT_GT(at(1), 0.1 * peak);
  EXPECT_LT(at(1), 0.5 * peak) << "less than two pixels wide at half its height";
  EXPECT_NEAR(at(3) / peak, 0.01, 0.005);
  EXPECT_GT(at(5), 7);
  EXPECT_LT(at(5), 23);
  EXPECT_NEAR(at(9), 0, 1e-3);
  EXPECT_EQ(planes.signal[planes.at(32, 31)], planes.signal[planes.at(32, 33)]);
  EXPECT_EQ(planes.signal[planes.at(31, 32)], planes.signal[planes.at(33, 32)]);
}

// A near bright half beside a far dim one.
TEST(StrayLight, MixesRangesWhereTwoSurfacesMeet) {
  Planes planes = uniform_planes(100, 1.0f), scratch;
  for (int y = 0; y < k_side; ++y) {
    for (int x = 0; x < 32; ++x) {
      planes.signal[planes.at(x, y)] = 200;
      planes.range_m[planes.at(x, y)] = 0.5f;
    }
  }
  DeviceErrors device;
  device.spread_share = 0.14;
  add_stray_light(device, scratch, planes);
  const auto range = [&](int x) { return static_cast<double>(planes.range_m[planes.at(x, 20)]); };
  EXPECT_NEAR(range(31), (0.86 * 200 * 0.5 + 0.14 * 100 * 1.0) / (0.86 * 200 + 0.14 * 100), 1e-5);
  EXPECT_NEAR(range(32), (0.86 * 100 * 1.0 + 0.14 * 200 * 0.5) / (0.86 * 100 + 0.14 * 200), 1e-5);
  EXPECT_NEAR(range(29), 0.5, 1e-6);
  EXPECT_NEAR(range(34), 1.0, 1e-6);
}

TEST(StrayLight, MovesADimSurfaceMoreThanABrightOne) {
  Planes planes = uniform_planes(100, 0.8f), scratch;
  const std::size_t bright = planes.at(10, 10), dim = planes.at(50, 50);
  planes.signal[bright] = 10'000;
  planes.signal[dim] = 1'000;
  planes.range_m[bright] = planes.range_m[dim] = 0.4f;
  DeviceErrors device;
  device.stray_share = 0.02;
  device.stray_detour_m = 0.3;
  const double mean = sum(planes.signal) / (k_side * k_side);
  add_stray_light(device, scratch, planes);
  const double signal = 0.02 * mean;
  EXPECT_NEAR(static_cast<double>(planes.signal[dim]), 1000 + signal, 1e-3);
  const auto moved = [&](std::size_t i) { return static_cast<double>(planes.range_m[i]) - 0.4; };
  EXPECT_GT(moved(dim), 0.0005);
  EXPECT_NEAR(moved(dim) / moved(bright), 10, 0.1);
  EXPECT_GT(static_cast<double>(planes.range_m[0]), 0.8) << "light by a longer way";
}

TEST(StrayLight, HasItsHotPixelsInTheSamePlaces) {
  DeviceErrors device;
  device.hot_pixels = 20;
  device.seed = 4;
  Planes planes = uniform_planes(10, 1.5f), again = uniform_planes(60, 1.2f), scratch;
  add_stray_light(device, scratch, planes);
  add_stray_light(device, scratch, again);
  int hot = 0;
  for (std::size_t i = 0; i < planes.signal.size(); ++i) {
    if (planes.signal[i] == 10) continue;
    ++hot;
    EXPECT_EQ(planes.signal[i], again.signal[i]);
    EXPECT_GE(planes.signal[i], 300);
    EXPECT_LE(planes.signal[i], 30'000);
    EXPECT_LT(planes.range_m[i], 1.0f);
  }
  EXPECT_GE(hot, 18) << "two may fall together";
  EXPECT_LE(hot, 20);
}

}  // namespace
}  // namespace glint::sim

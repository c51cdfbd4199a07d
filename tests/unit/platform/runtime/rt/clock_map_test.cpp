#include "platform/runtime/rt/clock_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace glint {
namespace {

constexpr Duration k_delay = milliseconds(9);
constexpr std::int64_t k_start_ns = 5'000'000'000'000;

struct Stream {
  double rate = 45, seconds = 60;
  double drift = 50e-6;
  std::function<double(double)> step_s = [](double) { return 0.0; };  // of the device's clock
  std::function<double(std::mt19937_64&)> jitter_s;
};

struct Outcome {
  double rms_ms = 0;
  std::vector<double> errors_ms;  // errors of the mapped time stamps, in order
  std::vector<double> sigmas_ms;  // standard deviations as stated with each
};

// Frames exposed at a constant rate of the device's clock; the delivery delay has jitter.
Outcome run(const Stream& stream, ClockMap& map, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Outcome outcome;
  double squares = 0;
  const int frames = static_cast<int>(stream.seconds * stream.rate);
  for (int i = 0; i < frames; ++i) {
    const double t = i / stream.rate;
    const Time exposed{k_start_ns + static_cast<std::int64_t>(1e9 * t)};
    const Time stamp{
        static_cast<std::int64_t>(1e9 * (777 + t * (1 + stream.drift) + stream.step_s(t)))};
    const Time arrival =
        exposed + k_delay + Duration{static_cast<std::int64_t>(1e9 * stream.jitter_s(random))};
    const auto mapped = map.map(stamp, arrival);
    if (!mapped) continue;
    EXPECT_LE(*mapped, arrival);
    outcome.errors_ms.push_back((*mapped - exposed).seconds() * 1e3);
    outcome.sigmas_ms.push_back(map.uncertainty().seconds() * 1e3);
    squares += outcome.errors_ms.back() * outcome.errors_ms.back();
  }
  outcome.rms_ms = std::sqrt(squares / static_cast<double>(outcome.errors_ms.size()));
  return outcome;
}

double uniform_5_ms(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(0, 0.005)(random);
}
double half_normal_5_ms(std::mt19937_64& random) {
  return std::abs(std::normal_distribution<double>(0, 0.005)(random));
}

TEST(ClockMap, FollowsOffsetAndDriftUnderJitter) {
  for (const double rate : {45.0, 15.0, 5.0}) {
    for (const double drift : {50e-6, -50e-6}) {
      for (const auto& jitter : {uniform_5_ms, half_normal_5_ms}) {
        for (const std::uint64_t seed : {1u, 2u, 3u}) {
          ClockMap map(k_delay);
          Stream stream;
          stream.rate = rate;
          stream.drift = drift;
          stream.jitter_s = jitter;
          const Outcome outcome = run(stream, map, seed);
          EXPECT_LT(outcome.rms_ms, 1.0) << rate << " " << drift << " " << seed;
          EXPECT_EQ(map.refused(), 0u);
          EXPECT_NEAR(map.drift(), -drift, rate > 20 ? 20e-6 : 100e-6);
          EXPECT_LT(map.uncertainty(), milliseconds(2));
        }
      }
    }
  }
}

// Starts with the first time stamp. A drift keeps the error constant for seconds, so the share
// inside is taken over all runs.
TEST(ClockMap, StatesHowFarAStampMayBeOff) {
  double inside = 0, all = 0, squares = 0, stated = 0;
  for (const double rate : {45.0, 15.0, 5.0}) {
    for (const auto& jitter : {uniform_5_ms, half_normal_5_ms}) {
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        ClockMap map(k_delay);
        Stream stream;
        stream.rate = rate;
        stream.drift = seed % 2 == 0 ? 50e-6 : -20e-6;
        stream.jitter_s = jitter;
        const Outcome outcome = run(stream, map, seed);
        for (std::size_t i = 0; i < outcome.errors_ms.size(); ++i) {
          const double error = outcome.errors_ms[i], sigma = outcome.sigmas_ms[i];
          inside += std::abs(error) <= 2 * sigma ? 1 : 0;
          squares += error * error;
          stated += sigma * sigma;
          ++all;
        }
      }
    }
  }
  EXPECT_GT(inside / all, 0.95);
  EXPECT_LT(std::sqrt(stated / squares), 3.0);
}

TEST(ClockMap, RefusesAStepAndThenFollowsTheNewClock) {
  for (const double step : {1.0, -1.0}) {
    ClockMap map(k_delay);
    Stream stream;
    stream.jitter_s = uniform_5_ms;
    stream.step_s = [step](double t) { return t >= 30 ? step : 0.0; };
    const Outcome outcome = run(stream, map, 7);
    EXPECT_EQ(map.refused(), static_cast<std::uint64_t>(ClockMap::k_agreeing));
    EXPECT_EQ(map.restarts(), 1u);
    EXPECT_LT(outcome.rms_ms, 1.0);
  }
}

// Single time stamps that are off by a second are rejected and do not affect the others.
// 45 frames wait in the network and arrive within 5 ms.
TEST(ClockMap, KeepsItsClockWhenWaitingStampsArriveAtOnce) {
  ClockMap map(k_delay);
  const Time released{k_start_ns + 11'000'000'000};
  for (int i = 0; i < 45 * 20; ++i) {
    const Time stamp{1'000'000'000'000 + i * 22'222'222LL};
    const Time exposed{k_start_ns + i * 22'222'222LL};
    const bool waits = i >= 450 && exposed + k_delay < released;
    const Time arrival = waits ? released + microseconds(100 * (i - 450)) : exposed + k_delay;
    const auto mapped = map.map(stamp, arrival);
    if (mapped) {
      EXPECT_NEAR((*mapped - exposed).seconds() * 1e3, 0, 1) << "frame " << i;
    } else {
      EXPECT_LT(i, 500);
    }
  }
  EXPECT_EQ(map.restarts(), 0u);
  EXPECT_GT(map.refused(), 20u);
}

TEST(ClockMap, RefusesSingleStampsWithoutAStep) {
  ClockMap map(k_delay);
  Stream stream;
  stream.jitter_s = uniform_5_ms;
  stream.step_s = [](double t) { return std::fmod(t, 10) < 0.1 && t > 5 ? 1.0 : 0.0; };
  const Outcome outcome = run(stream, map, 7);
  EXPECT_EQ(map.refused(), 25u);
  EXPECT_EQ(map.restarts(), 0u);
  EXPECT_LT(outcome.rms_ms, 0.5);
}

// Before it has enough time stamps the map uses the arrival time and never returns a later one.
TEST(ClockMap, BeginsWithTheDeclaredDelay) {
  ClockMap map(k_delay);
  EXPECT_EQ(map.map(Time{500}, Time{} + milliseconds(100)), Time{} + milliseconds(91));
  EXPECT_EQ(map.uncertainty(), ClockMap::k_delay_sigma);
}

}  // namespace
}  // namespace glint

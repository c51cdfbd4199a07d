// Ticks that frames' estimates release: their times, their CAN sets at a controller, their replay.
#include "platform/runtime/session/tick_releases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/runtime/session/estimate_loop.hpp"
#include "platform/sinks/can/candump_line.hpp"
#include "platform/sinks/can/controller/glint_controller.h"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

constexpr Duration k_longest_gap = milliseconds(4), k_shortest_gap = microseconds(2500);

// The default cell; a recording contains its text.
Cell by_estimates() {
  return cell_from_text("[rates]\ntick_release = \"estimate\"\n", "cell.toml");
}
Cell short_by_estimates(double seconds, const std::string& level = "roi") {
  Cell cell = shortened(by_estimates(), seconds);
  cell.record.level = level;
  return cell;
}

struct Released {
  std::vector<Time> ticks;
  std::vector<Duration> waits;  // from each estimate's publication to the tick that carries it
};

// Releases ticks until the last of these publications is carried.
Released released_by(const Cell& cell, const std::vector<Time>& publications) {
  TickReleases releases(cell);
  MeasuredEstimate newest;
  Released result;
  std::size_t published = 0;
  while (result.waits.size() < publications.size()) {
    const Time tick = releases.next(newest);
    if (published < publications.size() && publications[published] <= tick) {
      newest = {published + 1, publications[published]};
      ++published;
      continue;
    }
    releases.released(tick, newest);
    result.ticks.push_back(tick);
    while (result.waits.size() < published) {
      result.waits.push_back(tick - publications[result.waits.size()]);
    }
  }
  return result;
}

// Publications `period` apart, each up to `jitter` later.
std::vector<Time> publications(int count, Duration period, Duration jitter) {
  std::mt19937_64 random(22);
  std::vector<Time> times;
  for (int i = 0; i < count; ++i) {
    const auto later = static_cast<std::int64_t>(random() % std::uint64_t(jitter.nanoseconds + 1));
    times.push_back(Time{} + milliseconds(50) + period * i + Duration{later});
  }
  return times;
}

void expect_gaps(const std::vector<Time>& ticks) {
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const Duration gap = ticks[i] - ticks[i - 1];
    ASSERT_GE(gap, k_shortest_gap) << i;
    ASSERT_LE(gap, k_longest_gap) << i;
  }
}

TEST(TickReleases, AreThePeriodsWhereTheClockAloneReleases) {
  const Released result =
      released_by(default_cell(), publications(500, microseconds(22'222), microseconds(900)));
  ASSERT_GT(result.ticks.size(), 2000U);
  for (std::size_t i = 0; i < result.ticks.size(); ++i) {
    ASSERT_EQ(result.ticks[i], Time{} + k_longest_gap * static_cast<std::int64_t>(i));
  }
}

TEST(TickReleases, KeepTheShortestGapInABurstOfFrames) {
  for (const int gap_us : {1, 100, 700, 2499, 2500, 2501, 3999, 4001}) {
    const Released burst =
        released_by(by_estimates(), publications(2000, microseconds(gap_us), microseconds(gap_us)));
    expect_gaps(burst.ticks);
    EXPECT_LE(*std::max_element(burst.waits.begin(), burst.waits.end()), k_shortest_gap) << gap_us;
  }
}

TEST(TickReleases, FollowTheEstimatesOfACameraAtOnce) {
  for (const double hz : {5.0, 15.0, 30.0, 45.0, 60.0, 90.0}) {
    Cell cell = by_estimates();
    cell.camera.period = {static_cast<std::int64_t>(1e9 / hz)};
    Released result = released_by(cell, publications(1000, cell.camera.period, microseconds(450)));
    expect_gaps(result.ticks);
    result.waits.erase(result.waits.begin(), result.waits.begin() + 20);  // until in phase
    EXPECT_LE(*std::max_element(result.waits.begin(), result.waits.end()), Duration{}) << hz;
  }
}

TEST(TickReleases, FollowTheEstimatesAgainAfterLostFrames) {
  const Cell cell = by_estimates();
  std::vector<Time> times = publications(2000, cell.camera.period, microseconds(400));
  std::mt19937 random(3);
  std::erase_if(times, [&](Time) { return random() % 4 == 0; });
  Released result = released_by(cell, times);
  expect_gaps(result.ticks);
  const auto waiting = std::count_if(result.waits.begin() + 20, result.waits.end(),
                                     [](Duration wait) { return wait > Duration{}; });
  EXPECT_EQ(waiting, 0);
}

TEST(TickReleases, WaitAtMostTheShortestGapWhateverTheFramesDo) {
  std::mt19937_64 random(5);
  std::vector<Time> times{Time{} + milliseconds(3)};
  while (times.size() < 20'000) {
    times.push_back(times.back() + Duration{static_cast<std::int64_t>(random() % 60'000'000)});
  }
  const Released result = released_by(by_estimates(), times);
  expect_gaps(result.ticks);
  EXPECT_LE(*std::max_element(result.waits.begin(), result.waits.end()), k_shortest_gap);
}

// Live: the loop's nominal times obey the rule however late the threads run.
TEST(EstimateLoop, NumbersItsTicksWithoutGapsAndKeepsTheShortestGap) {
  MeasuredEstimates estimates;
  const Time epoch = monotonic_now();
  EstimateLoop loop(by_estimates(), epoch, estimates);
  std::atomic<bool> ended{false};
  std::thread frames([&] {
    for (std::uint64_t version = 1; !ended; ++version) {
      estimates.publish({version, Time{} + (monotonic_now() - epoch)});
      (void)sleep_until(monotonic_now() + microseconds(300));
    }
  });
  std::optional<Tick> last;
  for (std::uint64_t number = 0; number < 100; ++number) {
    const std::optional<Tick> tick = loop.next();
    ASSERT_TRUE(tick);
    EXPECT_EQ(tick->number, number);
    EXPECT_GE(tick->woken, tick->nominal);
    if (last) {
      EXPECT_GE(tick->nominal - last->nominal, k_shortest_gap);
    }
    last = tick;
  }
  ended = true;
  frames.join();
}

struct Sets {
  glint_controller controller{};
  std::vector<std::uint64_t> received_us;  // complete sets
};

// Gives a run's CAN log to the controller's decoder.
Sets controller_after(const std::string& log, bool fd) {
  Sets sets;
  const glint_settings settings = {.base = k_can_base_default,
                                   .fd = fd,
                                   .cycle_us = 4000,
                                   .speed_max = 5000,
                                   .age_max = 1000,
                                   .measured_max = 100'000,
                                   .heartbeat = 0x720};
  glint_init(&sets.controller, &settings);
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) {
    const auto record = parse_candump(line);
    if (!record) continue;
    const CanFrame& frame = record->frame;
    const glint_frame received{frame.identifier, frame.fd, frame.length, frame.data.data()};
    const auto now_us = static_cast<std::uint64_t>(record->unix_ns / 1000);
    const glint_verdict verdict = glint_receive(&sets.controller, &received, now_us);
    if (verdict != GLINT_IGNORED && verdict != GLINT_PARTIAL) sets.received_us.push_back(now_us);
  }
  return sets;
}

class TickReleasesOfARun : public testing::TestWithParam<CanFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, TickReleasesOfARun,
                         testing::Values(CanFormat::classic, CanFormat::fd),
                         [](const auto& format) {
                           return format.param == CanFormat::fd ? "Fd" : "Classic";
                         });

TEST_P(TickReleasesOfARun, AreAcceptedByTheController) {
  TemporaryFolder folder;
  Cell cell = short_by_estimates(2.5);
  cell.can.format = GetParam();
  const SessionResult run = short_run(cell, folder.path());
  const Sets sets = controller_after(folder.path() + "/can.log", GetParam() == CanFormat::fd);
  const auto& count = sets.controller.count;
  for (const glint_verdict wrong : {GLINT_WRONG_FORMAT, GLINT_WRONG_CHECK, GLINT_INCOMPLETE,
                                    GLINT_REPEATED, GLINT_IMPLAUSIBLE}) {
    EXPECT_EQ(count[wrong], 0U) << wrong;
  }
  EXPECT_LE(count[GLINT_JUMPED], 2U) << "of the sequence's first sets";
  EXPECT_GT(count[GLINT_ACCEPTED], 500U);
  EXPECT_EQ(sets.received_us.size(), run.sent.ticks);
  EXPECT_GT(run.sent.ticks, 650U) << "the clock's alone are 690 with the poses' end";
  // In order an estimate is published on arrival, and the jitter of arrival is below the margin.
  ASSERT_GT(run.latencies.size(), 80U);
  const auto waiting = std::count_if(run.latencies.begin() + 10, run.latencies.end(),
                                     [](const FrameToCan& l) { return l.sampling > Duration{}; });
  EXPECT_EQ(waiting, 0);
}

TEST(TickReleasesOfAHiddenTool, AreTheClocksAlone) {
  const auto ticks = [](Cell cell) {
    TemporaryFolder folder;
    cell.tools_at_start = 0;  // the pen is not searched: no frame measures it
    return short_run(cell, folder.path()).ticks;
  };
  EXPECT_EQ(ticks(short_by_estimates(0.6)), ticks(short_cell(0.6)));
}

class ReplayOfReleases : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(AtEveryLevel, ReplayOfReleases, testing::Values("full", "roi", "blobs"),
                         [](const auto& level) { return std::string(level.param); });

TEST_P(ReplayOfReleases, GivesTheRunsBytes) {
  TemporaryFolder folder;
  const SessionResult run = short_run(short_by_estimates(1.5, GetParam()), folder.path());
  ASSERT_TRUE(run.recording.complete());
  for (const int workers : {1, 2}) {
    EXPECT_GT(expect_same_bytes(run.recording_file, run, workers).records, 400);
  }
}

TEST(TickReleases, NeedABusThatCarriesASetEachShortestGap) {
  TemporaryFolder folder;
  Cell cell = short_by_estimates(0.1);
  cell.can.bit_rate = 250'000;
  const auto refusal = [&]() -> std::string {
    try {
      (void)short_run(cell, folder.path());
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(refusal().find("1 tool at 400 Hz in classic frames need 10"), std::string::npos)
      << refusal();
  EXPECT_NE(refusal().find("or rates.tick_release = \"clock\""), std::string::npos) << refusal();
  cell.tick_release = TickRelease::clock;
  EXPECT_EQ(refusal(), "accepted");
}

}  // namespace
}  // namespace glint

// The background group of a run: its slices in real time, and that nothing which leaves a session
// depends on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "platform/budget/export/trace_file.hpp"
#include "platform/input_error.hpp"
#include "platform/rt/clock.hpp"
#include "platform/session/background_group.hpp"
#include "platform/session/replay.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

Cell with_background(Cell cell, Duration period, int steps) {
  cell.background = BackgroundSettings{period, steps};
  return cell;
}

BackgroundCounts counted_for(Duration time, Duration period, int steps) {
  const Cell cell = with_background(default_cell(), period, steps);
  const RunPlan plan = plan_by_rule(cell);
  BackgroundGroup group(cell, *plan.background, nullptr);
  std::atomic<bool> stop{false};
  const Time epoch = monotonic_now();
  RealTimeThread thread(BackgroundGroup::thread_settings(*plan.background),
                        [&] { group.run(epoch, stop); });
  sleep_until(epoch + time);
  stop = true;
  thread.join();
  return group.counts();
}

TEST(BackgroundGroup, RunsOneSliceAPeriodAndSkipsWhatItDidNotReach) {
  const BackgroundCounts counts = counted_for(milliseconds(200), milliseconds(10), 100);
  EXPECT_GE(counts.slices, 1u);
  EXPECT_LE(counts.slices, 22u);
  EXPECT_GE(counts.slices + counts.skipped, 19u);  // all releases of that time
  EXPECT_GT(counts.longest_response.nanoseconds, 0);
}

// 50,000 steps, each of which needs the one before, take longer than 20 us anywhere.
TEST(BackgroundGroup, CountsAsSkippedWhatComesWhileASliceStillRuns) {
  const BackgroundCounts counts = counted_for(milliseconds(50), microseconds(20), 50'000);
  EXPECT_EQ(counts.late, counts.slices);
  EXPECT_GE(counts.skipped, counts.slices);
}

TEST(BackgroundGroup, EndsSoonAfterItIsToldHoweverLongItsPeriod) {
  const Time begin = monotonic_now();
  const BackgroundCounts counts = counted_for(milliseconds(10), milliseconds(1000), 1);
  EXPECT_EQ(counts.slices, 1u);
  EXPECT_LT(monotonic_now() - begin, milliseconds(700));
}

TEST(BackgroundRun, InOrderGivesTheSameBytesWithAndWithoutOne) {
  const TemporaryFolder plain, with;
  const Cell cell = short_cell(0.5);
  const SessionResult one = short_run(cell, plain.path());
  const SessionResult other =
      short_run(with_background(cell, milliseconds(10), 50'000), with.path());
  EXPECT_EQ(one.output_sha256, other.output_sha256);
  EXPECT_FALSE(other.background);
}

TEST(BackgroundRun, LiveRunsItsSlicesTracesThemAndReplaysToTheSameHash) {
  const TemporaryFolder folder;
  Cell cell = with_background(short_cell(1.0), milliseconds(20), 1'000);
  cell.text += "\n[background]\nperiod_ms = 20\nsteps = 1000\n";
  cell.realtime = true;
  cell.dds.on = false;
  SessionOptions options;
  options.out = folder.path();
  options.trace = true;
  const SessionResult run = run_session(cell, options);
  ASSERT_TRUE(run.background);
  EXPECT_GE(run.background->slices, 1u);
  EXPECT_GE(run.background->slices + run.background->skipped, 45u);
  const TraceFile trace = read_trace(folder.path() + "/trace.spans");
  ASSERT_EQ(trace.groups.size(), 3u);
  EXPECT_EQ(trace.groups[2].name, "background");
  EXPECT_EQ(trace.groups[2].nodes, std::vector<std::string>{"BackgroundSlice"});
  const auto slices =
      std::count_if(trace.spans.begin(), trace.spans.end(),
                    [](const TraceSpan& span) { return span.group == 2 && is_node(span); });
  EXPECT_EQ(static_cast<std::uint64_t>(slices), run.background->slices);
  EXPECT_EQ(replay(run.recording_file, {}).output_sha256, run.output_sha256);
}

// A plan of three groups as the tracker's task model has them, all on one core but the background.
TEST(BackgroundRun, TakesItsCorePriorityAndBoundsFromAPlan) {
  const Cell cell = with_background(default_cell(), milliseconds(20), 1'000);
  Plan plan;
  TaskModel model;
  plan.cores = model.cores = 2;
  const auto add = [&](const char* name, int nodes, int core, int priority) {
    const auto g = static_cast<int>(plan.groups.size());
    model.groups.emplace_back().nodes.resize(static_cast<std::size_t>(nodes));
    plan.groups.push_back({name, priority, 10 * nodes, 0, false});
    for (int n = 0; n < nodes; ++n) {
      model.groups.back().nodes[static_cast<std::size_t>(n)].bound_ns = 10;
      plan.nodes.push_back({g, n, core, 10 * n, 10 * n + 10});
    }
  };
  add("frame", Tracker::node_count, 0, 45);
  add("tick", Output::node_count, 0, 48);
  EXPECT_FALSE(plan_of(plan, model, "plan.toml").background);
  add("background", Background::node_count, 1, 42);
  const RunPlan run = plan_of(plan, model, "plan.toml");
  ASSERT_TRUE(run.background);
  EXPECT_EQ(run.background->cores, std::vector<int>{1});
  EXPECT_EQ(run.background->priority, 42);
  EXPECT_EQ(run.background->bounds_ns, std::vector<std::int64_t>{10});
  const ThreadSettings thread = BackgroundGroup::thread_settings(*run.background);
  EXPECT_EQ(thread.core, 1);
  EXPECT_EQ(thread.priority, 42);
  EXPECT_TRUE(thread.idle_otherwise);
  EXPECT_FALSE(plan_by_rule(default_cell()).background);
}

}  // namespace
}  // namespace glint

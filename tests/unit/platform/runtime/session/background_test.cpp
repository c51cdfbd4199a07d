// Background group of a run: its slices in real time and in simulated order, the map that it
// builds, and the independence of the session's outputs from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "platform/budget/export/trace_file.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/session/background_group.hpp"
#include "platform/runtime/session/replay.hpp"
#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/depth_png.hpp"
#include "platform/tools/mapping/map_chain.hpp"
#include "tests/unit/platform/runtime/session/depth_folder.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

Cell with_background(Cell cell, Duration period, int steps) {
  cell.background = BackgroundSettings{period, steps};
  return cell;
}

// Maps the folder's depth images, one slice every 0.25 ms.
Cell with_mapping(Cell cell, const DepthFolder& folder) {
  cell = with_background(std::move(cell), microseconds(250), k_background_steps_max);
  cell.mapping.emplace();
  cell.mapping->source = folder.path;
  cell.mapping->period = milliseconds(50);
  cell.mapping->images_per_map = 4;
  cell.mapping->voxel_m = 0.02;
  cell.mapping->voxels_max = 20'000;
  return cell;
}

BackgroundCounts counted_for(Duration time, Duration period, int steps) {
  Cell cell = with_background(default_cell(), period, steps);
  cell.mapping.emplace().voxels_max = 20'000;
  const RunSchedule plan = schedule_by_rule(cell);
  const TemporaryFolder pictures;
  DepthFolder folder(pictures.path());
  folder.add_scene(2);
  BackgroundGroup group(cell, *plan.background, nullptr,
                        {{load_depth_sequence(folder.path), microseconds(1)}, {}, {}});
  std::atomic<bool> stop{false};
  const Time epoch = monotonic_now();
  RealTimeThread thread(BackgroundGroup::thread_settings(*plan.background),
                        [&] { group.run(epoch, stop); });
  (void)sleep_until(epoch + time);
  stop = true;
  thread.join();
  return group.counts();
}

TEST(BackgroundGroup, RunsOneSliceAPeriodAndSkipsWhatItDidNotReach) {
  constexpr Duration k_period = milliseconds(10);
  const Time begin = monotonic_now();
  const BackgroundCounts counts = counted_for(milliseconds(200), k_period, 100);
  const Duration most = monotonic_now() - begin;  // a busy machine ends the thread late
  EXPECT_GE(counts.slices, 1u);
  EXPECT_LE(counts.slices, static_cast<std::uint64_t>(most.nanoseconds / k_period.nanoseconds) + 1);
  EXPECT_GE(counts.slices + counts.skipped, 19u);  // all releases in that time
  EXPECT_GT(counts.longest_response.nanoseconds, 0);
}

// A slice with work takes more than 100 ns.
TEST(BackgroundGroup, CountsAsSkippedWhatComesWhileASliceStillRuns) {
  const BackgroundCounts counts = counted_for(milliseconds(50), {100}, 50'000);
  EXPECT_EQ(counts.late, counts.slices);
  EXPECT_GE(counts.skipped, counts.slices);
  EXPECT_GT(counts.longest_steps, 40'000);
  EXPECT_LE(counts.longest_steps, 50'000 + k_map_item_steps_max);
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
  EXPECT_FALSE(one.background);
  ASSERT_TRUE(other.background);
  EXPECT_GE(other.background->slices, 50u);
  EXPECT_EQ(other.background->map.pictures, 0);
}

// In simulated order every run executes the same slices; the map equals the serial chain's.
TEST(BackgroundRun, InOrderMakesTheMapThatTheChainMakesOfTheSamePictures) {
  const TemporaryFolder plain, first, again, pictures;
  DepthFolder folder(pictures.path());
  folder.add_scene(3);
  const Cell cell = with_mapping(short_cell(0.5), folder);
  const SessionResult without = short_run(short_cell(0.5), plain.path());
  const SessionResult one = short_run(cell, first.path());
  const SessionResult two = short_run(cell, again.path());
  EXPECT_EQ(one.output_sha256, without.output_sha256);
  EXPECT_EQ(two.output_sha256, without.output_sha256);
  ASSERT_TRUE(one.background && two.background);
  const BackgroundCounts& counts = *one.background;
  EXPECT_EQ(counts.slices, two.background->slices);
  EXPECT_EQ(counts.longest_steps, two.background->longest_steps);
  EXPECT_EQ(counts.late + counts.skipped, 0u);
  EXPECT_GE(counts.map.pictures, 6);
  EXPECT_GE(counts.map.maps, 2);
  EXPECT_GE(counts.map.planes, 2);
  EXPECT_EQ(counts.map.pictures + counts.images_missed,
            two.background->map.pictures + two.background->images_missed);

  const HostCloud map = read_cloud(first.path() + "/map.ply");
  const HostCloud same = read_cloud(again.path() + "/map.ply");
  EXPECT_EQ(map.points, same.points);
  EXPECT_EQ(map.normals, same.normals);
  EXPECT_EQ(static_cast<int>(map.points.size()), counts.map.smoothed);
  // Reference: the images forward and backward, as many as were shown.
  ASSERT_EQ(counts.images_missed, 0);
  MapChain chain(map_settings_of(cell));
  const DepthLoop loop(load_depth_sequence(folder.path), cell.mapping->period);
  for (std::int64_t n = 1; n <= counts.map.pictures; ++n) {
    const DepthFrame& frame = loop.image(n);
    chain.add_frame(frame.picture(), loop.camera(), frame.T_world_camera);
  }
  chain.finish();
  chain.project_onto_planes();
  EXPECT_EQ(counts.map.left_out, 0);
  EXPECT_EQ(host_cloud_of(chain.map()).points, map.points);
}

TEST(BackgroundRun, LeavesThePenOutOfItsMap) {
  const TemporaryFolder out, pictures;
  DepthFolder folder(pictures.path());
  // Walls in front of and behind the pen of the default scenario, which is 0.63 m from here.
  for (const double z : {0.55, 0.6, 0.65, 0.7}) {
    folder.add(
        std::vector<float>(DepthFolder::k_width * DepthFolder::k_height, static_cast<float>(z)),
        {Quaternion::Identity(), Vector3(0.467, 0, -1)});
  }
  Cell cell = with_mapping(short_cell(1.0), folder);
  const SessionResult run = short_run(cell, out.path());
  EXPECT_GT(run.accuracy.tracked_fraction(), 0.9);
  EXPECT_GT(run.background->map.left_out, 100);
}

TEST(BackgroundRun, LiveRunsItsSlicesTracesThemAndReplaysToTheSameHash) {
  const TemporaryFolder folder;
  const TemporaryFolder pictures;
  DepthFolder room(pictures.path());
  room.add_scene(2);
  Cell cell = with_mapping(short_cell(1.0), room);
  cell.text += "\n[background]\nperiod_ms = 2\n[mapping]\nsource = \"nowhere\"\n";
  cell.realtime = true;
  cell.dds.on = false;
  SessionOptions options;
  options.out = folder.path();
  options.trace = true;
  const SessionResult run = run_simulated(cell, options);
  ASSERT_TRUE(run.background);
  EXPECT_GE(run.background->slices, 1u);
  EXPECT_GE(run.background->slices + run.background->skipped, 3'600u);
  EXPECT_GE(run.background->map.pictures, 1);
  EXPECT_GT(read_cloud(folder.path() + "/map.ply").points.size(), 100u);
  const TraceFile trace = read_trace(folder.path() + "/trace.spans");
  ASSERT_EQ(trace.groups.size(), 3u);
  EXPECT_EQ(trace.groups[2].name, "background");
  EXPECT_EQ(trace.groups[2].nodes, (std::vector<std::string>{"ExtendMap", "FollowRobot"}));
  const auto slices =
      std::count_if(trace.spans.begin(), trace.spans.end(),
                    [](const TraceSpan& span) { return span.group == 2 && is_node(span); });
  EXPECT_EQ(static_cast<std::uint64_t>(slices), 2 * run.background->slices);
  EXPECT_EQ(replay(run.recording_file, {}).output_sha256, run.output_sha256);
}

// Schedule of the tracker's three groups: all on one core except the background group.
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
  EXPECT_FALSE(schedule_of(plan, model, "plan.toml").background);
  add("background", Background::node_count, 1, 42);
  const RunSchedule run = schedule_of(plan, model, "plan.toml");
  ASSERT_TRUE(run.background);
  EXPECT_EQ(run.background->cores, std::vector<int>{1});
  EXPECT_EQ(run.background->priority, 42);
  EXPECT_EQ(run.background->bounds_ns, (std::vector<std::int64_t>{10, 10}));
  const ThreadSettings thread = BackgroundGroup::thread_settings(*run.background);
  EXPECT_EQ(thread.core, 1);
  EXPECT_EQ(thread.priority, 42);
  EXPECT_TRUE(thread.idle_if_refused);
  EXPECT_FALSE(schedule_by_rule(default_cell()).background);
}

}  // namespace
}  // namespace glint

// Status of a late or predicted-late tick as DDS readers receive it: exactly one per tick, with the
// substitute's reason; or none, which the next status counts.
#include <map>
#include <memory>

#include "nodes/overrun_effects.hpp"
#include "platform/runtime/session/tick_group.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {
namespace {

using graph::OverrunPolicy;

constexpr std::uint32_t k_first = 26, k_last = 33;
constexpr std::uint32_t k_missed = 28, k_will_miss = 31;
constexpr Time k_taken = Time{} + milliseconds(100);

// The pen as seen in frame 5, 4 ms before the first tick, moving along x at 0.1 m/s.
Estimates seen_pen() {
  Estimates estimates;
  estimates.tool_count = 1;
  estimates.tips.fill({});
  Track& track = estimates.tracks[0];
  track.alive = track.measured_now = track.has_previous = true;
  track.reason = Reason::none;
  track.base = ReferenceFrame::world;
  track.frame_sequence = 5;
  track.newest.time = k_taken;
  track.newest.pose.translation = Vector3(0.002, 0, 0.5);
  track.previous.time = k_taken - milliseconds(20);
  track.previous.pose.translation = Vector3(0, 0, 0.5);
  track.motion.time = k_taken;
  track.motion.pose = track.newest.pose;
  track.motion.velocity_m_s = Vector3(0.1, 0, 0);
  return estimates;
}

// No clock: the time within a tick is injected.
RunnerSettings<Output> late_twice(const Cell& cell) {
  RunnerSettings<Output> settings;
  settings.live = false;
  settings.watch.on = true;
  settings.watch.deadline = cell.deadlines.tick;
  settings.watch.policy = cell.overrun.tick;
  settings.watch.remaining_ns = {1'000'000, 0};
  settings.injections = {{"", 1, true, k_missed, cell.deadlines.tick + Duration{1}, false},
                         {"", 0, true, k_will_miss, cell.deadlines.tick, false}};
  return settings;
}

class OverrunStatus : public DdsTest, public testing::WithParamInterface<OverrunPolicy> {};

TEST_P(OverrunStatus, SaysOnceWhatLeftInPlaceOfATickThatWasNotInTime) {
  Cell cell = default_cell();
  cell.overrun.tick = GetParam();
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(status_type(), topics_of("glint", "pen").status,
                                          Reliability::reliable, Durability::volatile_data, 100);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();

  GroupRunner<Output> runner(late_twice(cell));
  graph::TripleBuffer<Estimates> estimates;
  estimates.write_slot() = seen_pen();
  estimates.publish(1, 0);
  graph::TripleBuffer<RobotFrame> robot;
  graph::TripleBuffer<PenButtons> buttons;
  OverrunNotes notes;
  Time now;
  TickSinks sinks;
  sinks.dds = &sink;
  const auto group = std::make_unique<TickGroup>(
      cell, estimates, robot, buttons, [&now] { return now; }, sinks, 0, 1, runner, notes);
  for (std::uint32_t tick = k_first; tick <= k_last; ++tick) {
    now = Time{} + k_period * tick;
    group->tick(tick, now, now);
  }
  EXPECT_EQ(runner.overruns().missed, 1u);
  EXPECT_EQ(runner.overruns().will_miss, 1u);
  sink.stop();

  const bool skips = GetParam() == OverrunPolicy::skip_output;
  const std::uint32_t ticks = k_last - k_first + 1;
  std::map<std::uint32_t, StatusMessage> found;
  EXPECT_EQ(take<StatusMessage>(reader, ticks + 1 - (skips ? 2 : 0),
                                [&](const StatusMessage& message) {
                                  if (!message.ends_stream) found[message.tick_number] = message;
                                }),
            ticks + 1 - (skips ? 2 : 0));
  for (std::uint32_t tick = k_first; tick <= k_last; ++tick) {
    SCOPED_TRACE("tick " + std::to_string(tick));
    const bool late = tick == k_missed || tick == k_will_miss;
    ASSERT_EQ(found.count(tick), late && skips ? 0u : 1u);
    if (found.count(tick) == 0) continue;
    const StatusMessage& status = found.at(tick);
    const int skipped = (tick > k_missed ? 1 : 0) + (tick > k_will_miss ? 1 : 0);
    EXPECT_EQ(status.ticks_not_sent, skips ? static_cast<std::uint64_t>(skipped) : 0u);
    EXPECT_EQ(time_of(status.header.stamp), Time{} + k_clock_start + k_period * tick);
    EXPECT_EQ(time_of(status.measurement), k_taken + k_clock_start) << "older, never renewed";
    EXPECT_EQ(status.frame_sequence, 5u);
    const TrackState state = !late                                    ? TrackState::measured
                             : GetParam() == OverrunPolicy::stop_safe ? TrackState::lost
                                                                      : TrackState::predicted;
    EXPECT_EQ(status.state, static_cast<std::uint8_t>(state));
    // A tick in time has no pose of the robot: the robot's frame is unknown here.
    const Reason reason = late ? reason_of(GetParam()) : Reason::no_reference;
    EXPECT_EQ(status.reason, static_cast<std::uint8_t>(reason));
  }
}

INSTANTIATE_TEST_SUITE_P(ByEveryPolicy, OverrunStatus,
                         testing::Values(OverrunPolicy::skip_output, OverrunPolicy::hold_last,
                                         OverrunPolicy::predict, OverrunPolicy::stop_safe),
                         [](const auto& policy) { return std::string(name_of(policy.param)); });

}  // namespace
}  // namespace glint

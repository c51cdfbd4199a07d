// Timing fields as readers receive them: exposure time, publication time and validity of a pose;
// overruns and losses.
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "platform/runtime/rt/source_faults.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "tests/unit/platform/sinks/dds/diagnostic_entry.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {
namespace {

using TimingFields = DdsTest;

const ToolTopics pen = topics_of("glint", "pen");

Time unix_of(Time board) { return board + k_clock_start; }

dds_entity_t status_reader(Peer& peer) {
  return peer.reader(status_type(), pen.status, Reliability::reliable, Durability::volatile_data,
                     100);
}

TEST(Stamps, AreSecondsAndNanosecondsOfUnixTimeAndTheNearestThatFitBeyond) {
  const auto parts = [](std::int64_t ns) {
    const TimeMessage stamp = time_message({ns});
    return std::pair{stamp.sec, stamp.nanosec};
  };
  EXPECT_EQ(parts(1'700'000'000'123'456'789), (std::pair{1'700'000'000, 123'456'789U}));
  EXPECT_EQ(parts(999'999'999), (std::pair{0, 999'999'999U}));
  EXPECT_EQ(parts(-1), (std::pair{0, 0U}));
  EXPECT_EQ(parts(INT64_MAX), (std::pair{INT32_MAX, 999'999'999U}));
  const Time time{1'699'999'999'999'999'999};
  EXPECT_EQ(time_of(time_message(time)), time);
}

TEST_F(TimingFields, TellOfEachTickWhenItWasReleasedAndWhenItsFrameWasTaken) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = status_reader(peer);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  for (std::uint32_t tick = 3; tick < 8; ++tick) sink.offer(sample_at(tick));
  std::uint32_t tick = 3;
  EXPECT_EQ(take<StatusMessage>(reader, 5,
                                [&](const StatusMessage& message) {
                                  const PoseSample sample = sample_at(tick++);
                                  EXPECT_EQ(time_of(message.header.stamp), unix_of(sample.tick));
                                  EXPECT_EQ(time_of(message.measurement),
                                            unix_of(sample.measurement));
                                  EXPECT_EQ(message.tick_number, sample.tick_number);
                                  EXPECT_EQ(message.frame_sequence, sample.frame_sequence);
                                  EXPECT_EQ(message.tick_period_ns, k_period.nanoseconds);
                                  EXPECT_EQ(message.ticks_not_sent, 0u);
                                }),
            5u);
}

TEST_F(TimingFields, GiveThePoseItsCovarianceAndItsTransformTheTimeForWhichTheyHold) {
  DdsSettings settings = test_settings();
  settings.actuation_delay = microseconds(6500);
  DdsSink sink(settings);
  Peer peer(settings);
  const auto reader = [&](const TopicType& type, const std::string& topic) {
    return peer.reader(type, topic, Reliability::reliable, Durability::volatile_data, 10);
  };
  const dds_entity_t status = status_reader(peer), pose = reader(pose_stamped_type(), pen.pose),
                     covariance = reader(pose_covariance_type(), pen.pose_covariance),
                     tf = reader(tf_type(), k_tf_topic);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  const PoseSample sample = sample_at(9);
  sink.offer(sample);
  const Time holds = unix_of(sample.tick + settings.actuation_delay);
  EXPECT_EQ(take<PoseStampedMessage>(
                pose, 1, [&](const auto& m) { EXPECT_EQ(time_of(m.header.stamp), holds); }),
            1u);
  EXPECT_EQ(take<PoseCovarianceMessage>(
                covariance, 1, [&](const auto& m) { EXPECT_EQ(time_of(m.header.stamp), holds); }),
            1u);
  EXPECT_EQ(take<TfMessage>(tf, 1,
                            [&](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 1u);
                              EXPECT_EQ(time_of(message.transforms._buffer[0].header.stamp), holds);
                            }),
            1u);
  EXPECT_EQ(take<StatusMessage>(status, 1,
                                [&](const StatusMessage& message) {
                                  EXPECT_EQ(time_of(message.header.stamp), unix_of(sample.tick))
                                      << "the release, without the delay";
                                }),
            1u);
}

TEST_F(TimingFields, HaveNoMeasurementsTimeBeforeAnythingWasMeasuredAndKeepItOnceLost) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = status_reader(peer);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  PoseSample nothing;
  nothing.tick = Time{} + k_period;
  nothing.tick_number = 1;
  sink.offer(nothing);
  sink.offer(lost_sample_at(2));
  std::vector<std::int64_t> measured;
  EXPECT_EQ(take<StatusMessage>(reader, 2,
                                [&](const StatusMessage& message) {
                                  measured.push_back(time_of(message.measurement).nanoseconds);
                                }),
            2u);
  EXPECT_EQ(measured,
            (std::vector<std::int64_t>{0, unix_of(lost_sample_at(2).measurement).nanoseconds}));
}

TEST_F(TimingFields, CountTheTicksThatWereSkippedAndCloseTheStreamOnePeriodOn) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = status_reader(peer);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  for (const std::uint32_t tick : {5, 6, 9, 10}) sink.offer(sample_at(tick));
  sink.stop();
  std::map<std::uint32_t, std::uint64_t> not_sent;
  EXPECT_EQ(take<StatusMessage>(reader, 5,
                                [&](const StatusMessage& message) {
                                  not_sent[message.tick_number] = message.ticks_not_sent;
                                  EXPECT_EQ(message.ends_stream, message.tick_number == 11);
                                  EXPECT_EQ(time_of(message.header.stamp),
                                            unix_of(Time{} + k_period * message.tick_number));
                                  EXPECT_EQ(time_of(message.stream_start),
                                            unix_of(Time{} + k_period * 5));
                                }),
            5u);
  EXPECT_EQ(not_sent,
            (std::map<std::uint32_t, std::uint64_t>{{5, 0}, {6, 0}, {9, 2}, {10, 2}, {11, 2}}));
}

DiagnosticEntry diagnostic_entry(const DdsSettings& settings, const std::string& name) {
  DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(diagnostics_type(), k_diagnostics_topic,
                                          Reliability::reliable, Durability::volatile_data, 10);
  EXPECT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  DiagnosticEntry found;
  (void)take<DiagnosticsMessage>(
      reader, 1, [&](const DiagnosticsMessage& message) { found = entry_of(message, name); });
  return found;
}

TEST_F(TimingFields, SayInDiagnosticsWhatWasLateAndWhatIsBestEffort) {
  constexpr int ok = 0, warn = 1;
  const std::string refused = "glint-tick: SCHED_FIFO was refused";
  const struct {
    std::uint64_t frame, tick;
    std::string timing_faults;
    int level;
    std::string message;
  } cases[] = {{0, 0, "", ok, "in time"},
               {0, 0, refused, warn, "best effort"},
               {3, 0, "", warn, "overruns"},
               {0, 7, refused, warn, "overruns"}};
  for (const auto& expected : cases) {
    OverrunCounters overruns;
    overruns.frame = expected.frame;
    overruns.tick = expected.tick;
    DdsSettings settings = test_settings();
    settings.overruns = &overruns;
    settings.timing_faults = expected.timing_faults;
    const DiagnosticEntry found = diagnostic_entry(settings, "glint: timing");
    EXPECT_EQ(found.level, expected.level);
    EXPECT_EQ(found.message, expected.message);
    EXPECT_EQ(found.values, (std::map<std::string, std::string>{
                                {"overruns_frame", std::to_string(expected.frame)},
                                {"overruns_tick", std::to_string(expected.tick)},
                                {"ticks_source_late", "0"},
                                {"best_effort", expected.timing_faults}}));
  }
}

TEST_F(TimingFields, SayInDiagnosticsThatTheRobotWasSeenElsewhereAndHowFar) {
  RobotTrackingStatus robot;
  DdsSettings settings = test_settings();
  EXPECT_EQ(diagnostic_entry(settings, "glint: robot").level, -1);
  settings.robot = &robot;
  EXPECT_EQ(diagnostic_entry(settings, "glint: robot").message, "not yet detected");
  robot.followed = 12;
  const DiagnosticEntry followed = diagnostic_entry(settings, "glint: robot");
  EXPECT_EQ(followed.level, 0);
  EXPECT_EQ(followed.message, "followed");
  robot.jumps = 3;
  robot.inconclusive = 2;
  robot.translation_m = 0.0312;
  robot.rotation_rad = 0.035;
  robot.jumped = true;
  const DiagnosticEntry jumped = diagnostic_entry(settings, "glint: robot");
  EXPECT_EQ(jumped.level, 1);
  EXPECT_EQ(jumped.message,
            "detected 31.2 mm and 2.0 deg from its stored pose, rejected; stop, check what moved, "
            "run glint reference");
  EXPECT_EQ(jumped.values.at("followed"), "12");
  EXPECT_EQ(jumped.values.at("jumps_refused"), "3");
  EXPECT_EQ(jumped.values.at("unsure"), "2");
  EXPECT_EQ(jumped.values.at("jump_mm"), "31.200000");
  EXPECT_NEAR(std::stod(jumped.values.at("jump_deg")), 2.0054, 1e-3);
  robot.jumped = false;  // detected again at its expected pose
  EXPECT_EQ(diagnostic_entry(settings, "glint: robot").level, 0);
}

TEST_F(TimingFields, SayInDiagnosticsWhatWasLost) {
  LossCounters losses;
  DdsSettings settings = test_settings();
  settings.losses = &losses;
  const DiagnosticEntry none = diagnostic_entry(settings, "glint: losses");
  EXPECT_EQ(none.level, 0);
  EXPECT_EQ(none.message, "none");
  losses.store(LossKind::recording, 12072);
  losses.store(LossKind::can, 3);
  const DiagnosticEntry lost = diagnostic_entry(settings, "glint: losses");
  EXPECT_EQ(lost.level, 2);
  EXPECT_EQ(lost.message, "lost: CAN 3, recording 12072");
  EXPECT_EQ(lost.values.at("recording"), "12072");
  EXPECT_EQ(lost.values.at("files"), "0");
}

TEST_F(TimingFields, NameAFaultOfTheSourceAtOnce) {
  SourceFaults faults(milliseconds(20));
  DdsSettings settings = test_settings();
  settings.source = &faults;
  DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(diagnostics_type(), k_diagnostics_topic,
                                          Reliability::reliable, Durability::volatile_data, 1000);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  DiagnosticEntry found;
  const auto receive_until = [&](const char* key, int count) {
    do {
      ASSERT_EQ(take<DiagnosticsMessage>(
                    reader, 1, [&](const auto& m) { found = entry_of(m, "glint: source"); }),
                1u);
    } while (found.values.at(key) != std::to_string(count));
  };
  receive_until("connection lost", 0);
  EXPECT_EQ(found.message, "frames arrive");
  EXPECT_EQ(found.level, 0);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 1; i <= 20; ++i) {
    faults.note(SourceFault::connection_lost, Time{});
    receive_until("connection lost", i);
    EXPECT_EQ(found.message, "connection lost");
    EXPECT_EQ(found.level, 1);
  }
  // The regular ones, one a second, would take 20 s.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  faults.note_frame(Time{} + milliseconds(1000));
  faults.check_silence(Time{} + milliseconds(1034));
  receive_until("no frame", 1);
  EXPECT_EQ(found.message, "no frame");
  EXPECT_EQ(found.level, 2);
}

TEST_F(TimingFields, SayInDiagnosticsThatTheSourceIsTooSlow) {
  OverrunCounters counters;
  DdsSettings settings = test_settings();
  settings.overruns = &counters;
  counters.source = 7;
  const DiagnosticEntry late = diagnostic_entry(settings, "glint: timing");
  EXPECT_EQ(late.level, 1);
  EXPECT_EQ(late.message, "source too slow");
  EXPECT_EQ(late.values.at("ticks_source_late"), "7");
}

TEST_F(TimingFields, SayInDiagnosticsThatTheRobotsJointsAreNoLongerHeard) {
  RobotTrackingStatus robot;
  DdsSettings settings = test_settings();
  settings.robot = &robot;
  robot.skipped_without_joints = 4;
  robot.joints_lost = true;
  const DiagnosticEntry lost = diagnostic_entry(settings, "glint: robot");
  EXPECT_EQ(lost.level, 1);
  EXPECT_EQ(lost.message, "not tracked: joint states are too old; check the robot's driver");
  EXPECT_EQ(lost.values.at("without_joints"), "4");
  robot.jumped = true;
  const std::string both = diagnostic_entry(settings, "glint: robot").message;
  EXPECT_EQ(both.rfind("detected 0.0 mm", 0), 0u) << both;
  EXPECT_NE(both.find("; " + lost.message), std::string::npos) << both;
  robot.jumped = false;
  robot.joints_lost = false;
  EXPECT_EQ(diagnostic_entry(settings, "glint: robot").level, 0);
}

}  // namespace
}  // namespace glint

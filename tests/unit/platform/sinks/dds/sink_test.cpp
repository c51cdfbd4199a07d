#include "platform/sinks/dds/dds_sink.hpp"

#include <map>
#include <set>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint::sink_test {
namespace {

using Sinks = DdsTest;

const ToolTopics pen = topics_of("glint", "pen");

std::int64_t unix_ns(const TimeMessage& stamp) { return time_of(stamp).nanoseconds; }

void expect_pose(const PoseMessage& message, const Pose& pose) {
  EXPECT_EQ(message.position.x, pose.translation.x());
  EXPECT_EQ(message.position.y, pose.translation.y());
  EXPECT_EQ(message.position.z, pose.translation.z());
  EXPECT_EQ(message.orientation.x, pose.rotation.x());
  EXPECT_EQ(message.orientation.y, pose.rotation.y());
  EXPECT_EQ(message.orientation.z, pose.rotation.z());
  EXPECT_EQ(message.orientation.w, pose.rotation.w());
}

TEST_F(Sinks, PublishThePoseStampedForTheTimeItIsValidFor) {
  DdsSettings settings = test_settings();
  settings.actuation_delay = milliseconds(7);
  DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(pose_stamped_type(), pen.pose, Reliability::reliable,
                                          Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  const PoseSample sample = sample_at(3);
  EXPECT_TRUE(sink.offer(sample));
  EXPECT_EQ(take<PoseStampedMessage>(reader, 1,
                                     [&](const PoseStampedMessage& message) {
                                       EXPECT_STREQ(message.header.frame_id, "robot_base");
                                       EXPECT_EQ(unix_ns(message.header.stamp),
                                                 k_clock_start.nanoseconds + 19'000'000);
                                       expect_pose(message.pose, sample.pose);
                                     }),
            1u);
}

TEST_F(Sinks, PublishTheCovarianceRowByRow) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(pose_covariance_type(), pen.pose_covariance,
                                          Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  const PoseSample sample = sample_at(3);
  sink.offer(sample);
  EXPECT_EQ(take<PoseCovarianceMessage>(reader, 1,
                                        [&](const PoseCovarianceMessage& message) {
                                          expect_pose(message.pose.pose, sample.pose);
                                          EXPECT_EQ(message.pose.covariance[1], 1.0);
                                          EXPECT_EQ(message.pose.covariance[6], 10.0);
                                          EXPECT_EQ(message.pose.covariance[35], 55.0);
                                        }),
            1u);
}

TEST_F(Sinks, PublishTheSystematicPartByItself) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(pose_covariance_type(), pen.pose_systematic,
                                          Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  PoseSample sample = sample_at(3);
  sample.systematic(0, 1) = 7;
  sink.offer(sample);
  EXPECT_EQ(take<PoseCovarianceMessage>(reader, 1,
                                        [&](const PoseCovarianceMessage& message) {
                                          expect_pose(message.pose.pose, sample.pose);
                                          EXPECT_EQ(message.pose.covariance[1], 7.0);
                                          EXPECT_EQ(message.pose.covariance[35], 0.0);
                                        }),
            1u);
}

TEST_F(Sinks, PublishTheTipAsATransformOfTheFrameThePoseIsIn) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader =
      peer.reader(tf_type(), k_tf_topic, Reliability::reliable, Durability::volatile_data, 100);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  PoseSample sample = sample_at(3);
  sample.frame = ReferenceFrame::world;
  sink.offer(sample);
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [&](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 1u);
                              const TransformMessage& tip = message.transforms._buffer[0];
                              EXPECT_STREQ(tip.header.frame_id, "hmd_world");
                              EXPECT_STREQ(tip.child_frame_id, "glint_pen_tip");
                              EXPECT_EQ(tip.transform.translation.z, sample.pose.translation.z());
                              EXPECT_EQ(tip.transform.rotation.w, 0.5);
                              EXPECT_EQ(tip.transform.rotation.x, -0.5);
                            }),
            1u);
}

TEST_F(Sinks, PublishWhereTheHeadsetIsWhileItKnows) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader =
      peer.reader(tf_type(), k_tf_topic, Reliability::reliable, Durability::volatile_data, 100);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  HeadPose head{Time{} + milliseconds(30), false, {Quaternion::Identity(), Vector3(9, 9, 9)}};
  EXPECT_TRUE(sink.offer_frame({head, false, {}}));
  head.valid = true;
  head.T_world_camera = {Quaternion(0.5, -0.5, 0.5, 0.5), Vector3(1, 2, 3)};
  EXPECT_TRUE(sink.offer_frame({head, false, {}}));
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [&](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 1u);
                              const TransformMessage& seen = message.transforms._buffer[0];
                              EXPECT_STREQ(seen.header.frame_id, "hmd_world");
                              EXPECT_STREQ(seen.child_frame_id, "hmd_tof_optical");
                              EXPECT_EQ(unix_ns(seen.header.stamp),
                                        k_clock_start.nanoseconds + 30'000'000);
                              EXPECT_EQ(seen.transform.translation.z, 3);
                              EXPECT_EQ(seen.transform.rotation.x, -0.5);
                            }),
            1u);
}

TEST_F(Sinks, PublishWhereARobotStandsThatIsOnABodyWithTheHeadset) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader =
      peer.reader(tf_type(), k_tf_topic, Reliability::reliable, Durability::volatile_data, 100);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  const HeadPose head{Time{} + milliseconds(30), true, Pose{}};
  EXPECT_TRUE(sink.offer_frame({head, true, {Quaternion::Identity(), Vector3(4, 5, 6)}}));
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [&](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 2u);
                              const TransformMessage& robot = message.transforms._buffer[1];
                              EXPECT_STREQ(robot.header.frame_id, "hmd_world");
                              EXPECT_STREQ(robot.child_frame_id, "robot_base");
                              EXPECT_EQ(unix_ns(robot.header.stamp),
                                        k_clock_start.nanoseconds + 30'000'000);
                              EXPECT_EQ(robot.transform.translation.z, 6);
                            }),
            1u);
}

TEST_F(Sinks, PublishAStatusAndNoPoseForALostTool) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t poses = peer.reader(pose_stamped_type(), pen.pose, Reliability::reliable,
                                         Durability::volatile_data, 10);
  const dds_entity_t statuses =
      peer.reader(status_type(), pen.status, Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  sink.offer(lost_sample_at(5));
  sink.offer(sample_at(6));
  std::vector<int> states;
  EXPECT_EQ(take<StatusMessage>(statuses, 2,
                                [&](const StatusMessage& message) {
                                  states.push_back(message.state);
                                  EXPECT_EQ(unix_ns(message.stream_start),
                                            k_clock_start.nanoseconds + 20'000'000);
                                  EXPECT_EQ(message.marker_mask, 0b1011);
                                }),
            2u);
  EXPECT_EQ(states, (std::vector<int>{3, 2}));
  std::vector<std::int64_t> stamps;
  EXPECT_EQ(take<PoseStampedMessage>(poses, 1,
                                     [&](const PoseStampedMessage& message) {
                                       stamps.push_back(unix_ns(message.header.stamp));
                                     }),
            1u);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{k_clock_start.nanoseconds + 24'000'000}));
}

TEST_F(Sinks, KeepEachToolOnTopicsOfItsOwn) {
  DdsSettings settings = test_settings();
  settings.tool_names = {"pen", "8700339"};
  DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t first = peer.reader(status_type(), "rt/glint/pen_status",
                                         Reliability::reliable, Durability::volatile_data, 10);
  const dds_entity_t second = peer.reader(status_type(), "rt/glint/tool_8700339_status",
                                          Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  sink.offer(sample_at(1, 0));
  sink.offer(sample_at(1, 1));
  sink.offer(sample_at(2, 1));
  EXPECT_EQ(take<StatusMessage>(second, 2, [](const StatusMessage&) {}), 2u);
  EXPECT_EQ(take<StatusMessage>(first, 1, [](const StatusMessage&) {}), 1u);
}

TEST_F(Sinks, GiveALateListenerAllStaticTransforms) {
  DdsSettings settings = test_settings();
  Pose robot;
  robot.translation = Vector3(0.6, 0, -0.4);
  settings.static_transforms = {{"hmd_world", "robot_base", robot},
                                {"hmd_rig", "hmd_tof_optical", Pose{}}};
  DdsSink sink(settings);
  sink.start();
  sink.offer(sample_at(1));
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                          Durability::transient_local, 100);
  std::set<std::string> children;
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [&](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 2u);
                              EXPECT_EQ(message.transforms._buffer[0].transform.translation.x, 0.6);
                              for (int i = 0; i < 2; ++i) {
                                children.insert(message.transforms._buffer[i].child_frame_id);
                              }
                            }),
            1u);
  EXPECT_EQ(children, (std::set<std::string>{"hmd_tof_optical", "robot_base"}));
}

TEST_F(Sinks, SendALateReaderTheRobotDescription) {
  DdsSettings settings = test_settings();
  settings.robot_description = "<robot name=\"arm\">" + std::string(300'000, ' ') + "</robot>";
  DdsSink sink(settings);
  sink.start();
  sink.offer(sample_at(1));
  Peer peer(settings);
  // As RViz's RobotModel display.
  const dds_entity_t reader = peer.reader(text_type(), "rt/robot_description",
                                          Reliability::reliable, Durability::transient_local, 1);
  EXPECT_EQ(take<TextMessage>(reader, 1,
                              [&](const TextMessage& message) {
                                EXPECT_EQ(message.data, settings.robot_description);
                              }),
            1u);
  sink.stop();
  EXPECT_EQ(sink.counts().lost(), 0u);
}

TEST_F(Sinks, TellWhereARobotThatIsFollowedNowStandsBesideTheOtherStaticTransforms) {
  DdsSettings settings = test_settings();
  Pose robot;
  robot.translation = Vector3(0.6, 0, -0.4);
  settings.static_transforms = {{"hmd_world", "robot_base", robot},
                                {"hmd_rig", "hmd_tof_optical", Pose{}}};
  DdsSink sink(settings);
  robot.translation.x() = 0.7;
  sink.offer_robot(robot);
  sink.start();
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                          Durability::transient_local, 100);
  std::map<std::string, double> transforms_x;
  const auto store_transforms = [&](const TfMessage& message) {
    EXPECT_EQ(message.transforms._length, 2u);
    transforms_x.clear();
    for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
      const auto& one = message.transforms._buffer[i];
      transforms_x[one.child_frame_id] = one.transform.translation.x;
    }
  };
  const std::map<std::string, double> now{{"hmd_tof_optical", 0.0}, {"robot_base", 0.7}};
  // A reader that matches early may receive the previous pose first.
  for (int message = 0; message < 2 && transforms_x != now; ++message)
    EXPECT_GE(take<TfMessage>(reader, 1, store_transforms), 1u);
  EXPECT_EQ(transforms_x, now);
}

TEST_F(Sinks, SayInDiagnosticsWhatIsWrongWithATool) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(diagnostics_type(), k_diagnostics_topic,
                                          Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.offer(lost_sample_at(1));
  sink.start();
  EXPECT_GE(take<DiagnosticsMessage>(reader, 1,
                                     [&](const DiagnosticsMessage& message) {
                                       ASSERT_EQ(message.status._length, 1u);
                                       const auto& entry = message.status._buffer[0];
                                       EXPECT_EQ(entry.level, 2);
                                       EXPECT_STREQ(entry.name, "glint: pen");
                                       EXPECT_STREQ(entry.message, "too_old");
                                       EXPECT_STREQ(entry.values._buffer[0].key, "state");
                                       EXPECT_STREQ(entry.values._buffer[0].value, "lost");
                                     }),
            1u);
}

TEST_F(Sinks, CountWhatAFullRingDropped) {
  DdsSink sink(test_settings());
  std::uint64_t taken = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) taken += sink.offer(sample_at(i)) ? 1 : 0;
  sink.start();
  sink.stop();
  const DdsCounts counts = sink.counts();
  EXPECT_EQ(taken, std::uint64_t{DdsSink::k_ring_capacity});
  EXPECT_EQ(counts.offered, 3000u);
  EXPECT_EQ(counts.written, taken);
  EXPECT_EQ(counts.ring_dropped, 3000u - taken);
  EXPECT_EQ(counts.write_failed, 0u);
}

TEST_F(Sinks, CountEverySampleThatTheyCannotWrite) {
  DdsSink sink(test_settings());
  sink.start();
  EXPECT_FALSE(sink.offer(sample_at(0, 1)));  // there is no tool 1
  sink.offer(sample_at(5));
  sink.offer(sample_at(5));  // repeated tick number
  sink.offer(sample_at(4));
  sink.stop();
  EXPECT_FALSE(sink.offer(sample_at(6)));
  const DdsCounts counts = sink.counts();
  EXPECT_EQ(counts.offered, 5u);
  EXPECT_EQ(counts.written, 1u);
  EXPECT_EQ(counts.write_failed, 2u);
  EXPECT_EQ(counts.ring_dropped, 4u);
}

TEST_F(Sinks, CallAMissingNetworkInterfaceByName) {
  DdsSettings settings = test_settings();
  settings.interface = "nowhere0";
  try {
    DdsSink sink(settings);
    FAIL() << "joined a domain on an interface that is not there";
  } catch (const MissingDevice& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere0"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("expected one of: lo"), std::string::npos);
  }
}

TEST_F(Sinks, RefuseSettingsThatCannotBe) {
  const auto refuses = [](auto change) {
    DdsSettings settings = test_settings();
    change(settings);
    EXPECT_THROW(DdsSink sink(settings), InputError);
  };
  refuses([](DdsSettings& settings) { settings.domain = 233; });
  refuses([](DdsSettings& settings) { settings.domain = -1; });
  refuses([](DdsSettings& settings) { settings.tool_names.clear(); });
  refuses([](DdsSettings& settings) { settings.tool_names.resize(17, "pen"); });
  refuses([](DdsSettings& settings) { settings.tool_names = {"a-b", "a b"}; });
  refuses([](DdsSettings& settings) { settings.tick_period = Duration{}; });
  refuses([](DdsSettings& settings) { settings.peers = {"\"/><evil"}; });
}

TEST_F(Sinks, ShareTheirDomainWithOthersOfTheProcessByTheSameSettings) {
  DdsSettings other = test_settings();
  other.peers = {"127.0.0.2"};
  for (int i = 0; i < 2; ++i) {
    DdsSink sink(test_settings());
    EXPECT_NO_THROW(DdsSink twin(test_settings()));
    EXPECT_THROW(DdsSink stranger(other), InputError);
    sink.start();
    sink.offer(sample_at(1));
    sink.stop();
    EXPECT_EQ(sink.counts().written, 1u);
  }
}

}  // namespace
}  // namespace glint::sink_test

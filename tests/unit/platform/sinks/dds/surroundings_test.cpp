// Map, octomap and path as another participant receives them, also one that joins late.
#include "platform/sinks/dds/surroundings_publisher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "platform/sinks/dds/topic_types.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/dds/wire.hpp"

namespace glint::surroundings_test {
namespace {

using Surroundings = DdsTest;
constexpr Time k_now{1'700'000'000'250'000'000};

std::vector<std::array<float, 3>> ramp(std::size_t count, float from) {
  std::vector<std::array<float, 3>> triples;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = from + static_cast<float>(i);
    triples.push_back({x, -x, 0.5f});
  }
  return triples;
}

dds_entity_t late_reader(Peer& peer, const TopicType& type, const std::string& topic, int depth) {
  return peer.reader(type, topic, Reliability::reliable, Durability::transient_local, depth);
}

// The map is published before its reader exists.
TEST_F(Surroundings, GiveALateListenerAllOfACloudInPieces) {
  MapPublisher publisher(test_settings());
  const auto points = ramp(10'000, 0), normals = ramp(10'000, 0.25f);
  EXPECT_EQ(publisher.publish_cloud(points, normals, k_now), 0u);
  Peer peer(test_settings());
  const dds_entity_t reader = late_reader(peer, cloud_type(), "rt/glint/map_points", 100);
  std::vector<std::array<float, 6>> received;
  const std::size_t pieces = 4;  // 2,688 points with normals fit in 64 kB
  EXPECT_EQ(take<CloudMessage>(reader, pieces,
                               [&](const CloudMessage& m) {
                                 EXPECT_STREQ(m.header.frame_id, "hmd_world");
                                 EXPECT_EQ(time_of(m.header.stamp), k_now);
                                 ASSERT_EQ(m.fields._length, 6u);
                                 EXPECT_STREQ(m.fields._buffer[4].name, "normal_y");
                                 EXPECT_EQ(m.fields._buffer[4].offset, 16u);
                                 EXPECT_EQ(m.fields._buffer[4].datatype, 7);
                                 EXPECT_EQ(m.fields._buffer[4].count, 1u);
                                 ASSERT_EQ(m.point_step, 24u);
                                 EXPECT_EQ(m.height, 1u);
                                 ASSERT_EQ(m.data._length, m.width * 24);
                                 EXPECT_EQ(m.row_step, m.data._length);
                                 EXPECT_LE(m.data._length, k_cloud_message_bytes - 1024);
                                 EXPECT_FALSE(m.is_bigendian);
                                 EXPECT_TRUE(m.is_dense);
                                 for (std::uint32_t i = 0; i < m.width; ++i) {
                                   std::array<float, 6> row{};
                                   std::memcpy(row.data(), m.data._buffer + 24 * i, 24);
                                   received.push_back(row);
                                 }
                               }),
            pieces);
  ASSERT_EQ(received.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(received[i][axis], points[i][axis]);
      ASSERT_EQ(received[i][3 + axis], normals[i][axis]);
    }
  }
  EXPECT_EQ(publisher.matched_readers(), 1);
  EXPECT_TRUE(publisher.wait_for_acknowledgements(milliseconds(k_timeout_ms)));
}

TEST_F(Surroundings, LeaveOutWhatACloudHasTooMuchAndSayHowMuch) {
  MapPublisher publisher(test_settings());
  const std::size_t fits = k_cloud_messages_max * ((k_cloud_message_bytes - 1024) / 12);
  const std::vector<std::array<float, 3>> points(fits + 7, {1, 2, 3});
  EXPECT_EQ(publisher.publish_cloud(points, {}, k_now), 7u);
}

TEST_F(Surroundings, GiveTheOctomapToTheByte) {
  MapPublisher publisher(test_settings());
  std::vector<std::int8_t> data;
  for (int i = 0; i < 100'000; ++i) data.push_back(static_cast<std::int8_t>(i * 7919));
  publisher.publish_octomap(data, 0.02, k_now);
  Peer peer(test_settings());
  const dds_entity_t reader = late_reader(peer, octomap_type(), "rt/glint/octomap", 1);
  EXPECT_EQ(take<OctomapMessage>(reader, 1,
                                 [&](const OctomapMessage& m) {
                                   EXPECT_STREQ(m.header.frame_id, "hmd_world");
                                   EXPECT_TRUE(m.binary);
                                   EXPECT_STREQ(m.id, "OcTree");
                                   EXPECT_EQ(m.resolution, 0.02);
                                   const std::vector<std::int8_t> got(
                                       m.data._buffer, m.data._buffer + m.data._length);
                                   EXPECT_EQ(got, data);
                                 }),
            1u);
}

TEST_F(Surroundings, GiveAPathInTheRobotsFrameWithEachPointsTime) {
  MapPublisher publisher(test_settings());
  std::vector<UncertainPose> points(3);
  for (int i = 0; i < 3; ++i) {
    UncertainPose& point = points[static_cast<std::size_t>(i)];
    point.time = Time{} + milliseconds(4) * i;
    point.pose = {Quaternion(0.5, -0.5, 0.5, 0.5), Vector3(0.1 * i, 2, 3)};
  }
  publisher.publish_path(points, k_clock_start, k_now);
  Peer peer(test_settings());
  const dds_entity_t reader = late_reader(peer, path_type(), "rt/glint/path", 1);
  EXPECT_EQ(take<PathMessage>(reader, 1,
                              [&](const PathMessage& m) {
                                EXPECT_STREQ(m.header.frame_id, "robot_base");
                                ASSERT_EQ(m.poses._length, 3u);
                                const PoseStampedMessage& last = m.poses._buffer[2];
                                EXPECT_STREQ(last.header.frame_id, "robot_base");
                                EXPECT_EQ(time_of(last.header.stamp).nanoseconds,
                                          k_clock_start.nanoseconds + 8'000'000);
                                EXPECT_EQ(last.pose.position.x, 0.2);
                                EXPECT_EQ(last.pose.orientation.x, -0.5);
                                EXPECT_EQ(last.pose.orientation.w, 0.5);
                              }),
            1u);
}

TEST_F(Surroundings, TellWhereTheRobotStandsAsAStaticTransform) {
  MapPublisher publisher(test_settings());
  const StaticTransform robot{"hmd_world", "robot_base", {Quaternion(0, 0, 0, 1), {1, 2, 3}}};
  publisher.publish_static(std::array{robot}, k_now);
  Peer peer(test_settings());
  const dds_entity_t reader = late_reader(peer, tf_type(), k_tf_static_topic, 1);
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [&](const TfMessage& m) {
                              ASSERT_EQ(m.transforms._length, 1u);
                              const TransformMessage& one = m.transforms._buffer[0];
                              EXPECT_STREQ(one.header.frame_id, "hmd_world");
                              EXPECT_STREQ(one.child_frame_id, "robot_base");
                              EXPECT_EQ(one.transform.translation.y, 2);
                              EXPECT_EQ(one.transform.rotation.z, 1);
                            }),
            1u);
}

TEST_F(Surroundings, HaveTheNamesAndQualitiesOfRos2) {
  MapPublisher publisher(test_settings());
  (void)publisher.publish_cloud(ramp(3, 0), {}, k_now);
  publisher.publish_octomap({}, 0.02, k_now);
  publisher.publish_path({}, {}, k_now);
  Peer peer(test_settings());
  struct Expected {
    TopicType type;
    const char* topic;
    const char* type_name;
  };
  for (const Expected& expected :
       {Expected{cloud_type(), "rt/glint/map_points", "sensor_msgs::msg::dds_::PointCloud2_"},
        Expected{octomap_type(), "rt/glint/octomap", "octomap_msgs::msg::dds_::Octomap_"},
        Expected{path_type(), "rt/glint/path", "nav_msgs::msg::dds_::Path_"}}) {
    const auto seen = writer_seen_by(peer.reader(
        expected.type, expected.topic, Reliability::best_effort, Durability::volatile_data, 5));
    ASSERT_TRUE(seen) << expected.topic;
    EXPECT_EQ(seen->type, expected.type_name);
    EXPECT_EQ(seen->reliability, DDS_RELIABILITY_RELIABLE);
    EXPECT_EQ(seen->durability, DDS_DURABILITY_TRANSIENT_LOCAL);
    EXPECT_EQ(seen->representations,
              (std::vector<dds_data_representation_id_t>{DDS_DATA_REPRESENTATION_XCDR1}));
    EXPECT_EQ(seen->user_data, std::string("typehash=RIHS01_") + expected.type.type_hash + ";");
  }
}

}  // namespace
}  // namespace glint::surroundings_test

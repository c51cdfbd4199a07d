// Wire format for readers of other vendors: bytes, names and QoS as received over the network.
#include <dds/ddsi/ddsi_serdata.h>

#include <array>
#include <string>
#include <vector>

#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/dds/wire.hpp"

namespace glint::wire_test {
namespace {

using WireFormat = DdsTest;
using Bytes = std::vector<std::uint8_t>;

const ToolTopics pen = topics_of("glint", "pen");

Bytes take_bytes(dds_entity_t reader) {
  Bytes bytes;
  (void)wait_until([&] {
    std::array<ddsi_serdata*, 1> sample{};
    dds_sample_info_t info;
    if (dds_takecdr(reader, sample.data(), 1, &info, DDS_ANY_STATE) != 1) return false;
    bytes.resize(ddsi_serdata_size(sample[0]));
    ddsi_serdata_to_ser(sample[0], 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(sample[0]);
    return true;
  });
  return bytes;
}

// PoseStamped in plain CDR: encapsulation 00 01 00 00, then stamp, frame_id padded to 8, 7 doubles
// (OMG DDSI-RTPS 2.2, 10.2; OMG CORBA CDR).
TEST_F(WireFormat, OfAPoseIsLittleEndianXcdr1) {
  DdsSettings settings = test_settings();
  settings.frames.robot = "base_link";
  DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(pose_stamped_type(), pen.pose, Reliability::reliable,
                                          Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  sink.offer(sample_at(3));
  const Bytes bytes = take_bytes(reader);
  ASSERT_EQ(bytes.size(), 84u);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 4), (Bytes{0x00, 0x01, 0x00, 0x00}));
  // 1700000000 s, 12 ms
  EXPECT_EQ(Bytes(bytes.begin() + 4, bytes.begin() + 12),
            (Bytes{0x00, 0xF1, 0x53, 0x65, 0x00, 0x1B, 0xB7, 0x00}));
  EXPECT_EQ(Bytes(bytes.begin() + 12, bytes.begin() + 16), (Bytes{10, 0, 0, 0}));
  EXPECT_EQ(std::string(bytes.begin() + 16, bytes.begin() + 25), "base_link");
  // The last double is the quaternion's w, 0.5.
  EXPECT_EQ(Bytes(bytes.end() - 8, bytes.end()), (Bytes{0, 0, 0, 0, 0, 0, 0xE0, 0x3F}));
}

TEST_F(WireFormat, NamesAndQualitiesAreThoseOfRos2) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  struct Expected {
    TopicType type;
    const char* topic;
    const char* type_name;
    dds_durability_kind_t durability;
  };
  const Expected all[] = {
      {pose_stamped_type(), "rt/glint/pen_pose", "geometry_msgs::msg::dds_::PoseStamped_",
       DDS_DURABILITY_VOLATILE},
      {pose_covariance_type(), "rt/glint/pen_pose_covariance",
       "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_", DDS_DURABILITY_VOLATILE},
      {pose_covariance_type(), "rt/glint/pen_pose_systematic",
       "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_", DDS_DURABILITY_VOLATILE},
      {status_type(), "rt/glint/pen_status", "glint_msgs::msg::dds_::TrackStatus_",
       DDS_DURABILITY_VOLATILE},
      {tf_type(), "rt/tf", "tf2_msgs::msg::dds_::TFMessage_", DDS_DURABILITY_VOLATILE},
      {tf_type(), "rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_",
       DDS_DURABILITY_TRANSIENT_LOCAL},
      {diagnostics_type(), "rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_",
       DDS_DURABILITY_VOLATILE},
  };
  for (const Expected& expected : all) {
    const auto seen = writer_seen_by(peer.reader(
        expected.type, expected.topic, Reliability::best_effort, Durability::volatile_data, 5));
    ASSERT_TRUE(seen) << expected.topic;
    EXPECT_EQ(seen->topic, expected.topic);
    EXPECT_EQ(seen->type, expected.type_name);
    EXPECT_EQ(seen->reliability, DDS_RELIABILITY_RELIABLE) << expected.topic;
    EXPECT_EQ(seen->durability, expected.durability) << expected.topic;
    EXPECT_EQ(seen->representations,
              (std::vector<dds_data_representation_id_t>{DDS_DATA_REPRESENTATION_XCDR1}));
    EXPECT_EQ(seen->user_data, std::string("typehash=RIHS01_") + expected.type.type_hash + ";");
    EXPECT_EQ(std::string(expected.type.type_hash).size(), 64u);
  }
}

TEST_F(WireFormat, TellsRos2OfTheParticipantsEnclave) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t participants =
      dds_create_reader(peer.participant(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  EXPECT_TRUE(wait_until([&] {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    bool found = false;
    while (dds_take(participants, sample, &info, 1, 1) == 1) {
      const auto* seen = static_cast<const dds_builtintopic_participant_t*>(sample[0]);
      found = found || (info.valid_data && user_data_of(seen->qos) == "enclave=/;");
      dds_return_loan(participants, sample, 1);
    }
    return found;
  }));
}

TEST_F(WireFormat, ReachesBestEffortReadersToo) {
  DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(pose_stamped_type(), pen.pose, Reliability::best_effort,
                                          Durability::volatile_data, 5);
  ASSERT_TRUE(peer.wait_for_discovery(sink));
  sink.start();
  // Best effort may lose a message.
  std::uint32_t tick = 0;
  EXPECT_TRUE(wait_until([&] {
    sink.offer(sample_at(tick++));
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    const bool taken = dds_take(reader, sample, &info, 1, 1) == 1;
    if (taken) dds_return_loan(reader, sample, 1);
    return taken;
  }));
}

// A sink that terminates must not dispose its poses.
TEST_F(WireFormat, DisposesOfNothingWhenTheSinkLeaves) {
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(pose_stamped_type(), pen.pose, Reliability::reliable,
                                          Durability::volatile_data, 10);
  {
    DdsSink sink(test_settings());
    ASSERT_TRUE(peer.wait_for_discovery(sink));
    sink.start();
    sink.offer(sample_at(1));
  }
  dds_instance_state_t last = DDS_IST_ALIVE;
  EXPECT_TRUE(wait_until([&] {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(reader, sample, &info, 1, 1) == 1) {
      last = info.instance_state;
      dds_return_loan(reader, sample, 1);
    }
    return last != DDS_IST_ALIVE;
  }));
  EXPECT_EQ(last, DDS_IST_NOT_ALIVE_NO_WRITERS);
}

}  // namespace
}  // namespace glint::wire_test

// The node of a run in ROS 2's graph, as other participants receive it.
#include "platform/sinks/dds/ros_node.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "platform/sinks/dds/dds_inputs.hpp"
#include "platform/sinks/dds/dds_process.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "rmw_dds_common.h"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint::ros_node_test {
namespace {

using RosNodes = DdsTest;
using Gid = std::string;
using IronInfo = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;

struct Graph {
  std::string name, space;
  Gid participant;
  std::set<Gid> readers, writers;
};

Gid gid_from(const std::uint8_t* data) { return {reinterpret_cast<const char*>(data), 16}; }

std::set<Gid> gids_in(const dds_sequence_rmw_dds_common_msg_dds__Gid_& sequence) {
  std::set<Gid> gids;
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    gids.insert(gid_from(sequence._buffer[i].data));
  }
  return gids;
}

dds_entity_t graph_reader(Peer& peer, RosGraph release) {
  return peer.reader(ros_graph_type(release), "ros_discovery_info", Reliability::reliable,
                     Durability::transient_local, 100);
}

// Identifiers of the participant's endpoints by discovery, which Glint's code does not write.
std::set<Gid> discovered(Peer& peer, dds_entity_t builtin_topic, const Gid& participant) {
  const dds_entity_t reader =
      dds_create_reader(peer.participant(), builtin_topic, nullptr, nullptr);
  std::set<Gid> found;
  std::array<void*, 200> samples{};
  std::array<dds_sample_info_t, 200> infos{};
  const int taken = dds_take(reader, samples.data(), infos.data(), samples.size(), 200);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(0, taken)); ++i) {
    const auto* endpoint = static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    if (!infos[i].valid_data || gid_from(endpoint->participant_key.v) != participant) continue;
    if (std::string(endpoint->topic_name) == "ros_discovery_info") continue;
    found.insert(gid_from(endpoint->key.v));
  }
  if (taken > 0) dds_return_loan(reader, samples.data(), taken);
  dds_delete(reader);
  return found;
}

TEST_F(RosNodes, HaveTheirNamespaceAndAllEndpoints) {
  DdsSettings settings = test_settings();
  settings.name = "left";
  settings.ros_graph = RosGraph::iron;
  DdsSink sink(settings);
  const DdsInputs inputs(sink.process(), settings, {});
  Peer peer(settings);
  const dds_entity_t reader = graph_reader(peer, RosGraph::iron);
  Graph newest;
  std::set<Gid> readers, writers;
  // The endpoints are created one after another: the newest message has all.
  EXPECT_TRUE(wait_until([&] {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(reader, sample, &info, 1, 1) == 1) {
      const auto* message = static_cast<const IronInfo*>(sample[0]);
      if (info.valid_data && message->node_entities_info_seq._length == 1) {
        const auto& node = message->node_entities_info_seq._buffer[0];
        newest = {node.node_name, node.node_namespace, gid_from(message->gid.data),
                  gids_in(node.reader_gid_seq), gids_in(node.writer_gid_seq)};
      }
      dds_return_loan(reader, sample, 1);
    }
    readers = discovered(peer, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, newest.participant);
    writers = discovered(peer, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, newest.participant);
    return newest.readers.size() == 9 && newest.writers.size() == 7 && newest.readers == readers &&
           newest.writers == writers;
  })) << newest.readers.size()
      << " readers of " << readers.size() << ", " << newest.writers.size() << " writers of "
      << writers.size();
  EXPECT_EQ(newest.name, "glint");
  EXPECT_EQ(newest.space, "/left");
}

// Humble: identifiers of 24 bytes, the last 8 zero.
TEST_F(RosNodes, HaveTheLongerIdentifiersOfHumble) {
  DdsSettings settings = test_settings();
  settings.ros_graph = RosGraph::humble;
  const DdsSink sink(settings);
  Peer peer(settings);
  const dds_entity_t reader = graph_reader(peer, RosGraph::humble);
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(wait_until([&] {
    std::array<ddsi_serdata*, 1> sample{};
    dds_sample_info_t info;
    if (dds_takecdr(reader, sample.data(), 1, &info, DDS_ANY_STATE) != 1) return false;
    bytes.resize(ddsi_serdata_size(sample[0]));
    ddsi_serdata_to_ser(sample[0], 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(sample[0]);
    const std::uint8_t writers = bytes.size() > 56 ? bytes[56] : 0;
    return writers == 7;
  }));
  // Encapsulation 4, identifier 24, one node, "/" with its length, "glint" with its length, no
  // readers, 7 writers.
  const std::vector<std::uint8_t> expected{1, 0, 0, 0, 2, 0,   0,   0,   '/', 0,   0,
                                           0, 6, 0, 0, 0, 'g', 'l', 'i', 'n', 't', 0,
                                           0, 0, 0, 0, 0, 0,   7,   0,   0,   0};
  ASSERT_EQ(bytes.size(), 4u + 24 + expected.size() + 7 * 24);
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin() + 28, bytes.begin() + 60), expected);
  EXPECT_TRUE(std::all_of(bytes.begin() + 20, bytes.begin() + 28, [](auto b) { return b == 0; }));
}

TEST_F(RosNodes, AreOffByDefault) {
  const DdsSink sink(test_settings());
  Peer peer(test_settings());
  const dds_entity_t graph = graph_reader(peer, RosGraph::iron);
  const dds_entity_t status = peer.reader(status_type(), "rt/glint/pen_status",
                                          Reliability::reliable, Durability::volatile_data, 1);
  EXPECT_TRUE(wait_until([&] { return has_writer(status); }));
  EXPECT_FALSE(has_writer(graph)) << "it would have been announced before";
}

}  // namespace
}  // namespace glint::ros_node_test

#include "platform/sinks/dds/ros_node.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <type_traits>

#include "platform/sinks/dds/topic_names.hpp"
#include "rmw_dds_common.h"

namespace glint {
namespace {

using Iron = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
using Humble = rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo_;

constexpr const char* k_node_name = "glint";
constexpr Quality k_graph_quality{Reliability::reliable, Durability::transient_local, 1};

template <class Gid>
Gid gid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  (void)dds_get_guid(entity, &guid);
  Gid gid{};
  static_assert(sizeof gid.data >= sizeof guid.v);
  std::memcpy(gid.data, guid.v, sizeof guid.v);
  return gid;
}

template <class Gid>
std::vector<Gid> gids_of(const std::vector<dds_entity_t>& entities) {
  std::vector<Gid> gids;
  std::transform(entities.begin(), entities.end(), std::back_inserter(gids), gid_of<Gid>);
  return gids;
}

template <class Sequence, class Element>
void refer(Sequence& sequence, std::vector<Element>& elements) {
  sequence._buffer = elements.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
}

template <class Message>
void write(dds_entity_t writer, dds_entity_t participant, const std::string& space,
           const std::vector<dds_entity_t>& readers, const std::vector<dds_entity_t>& writers) {
  using Gid = decltype(Message::gid);
  std::remove_pointer_t<decltype(Message::node_entities_info_seq._buffer)> node{};
  std::vector<Gid> of_readers = gids_of<Gid>(readers), of_writers = gids_of<Gid>(writers);
  space.copy(node.node_namespace, sizeof node.node_namespace - 1);
  std::strcpy(node.node_name, k_node_name);
  refer(node.reader_gid_seq, of_readers);
  refer(node.writer_gid_seq, of_writers);
  Message message{};
  message.gid = gid_of<Gid>(participant);
  message.node_entities_info_seq._buffer = &node;
  message.node_entities_info_seq._length = message.node_entities_info_seq._maximum = 1;
  (void)dds_write(writer, &message);
}

}  // namespace

TopicType ros_graph_type(RosGraph release) {
  if (release != RosGraph::humble) {
    return {&rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
            "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"};
  }
  // Without metadata, which has the other name; Humble reads neither metadata nor hash.
  const dds_topic_descriptor_t& made = rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo__desc;
  static const dds_topic_descriptor_t descriptor{
      .m_size = made.m_size,
      .m_align = made.m_align,
      .m_flagset = made.m_flagset & ~static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA),
      .m_nkeys = made.m_nkeys,
      .m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename,
      .m_keys = made.m_keys,
      .m_nops = made.m_nops,
      .m_ops = made.m_ops,
      .m_meta = made.m_meta,
      .type_information = {},
      .type_mapping = {},
      .restrict_data_representation = made.restrict_data_representation};
  return {&descriptor, "0000000000000000000000000000000000000000000000000000000000000000"};
}

RosNode::RosNode(Participant& participant, const DdsSettings& settings)
    : participant_(participant.entity()), release_(settings.ros_graph), space_("/") {
  if (!settings.name.empty()) space_ += ros_name(settings.name);
  if (release_ == RosGraph::off) return;
  writer_ = participant.writer(ros_graph_type(release_), k_ros_graph_topic, k_graph_quality);
}

void RosNode::publish(const std::vector<dds_entity_t>& readers,
                      const std::vector<dds_entity_t>& writers) {
  switch (release_) {
    case RosGraph::off:
      return;
    case RosGraph::humble:
      return write<Humble>(writer_, participant_, space_, readers, writers);
    case RosGraph::iron:
      return write<Iron>(writer_, participant_, space_, readers, writers);
  }
}

}  // namespace glint

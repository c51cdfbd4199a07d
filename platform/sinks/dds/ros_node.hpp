// The node of a participant in ROS 2's graph: `ros2 node list` shows it, with its topics.
//
// Publishes ros_discovery_info (rmw_dds_common). Identifiers have 16 bytes since Iron, 24 in
// Humble: a message of the wrong size is an error in every node that receives it.
#pragma once

#include <vector>

#include "platform/sinks/dds/participant.hpp"

namespace glint {

inline constexpr const char* k_ros_graph_topic = "ros_discovery_info";
// By release; the type's name is the same.
[[nodiscard]] TopicType ros_graph_type(RosGraph release);

class RosNode {
 public:
  // Publishes nothing with RosGraph::off. `participant` must outlive this object.
  RosNode(Participant& participant, const DdsSettings& settings);
  // Publishes all endpoints of the node.
  void publish(const std::vector<dds_entity_t>& readers, const std::vector<dds_entity_t>& writers);

 private:
  dds_entity_t participant_;
  RosGraph release_;
  std::string space_;
  dds_entity_t writer_ = 0;
};

}  // namespace glint

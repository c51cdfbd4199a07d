#include "platform/sinks/dds/security_documents.hpp"

#include <ctime>

#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

constexpr const char* k_prefix = "glint";  // of Glint's own topics
// Topics that every ROS 2 node needs and Glint does not read.
constexpr const char* k_node_topics[] = {"ros_discovery_info", "rt/rosout", "rt/parameter_events",
                                         "rq/*", "rr/*"};

std::string utc_text(std::int64_t unix_s) {
  const std::time_t time = unix_s;
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  (void)std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

std::string domains_text(const SecurityScope& scope) {
  return "<domains><id_range><min>" + std::to_string(scope.first_domain) + "</min><max>" +
         std::to_string(scope.last_domain) + "</max></id_range></domains>\n";
}

std::string topics_text(const std::string& element, const std::vector<std::string>& topics) {
  std::string text = "<" + element + "><topics>\n";
  for (const std::string& topic : topics) text += "<topic>" + topic + "</topic>\n";
  return text + "</topics></" + element + ">\n";
}

std::string permissions_text(const std::string& identity, const SecurityScope& scope,
                             const std::vector<std::string>& publish,
                             const std::vector<std::string>& subscribe) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<dds>\n<permissions>\n<grant name=\"" +
         identity + "\">\n<subject_name>CN=" + common_name(identity) +
         "</subject_name>\n<validity><not_before>" + utc_text(scope.validity.from_s) +
         "</not_before><not_after>" + utc_text(scope.validity.to_s) +
         "</not_after></validity>\n<allow_rule>\n" + domains_text(scope) +
         topics_text("publish", publish) + topics_text("subscribe", subscribe) +
         "</allow_rule>\n<default>DENY</default>\n</grant>\n</permissions>\n</dds>\n";
}

// Patterns of what Glint publishes.
std::vector<std::string> outputs(const std::string& space) {
  std::vector<std::string> topics{topic_in(space, "rt/" + std::string(k_prefix) + "/*")};
  for (const char* topic :
       {k_tf_topic, k_tf_static_topic, k_diagnostics_topic, k_robot_description_topic}) {
    topics.push_back(topic_in(space, topic));
  }
  return topics;
}

}  // namespace

std::string common_name(const std::string& identity) { return "/" + identity; }

std::string governance_text(const SecurityScope& scope) {
  return "<?xml version=\"1.0\" "
         "encoding=\"UTF-8\"?>\n<dds>\n<domain_access_rules>\n<domain_rule>\n" +
         domains_text(scope) +
         "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
         "<enable_join_access_control>true</enable_join_access_control>\n"
         "<discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
         "<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
         "<rtps_protection_kind>SIGN</rtps_protection_kind>\n"
         "<topic_access_rules>\n<topic_rule>\n"
         "<topic_expression>*</topic_expression>\n"
         "<enable_discovery_protection>true</enable_discovery_protection>\n"
         "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
         "<enable_read_access_control>true</enable_read_access_control>\n"
         "<enable_write_access_control>true</enable_write_access_control>\n"
         "<metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
         "<data_protection_kind>ENCRYPT</data_protection_kind>\n"
         "</topic_rule>\n</topic_access_rules>\n"
         "</domain_rule>\n</domain_access_rules>\n</dds>\n";
}

std::string run_permissions_text(const SecurityScope& scope) {
  const std::vector<std::string> all{"rt/*", "ros_discovery_info"};
  return permissions_text(k_run_identity, scope, all, all);
}

std::string peer_permissions_text(const PeerRights& peer, const SecurityScope& scope) {
  std::vector<std::string> publish(std::begin(k_node_topics), std::end(k_node_topics));
  std::vector<std::string> subscribe = publish;
  for (const DdsInput input : peer.inputs) {
    for (const std::string& topic : topics_of(input, k_prefix, scope.name)) {
      publish.push_back(topic);
    }
  }
  publish.insert(publish.end(), peer.topics.begin(), peer.topics.end());
  const std::vector<std::string> published = outputs(scope.name);
  subscribe.insert(subscribe.end(), published.begin(), published.end());
  return permissions_text(peer.name, scope, publish, subscribe);
}

}  // namespace glint

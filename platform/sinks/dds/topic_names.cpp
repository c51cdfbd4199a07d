#include "platform/sinks/dds/topic_names.hpp"

#include <algorithm>

namespace glint {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_word(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

}  // namespace

std::string ros_name(std::string_view text) {
  std::string name;
  for (const char c : text) name += is_word(c) ? c : '_';
  return name.empty() || is_digit(name.front()) ? "tool_" + name : name;
}

std::string dds_topic(std::string_view ros_topic) {
  std::string name = "rt";
  if (!ros_topic.starts_with('/')) name += '/';
  name += ros_topic;
  const bool valid =
      std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '/'; });
  return valid && !name.ends_with('/') ? name : "";
}

std::string topic_under(std::string_view prefix, std::string_view name) {
  return "rt/" + ros_name(prefix) + "/" + ros_name(name);
}

std::string topic_in(std::string_view space, std::string_view topic) {
  constexpr std::string_view root = "rt/";
  if (space.empty()) return std::string(topic);
  return std::string(root) + ros_name(space) + "/" + std::string(topic.substr(root.size()));
}

std::vector<std::string> topics_of(DdsInput input, std::string_view prefix,
                                   std::string_view space) {
  std::vector<std::string> topics;
  switch (input) {
    case DdsInput::joint_states:
      topics = {k_joint_states_topic};
      break;
    case DdsInput::robot_description:
      topics = {k_robot_description_topic};
      break;
    case DdsInput::initial_pose:
      topics = {k_initial_pose_topic};
      break;
    case DdsInput::buttons:
      for (const char* name : {"button", "button_delete", "button_undo", "button_finish"}) {
        topics.push_back(topic_under(prefix, name));
      }
      break;
    case DdsInput::tools:
      topics = {topic_under(prefix, "tool_add"), topic_under(prefix, "tool_remove")};
      break;
  }
  for (std::string& topic : topics) topic = topic_in(space, topic);
  return topics;
}

ToolTopics topics_of(std::string_view prefix, std::string_view tool, std::string_view space) {
  const std::string base = ros_name(prefix), name = ros_name(tool);
  const std::string topic = topic_in(space, "rt/" + base + "/" + name);
  return {topic + "_status", topic + "_pose", topic + "_pose_covariance",
          topic + "_pose_systematic", base + "_" + name + "_tip"};
}

}  // namespace glint

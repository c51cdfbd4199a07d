#include "platform/sinks/record/recording.hpp"

#include <array>

#include "platform/input_error.hpp"
#include "platform/sinks/record/bytes.hpp"
#include "platform/sinks/record/topics.hpp"

namespace glint {
namespace {

constexpr std::array<std::string_view, 4> k_level_names{"full", "roi", "blobs", "outputs"};

bool is_topic_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

std::string_view name_of(RecordingLevel level) {
  return k_level_names[static_cast<std::size_t>(level)];
}

RecordingLevel recording_level(std::string_view name, const std::string& prefix) {
  for (std::size_t i = 0; i < k_level_names.size(); ++i)
    if (k_level_names[i] == name) return static_cast<RecordingLevel>(i);
  throw InputError(prefix + ": recording level '" + std::string(name) +
                   "'; expected full, roi, blobs or outputs");
}

Attachment text_attachment(std::string name, std::string_view text) {
  const auto bytes = bytes_of(text);
  return {std::move(name), "text/plain", {bytes.begin(), bytes.end()}};
}

std::string topic_name(const std::vector<std::string>& tool_names, std::size_t tool) {
  std::string name;
  if (tool < tool_names.size())
    for (const char c : tool_names[tool]) name += is_topic_character(c) ? c : '_';
  return name.empty() ? "tool" + std::to_string(tool) : name;
}

RecordedTopics tool_topics(const std::vector<std::string>& tool_names, std::size_t tool) {
  const std::string name = topic_name(tool_names, tool);
  const std::string pose = tool == 0 ? "/glint/pen_pose" : "/glint/" + name + "/pose";
  return {pose, pose + "_cov", "glint_" + name + "_tip"};
}

}  // namespace glint

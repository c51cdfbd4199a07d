#include "platform/sinks/view/foxglove_messages.hpp"

#include <limits>
#include <nlohmann/json.hpp>

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

std::optional<std::uint32_t> number_of(const Json& json) {
  if (!json.is_number_unsigned()) return std::nullopt;
  const auto value = json.get<std::uint64_t>();
  if (value > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

// The list of that name; null if it is absent, no list, or too long.
const Json* list_in(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_array() || found->size() > k_subscriptions_max) {
    return nullptr;
  }
  return &*found;
}

std::optional<Request> subscribe_of(const Json& json) {
  const Json* const list = list_in(json, "subscriptions");
  if (list == nullptr) return std::nullopt;
  Request request;
  for (const Json& one : *list) {
    if (!one.is_object() || !one.contains("id") || !one.contains("channelId")) return std::nullopt;
    const auto id = number_of(one["id"]), channel = number_of(one["channelId"]);
    if (!id || !channel) return std::nullopt;
    request.begun.push_back({*id, *channel});
  }
  return request;
}

std::optional<Request> unsubscribe_of(const Json& json) {
  const Json* const list = list_in(json, "subscriptionIds");
  if (list == nullptr) return std::nullopt;
  Request request;
  for (const Json& one : *list) {
    const auto id = number_of(one);
    if (!id) return std::nullopt;
    request.ended.push_back(*id);
  }
  return request;
}

}  // namespace

std::optional<Request> request_of(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("op")) return std::nullopt;
  if (json["op"] == "subscribe") return subscribe_of(json);
  if (json["op"] == "unsubscribe") return unsubscribe_of(json);
  return std::nullopt;
}

std::string server_info() {
  return Json{{"op", "serverInfo"},
              {"name", "glint"},
              {"capabilities", Json::array()},
              {"supportedEncodings", Json::array()},
              {"metadata", Json::object()}}
      .dump();
}

std::string channel_json(std::uint32_t channel, std::string_view topic, std::string_view type,
                         std::string_view schema) {
  return Json{{"id", channel},      {"topic", topic},   {"encoding", "cdr"},
              {"schemaName", type}, {"schema", schema}, {"schemaEncoding", "ros2msg"}}
      .dump();
}

std::string advertise(const std::vector<std::string>& channels) {
  std::string text = R"({"op":"advertise","channels":[)";
  for (const std::string& channel : channels) {
    text += (&channel == channels.data() ? "" : ",") + channel;
  }
  return text + "]}";
}

std::string error_status(const std::string& message) {
  return Json{{"op", "status"}, {"level", 2}, {"message", message}}.dump();
}

std::vector<std::uint8_t> message_head(std::uint32_t subscription, std::uint64_t unix_ns) {
  std::vector<std::uint8_t> head = {1};
  for (int shift = 0; shift < 32; shift += 8) {
    head.push_back(static_cast<std::uint8_t>(subscription >> shift));
  }
  for (int shift = 0; shift < 64; shift += 8) {
    head.push_back(static_cast<std::uint8_t>(unix_ns >> shift));
  }
  return head;
}

}  // namespace glint

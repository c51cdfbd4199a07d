// Discovery data of a writer as a reader receives it.
#pragma once

#include <dds/dds.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/unit/platform/sinks/dds/peer.hpp"

namespace glint {

inline std::string user_data_of(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size)) return "";
  std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

struct WriterSeen {
  std::string topic, type, user_data;
  dds_reliability_kind_t reliability{};
  dds_durability_kind_t durability{};
  std::vector<dds_data_representation_id_t> representations;
};

inline std::optional<WriterSeen> writer_seen_by(dds_entity_t reader) {
  dds_instance_handle_t handle = 0;
  if (!wait_until([&] { return has_writer(reader); }) ||
      dds_get_matched_publications(reader, &handle, 1) != 1) {
    return std::nullopt;
  }
  dds_builtintopic_endpoint_t* endpoint = dds_get_matched_publication_data(reader, handle);
  WriterSeen seen;
  seen.topic = endpoint->topic_name;
  seen.type = endpoint->type_name;
  seen.user_data = user_data_of(endpoint->qos);
  dds_duration_t blocking = 0;
  dds_qget_reliability(endpoint->qos, &seen.reliability, &blocking);
  dds_qget_durability(endpoint->qos, &seen.durability);
  std::uint32_t count = 0;
  dds_data_representation_id_t* ids = nullptr;
  if (dds_qget_data_representation(endpoint->qos, &count, &ids)) {
    seen.representations.assign(ids, ids + count);
    dds_free(ids);
  }
  dds_builtintopic_free_endpoint(endpoint);
  return seen;
}

}  // namespace glint

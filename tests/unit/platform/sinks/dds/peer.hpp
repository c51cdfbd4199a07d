// Another DDS participant, like a ROS 2 node. It has its own Cyclone domain in this process, so its
// only connection to the sink is the loopback interface.
#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/network.hpp"
#include "platform/sinks/dds/participant.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {

// Timeout of everything that is received over the network.
inline constexpr int k_timeout_ms = 10'000;

// Waits until `done` returns true. Returns false at the timeout.
template <class Done>
[[nodiscard]] bool wait_until(Done done) {
  for (int waited = 0; waited < k_timeout_ms; waited += 2) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return done();
}

[[nodiscard]] inline bool has_writer(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return status.current_count > 0;
}

[[nodiscard]] inline bool has_reader(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return status.current_count > 0;
}

class Peer {
 public:
  // `own_id`: the Cyclone domain, unique within the process; on the wire the sink's domain is used.
  // `discovery`: further elements of Cyclone's configuration.
  explicit Peer(const DdsSettings& settings, dds_domainid_t own_id = 200,
                const std::string& discovery = "")
      : settings_(settings) {
    std::string text = cyclone_configuration(settings);
    const std::string before = "<Discovery>";
    text.insert(
        text.find(before) + before.size(),
        "<ExternalDomainId>" + std::to_string(settings.domain) + "</ExternalDomainId>" + discovery);
    const std::size_t internal = text.find("<Internal>"), behind = text.find("</Internal>");
    text.erase(internal, behind + std::string("</Internal>").size() - internal);  // Glint's limits
    domain_ = dds_create_domain(own_id, text.c_str());
    participant_ = dds_create_participant(own_id, nullptr, nullptr);
  }
  ~Peer() { dds_delete(domain_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  dds_entity_t reader(const TopicType& type, const std::string& topic, Reliability reliability,
                      Durability durability, int depth) {
    dds_qos_t* const qos = qos_of(reliability, durability, depth);
    const dds_entity_t entity =
        dds_create_topic(participant_, type.descriptor, topic.c_str(), nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(participant_, entity, qos, nullptr);
    dds_delete_qos(qos);
    readers_.push_back(reader);
    if (type.descriptor == status_type().descriptor) ++status_readers_;
    return reader;
  }

  dds_entity_t writer(const TopicType& type, const std::string& topic, Reliability reliability,
                      Durability durability, int depth) {
    dds_qos_t* const qos = qos_of(reliability, durability, depth);
    const dds_entity_t entity =
        dds_create_topic(participant_, type.descriptor, topic.c_str(), nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(participant_, entity, qos, nullptr);
    dds_delete_qos(qos);
    return writer;
  }

  // Waits until both sides have discovered each other's endpoints. A sink discovers readers in
  // order of their creation, so a reader of the last tool's status, created last, completes the
  // discovery.
  [[nodiscard]] bool wait_for_discovery(const DdsSink& sink) {
    const int known = status_readers_;
    for (const std::string& tool : settings_.tool_names) {
      reader(status_type(), topics_of(settings_.topic_prefix, tool).status, Reliability::reliable,
             Durability::volatile_data, 1);
    }
    const int tools = static_cast<int>(settings_.tool_names.size());
    if (!sink.wait_for_readers(known / tools + 1, milliseconds(k_timeout_ms))) return false;
    return wait_until([&] { return std::all_of(readers_.begin(), readers_.end(), has_writer); });
  }

  [[nodiscard]] dds_entity_t participant() const { return participant_; }

 private:
  // XCDR1, as in rmw_cyclonedds. The caller deletes the result.
  static dds_qos_t* qos_of(Reliability reliability, Durability durability, int depth) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos,
                         reliability == Reliability::reliable ? DDS_RELIABILITY_RELIABLE
                                                              : DDS_RELIABILITY_BEST_EFFORT,
                         DDS_MSECS(100));
    dds_qset_durability(qos, durability == Durability::transient_local
                                 ? DDS_DURABILITY_TRANSIENT_LOCAL
                                 : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
    const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &xcdr1);
    return qos;
  }

  DdsSettings settings_;
  std::vector<dds_entity_t> readers_;
  int status_readers_ = 0;
  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
};

// Passes messages to `use` until `count` or the timeout. Returns the number received.
template <class Message, class Use>
[[nodiscard]] std::size_t take(dds_entity_t reader, std::size_t count, Use use) {
  std::size_t taken = 0;
  (void)wait_until([&] {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(reader, sample, &info, 1, 1) == 1) {
      if (info.valid_data) {
        ++taken;
        use(*static_cast<const Message*>(sample[0]));
      }
      dds_return_loan(reader, sample, 1);
    }
    return taken >= count;
  });
  return taken;
}

}  // namespace glint

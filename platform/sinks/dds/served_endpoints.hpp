// Writers and readers of the DDS process: publishes the records of one ring, puts what it receives
// into the other.
//
// After a restart a writer publishes only when it has matched as many readers as its predecessor
// had, and k_settling later: what it publishes then reaches all of them, and what it refused is
// counted. Readers that do not return delay it by k_matching_max.
#pragma once

#include <dds/dds.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <vector>

#include "platform/sinks/dds/participant.hpp"
#include "platform/sinks/dds/process_memory.hpp"
#include "platform/sinks/dds/ros_node.hpp"

namespace glint {

class ServedEndpoints {
 public:
  static constexpr dds_duration_t k_settling = DDS_MSECS(100);
  static constexpr dds_duration_t k_matching_max = DDS_MSECS(3000);

  // Throws as Participant does. `memory` must outlive this object.
  ServedEndpoints(const DdsSettings& settings, SharedMemory& memory);
  ~ServedEndpoints();
  ServedEndpoints(const ServedEndpoints&) = delete;
  ServedEndpoints& operator=(const ServedEndpoints&) = delete;

  // Works until there is nothing to do, within bounds. Returns whether something was done.
  [[nodiscard]] bool work();
  // Waits for a record, a received message or the end of `limit`.
  void wait(std::uint32_t seen, Duration limit);
  // Value for wait(), to be read before work().
  [[nodiscard]] std::uint32_t signals() const;
  // Publishes the node and the endpoints' states; releases writers that waited for their readers.
  void update_states();
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  struct Endpoint {
    NewEndpoint created;
    TopicType type{};
    dds_entity_t entity = 0;  // 0: none
    dds_time_t created_at = 0, matched_at = 0;
    std::vector<dds_instance_handle_t> senders;  // of a reader
    SharedMemory* memory = nullptr;
    std::atomic<int> waiting{0};  // messages in the reader
    EndpointState* state = nullptr;
  };

  void apply(const RingRecord& record);
  void create(Endpoint& endpoint);
  void publish(Endpoint& endpoint);
  void flush(const Flush& flush);
  bool take(std::uint16_t number, Endpoint& endpoint);
  void take_one(std::uint16_t number, Endpoint& endpoint, struct ddsi_serdata* packed,
                const dds_sample_info_t& info);
  void report_left_senders(std::uint16_t number, Endpoint& endpoint);
  void update_writer(Endpoint& endpoint);
  void publish_node();
  static void on_message(dds_entity_t reader, void* endpoint) noexcept;

  Participant participant_;
  RosNode node_;
  bool endpoints_changed_ = true;  // since the node was published
  SharedMemory* memory_;
  RingConsumer outgoing_;
  RingProducer incoming_;
  std::vector<std::uint8_t> bytes_;
  std::deque<Endpoint> endpoints_;
  dds_time_t states_due_ = 0;
  bool ended_ = false;
};

}  // namespace glint

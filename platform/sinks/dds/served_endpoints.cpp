#include "platform/sinks/dds/served_endpoints.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/futex.hpp"
#include "platform/sinks/dds/serialiser.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {
namespace {

constexpr int k_records_per_round_max = 256;
constexpr int k_messages_per_round_max = 64;  // per reader: no topic starves the others
constexpr std::size_t k_senders_max = 64;     // publishers of one topic that are observed
constexpr dds_duration_t k_state_period = DDS_MSECS(10);
constexpr dds_duration_t k_beat_max = DDS_MSECS(100);  // between signs of life in a flush

void signal_futex(std::atomic<std::uint32_t>& futex) {
  futex.fetch_add(1, std::memory_order_release);
  futex_wake(futex, 1, FutexUse::processes);
}

template <class Object>
Object object_of(std::span<const std::uint8_t> bytes) {
  Object object;
  if (bytes.size() != sizeof object) throw std::runtime_error("a record of an unknown size");
  std::memcpy(static_cast<void*>(&object), bytes.data(), sizeof object);
  return object;
}

}  // namespace

ServedEndpoints::ServedEndpoints(const DdsSettings& settings, SharedMemory& memory)
    : participant_(settings),
      node_(participant_, settings),
      memory_(&memory),
      outgoing_(memory.state().outgoing, memory.outgoing()),
      incoming_(memory.state().incoming, memory.incoming()) {
  for (std::size_t i = 0; i < k_endpoints_max; ++i) {
    Endpoint& endpoint = endpoints_.emplace_back();
    endpoint.memory = memory_;
    endpoint.state = &memory.state().endpoints[i];
  }
}

// Listeners refer to the endpoints: they end before these.
ServedEndpoints::~ServedEndpoints() {
  for (const Endpoint& endpoint : endpoints_) {
    if (endpoint.entity != 0) dds_delete(endpoint.entity);
  }
}

std::uint32_t ServedEndpoints::signals() const {
  return memory_->state().to_process.load(std::memory_order_acquire);
}

void ServedEndpoints::wait(std::uint32_t seen, Duration limit) {
  const Time deadline = monotonic_now() + limit;
  (void)futex_sleep(memory_->state().to_process, seen, &deadline, FutexUse::processes);
}

bool ServedEndpoints::work() {
  bool any = false;
  RingRecord record;
  for (int i = 0; i < k_records_per_round_max && !ended_; ++i) {
    const RingResult result = outgoing_.pop(record, bytes_);
    if (result == RingResult::broken) throw std::runtime_error("the program broke the memory");
    if (result == RingResult::empty) break;
    apply(record);
    any = true;
  }
  bool received = false;
  for (std::size_t i = 0; i < endpoints_.size(); ++i) {
    Endpoint& endpoint = endpoints_[i];
    if (endpoint.entity == 0 || endpoint.created.is_writer) continue;
    received = take(static_cast<std::uint16_t>(i), endpoint) || received;
  }
  if (received) signal_futex(memory_->state().to_program);
  return any || received;
}

void ServedEndpoints::apply(const RingRecord& record) {
  Endpoint& endpoint = endpoints_.at(record.endpoint);
  switch (record.kind) {
    case RecordKind::message:
      return publish(endpoint);
    case RecordKind::create:
      endpoint.created = object_of<NewEndpoint>(bytes_);
      return create(endpoint);
    case RecordKind::remove:
      if (endpoint.entity != 0) dds_delete(endpoint.entity);
      endpoint.entity = 0;
      endpoints_changed_ = true;
      return;
    case RecordKind::flush:
      return flush(object_of<Flush>(bytes_));
    case RecordKind::end:
      ended_ = true;
      return;
    case RecordKind::sender_left:
      throw std::runtime_error("a record for the program");
  }
}

void ServedEndpoints::create(Endpoint& endpoint) {
  const auto type = type_named(endpoint.created.type.data());
  if (!type) throw std::runtime_error("a topic of an unknown type");
  endpoint.type = *type;
  endpoint.created_at = dds_time();
  endpoints_changed_ = true;
  const std::string topic = endpoint.created.topic.data();
  if (endpoint.created.is_writer) {
    endpoint.entity = participant_.writer(*type, topic, endpoint.created.quality);
    return update_writer(endpoint);
  }
  endpoint.entity = participant_.reader(*type, topic, endpoint.created.quality);
  dds_listener_t* const listener = dds_create_listener(&endpoint);
  dds_lset_data_available(listener, on_message);
  dds_set_listener(endpoint.entity, listener);
  dds_delete_listener(listener);
  signal_futex(memory_->state().to_process);  // messages may have arrived before the listener
}

void ServedEndpoints::publish(Endpoint& endpoint) {
  if (endpoint.state->ready == 0) update_writer(endpoint);
  bool done = false;
  if (endpoint.entity != 0 && endpoint.state->ready != 0) {
    const dds_topic_descriptor_t* const descriptor = endpoint.type.descriptor;
    const std::unique_ptr<std::uint64_t[]> message(
        new std::uint64_t[descriptor->m_size / sizeof(std::uint64_t) + 1]());
    done = deserialise(endpoint.type, bytes_, message.get()) &&
           dds_write(endpoint.entity, message.get()) == DDS_RETCODE_OK;
    dds_sample_free(message.get(), descriptor, DDS_FREE_CONTENTS);
  }
  ++(done ? endpoint.state->published : endpoint.state->failed);
}

void ServedEndpoints::flush(const Flush& flush) {
  const dds_time_t deadline = dds_time() + flush.limit_ns;
  for (const Endpoint& endpoint : endpoints_) {
    if (endpoint.entity == 0 || !endpoint.created.is_writer) continue;
    while (true) {
      const dds_duration_t left = std::max<dds_duration_t>(0, deadline - dds_time());
      const dds_return_t code = dds_wait_for_acks(endpoint.entity, std::min(left, k_beat_max));
      ++memory_->state().beat;
      if (code == DDS_RETCODE_OK || left == 0) break;
    }
  }
  memory_->state().flushed = flush.number;
}

// Called on Cyclone's thread after each message. A full reader overwrites its oldest message, and
// Cyclone does not count it.
void ServedEndpoints::on_message(dds_entity_t /*reader*/, void* argument) noexcept {
  Endpoint& endpoint = *static_cast<Endpoint*>(argument);
  if (endpoint.waiting >= endpoint.created.quality.depth) {
    ++endpoint.state->overwritten;
  } else {
    ++endpoint.waiting;
  }
  signal_futex(endpoint.memory->state().to_process);
}

bool ServedEndpoints::take(std::uint16_t number, Endpoint& endpoint) {
  for (int i = 0; i < k_messages_per_round_max; ++i) {
    std::array<ddsi_serdata*, 1> packed{};
    dds_sample_info_t info;
    if (dds_takecdr(endpoint.entity, packed.data(), 1, &info, DDS_ANY_STATE) != 1) {
      endpoint.waiting = 0;  // `waiting` also counted a publisher's end
      report_left_senders(number, endpoint);
      return i > 0;
    }
    if (info.valid_data) take_one(number, endpoint, packed[0], info);
    ddsi_serdata_unref(packed[0]);
  }
  return true;
}

void ServedEndpoints::take_one(std::uint16_t number, Endpoint& endpoint, ddsi_serdata* packed,
                               const dds_sample_info_t& info) {
  if (endpoint.waiting > 0) --endpoint.waiting;
  const std::uint32_t size = ddsi_serdata_size(packed);
  if (size > endpoint.created.bytes_max) {
    ++endpoint.state->refused;
    return;
  }
  ddsrt_iovec_t bytes{};
  ddsi_serdata* const held = ddsi_serdata_to_ser_ref(packed, 0, size, &bytes);
  const bool pushed = incoming_.push({info.publication_handle, 0, number, RecordKind::message},
                                     {static_cast<const std::uint8_t*>(bytes.iov_base), size});
  if (!pushed) ++endpoint.state->overwritten;
  ddsi_serdata_to_ser_unref(held, &bytes);
}

// A publisher left the domain cleanly or at the end of its lease. All of its messages were taken.
void ServedEndpoints::report_left_senders(std::uint16_t number, Endpoint& endpoint) {
  std::array<dds_instance_handle_t, k_senders_max> found{};
  const int count = dds_get_matched_publications(endpoint.entity, found.data(), found.size());
  if (count < 0 || count > static_cast<int>(found.size())) return;
  const std::vector<dds_instance_handle_t> senders(found.begin(), found.begin() + count);
  for (const dds_instance_handle_t sender : endpoint.senders) {
    if (std::find(senders.begin(), senders.end(), sender) != senders.end()) continue;
    (void)incoming_.push({sender, 0, number, RecordKind::sender_left}, {});
    signal_futex(memory_->state().to_program);
  }
  endpoint.senders = senders;
}

void ServedEndpoints::update_states() {
  ++memory_->state().beat;
  const dds_time_t now = dds_time();
  if (now < states_due_) return;
  states_due_ = now + k_state_period;
  if (endpoints_changed_) publish_node();
  for (Endpoint& endpoint : endpoints_) {
    if (endpoint.entity == 0) continue;
    if (endpoint.created.is_writer) {
      update_writer(endpoint);
      continue;
    }
    dds_subscription_matched_status_t matched{};
    dds_get_subscription_matched_status(endpoint.entity, &matched);
    endpoint.state->matched = matched.current_count;
    dds_sample_lost_status_t lost{};
    dds_get_sample_lost_status(endpoint.entity, &lost);
    endpoint.state->lost = lost.total_count;
    dds_requested_incompatible_qos_status_t incompatible{};
    dds_get_requested_incompatible_qos_status(endpoint.entity, &incompatible);
    endpoint.state->incompatible = incompatible.total_count;
  }
}

void ServedEndpoints::publish_node() {
  endpoints_changed_ = false;
  std::vector<dds_entity_t> readers, writers;
  for (const Endpoint& endpoint : endpoints_) {
    if (endpoint.entity == 0) continue;
    (endpoint.created.is_writer ? writers : readers).push_back(endpoint.entity);
  }
  node_.publish(readers, writers);
}

void ServedEndpoints::update_writer(Endpoint& endpoint) {
  if (endpoint.entity == 0) return;
  dds_publication_matched_status_t matched{};
  dds_get_publication_matched_status(endpoint.entity, &matched);
  endpoint.state->matched = matched.current_count;
  if (endpoint.state->ready != 0) return;
  const dds_time_t now = dds_time();
  const std::uint32_t before = endpoint.created.readers_before;
  const bool retained = endpoint.created.quality.durability == Durability::transient_local;
  if (matched.current_count >= before && endpoint.matched_at == 0) endpoint.matched_at = now;
  const bool settled = endpoint.matched_at != 0 && now - endpoint.matched_at >= k_settling;
  const bool late = now - endpoint.created_at >= k_matching_max;
  if (before == 0 || retained || settled || late) endpoint.state->ready = 1;
}

}  // namespace glint

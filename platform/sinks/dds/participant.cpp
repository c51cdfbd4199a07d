#include "platform/sinks/dds/participant.hpp"

#include <dds/ddsrt/log.h>

#include <cstdio>
#include <map>
#include <memory>
#include <mutex>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/dds/network.hpp"
#include "platform/sinks/dds/security_files.hpp"

namespace glint {
namespace {

// Maximum blocking time of a write without free space: it blocks the sink's only thread.
constexpr dds_duration_t k_blocking_max = DDS_MSECS(10);
constexpr int k_domain_max = 232;  // highest with ports within 16 bits (DDSI-RTPS 2.2, 9.6.1)

constexpr std::size_t k_reason_max = 100;  // of Cyclone's text, which ends with OpenSSL's

struct FreeQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, FreeQos>;

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0) throw std::runtime_error("dds: " + what + ": " + dds_strretcode(-entity));
  return entity;
}

Qos qos_of(const TopicType& type, const Quality& quality) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(),
                       quality.reliability == Reliability::reliable ? DDS_RELIABILITY_RELIABLE
                                                                    : DDS_RELIABILITY_BEST_EFFORT,
                       k_blocking_max);
  const bool keep_all = quality.depth == k_keep_all;
  const auto history = keep_all ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST;
  const int depth = keep_all ? DDS_LENGTH_UNLIMITED : quality.depth;
  dds_qset_history(qos.get(), history, depth);
  if (quality.durability == Durability::transient_local) {
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    // Late readers get this history; without it Cyclone keeps one sample.
    dds_qset_durability_service(qos.get(), 0, history, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  // Fast DDS readers match a writer that offers only XCDR2, but receive nothing from it.
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &xcdr1);
  const std::string user_data = std::string("typehash=RIHS01_") + type.type_hash + ";";
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

dds_entity_t topic_of(dds_entity_t participant, const TopicType& type, const std::string& name) {
  return checked(dds_create_topic(participant, type.descriptor, name.c_str(), nullptr, nullptr),
                 "topic " + name);
}

// Cyclone's errors, on standard error instead of cyclonedds.log. Other participants cause some,
// e.g. by a refused certificate: the number of lines is bounded.
class CycloneErrors {
 public:
  static CycloneErrors& of_process() {
    static CycloneErrors errors;
    return errors;
  }
  // For a call whose error becomes an exception: no lines until take_last().
  void keep() {
    const std::lock_guard lock(mutex_);
    keeping_ = true;
    last_.clear();
  }
  std::string take_last() {
    const std::lock_guard lock(mutex_);
    keeping_ = false;
    return std::move(last_);
  }

 private:
  CycloneErrors() { dds_set_log_sink(&receive, this); }
  static void receive(void* errors, const dds_log_data_t* data) {
    auto* const self = static_cast<CycloneErrors*>(errors);
    const std::lock_guard lock(self->mutex_);
    const std::string text = printable(std::string(data->message, data->size));
    if (self->keeping_) {
      self->last_ = text;
    } else if (self->lines_ < k_lines_max) {
      ++self->lines_;
      std::fprintf(stderr, "dds: %s\n", text.c_str());
    }
  }

  static constexpr int k_lines_max = 20;
  std::mutex mutex_;
  bool keeping_ = false;
  int lines_ = 0;
  std::string last_;
};

}  // namespace

// A domain of this process; it exists until its last participant leaves.
struct Participant::Domain {
  Domain(dds_domainid_t id, const std::string& text)
      : configuration(text), entity(dds_create_domain(id, text.c_str())) {}
  ~Domain() {
    if (entity > 0) dds_delete(entity);
  }
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  std::string configuration;
  dds_entity_t entity;
};

// Cyclone allows one configuration per domain.
std::shared_ptr<Participant::Domain> Participant::domain_of(const DdsSettings& settings) {
  static std::mutex open_mutex;
  static std::map<int, std::weak_ptr<Domain>> open;
  const std::lock_guard lock(open_mutex);
  const std::string configuration = cyclone_configuration(settings);
  const std::string where = "dds.domain: domain " + std::to_string(settings.domain) +
                            " on interface " + settings.interface;
  std::shared_ptr<Domain> domain = open[settings.domain].lock();
  if (domain != nullptr && domain->configuration != configuration) {
    throw InputError(where +
                     ": this process uses another interface for it; expected one interface");
  }
  if (domain != nullptr) return domain;
  domain = std::make_shared<Domain>(static_cast<dds_domainid_t>(settings.domain), configuration);
  if (domain->entity < 0) {
    throw InputError(where + ": " + dds_strretcode(-domain->entity) +
                     "; expected a domain that this process has not opened");
  }
  open[settings.domain] = domain;
  return domain;
}

Participant::Participant(const DdsSettings& settings) {
  if (settings.domain < 0 || settings.domain > k_domain_max) {
    throw InputError("dds.domain: found " + std::to_string(settings.domain) +
                     "; expected 0 to 232");
  }
  require_network_interface(settings.interface);
  require_security(settings.security);
  const auto id = static_cast<dds_domainid_t>(settings.domain);
  domain_ = domain_of(settings);
  // rmw_cyclonedds shows only participants that state their security enclave.
  constexpr std::string_view enclave = "enclave=/;";
  Qos qos(dds_create_qos());
  dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
  CycloneErrors& errors = CycloneErrors::of_process();
  errors.keep();
  participant_ = dds_create_participant(id, qos.get(), nullptr);
  const std::string error = errors.take_last().substr(0, k_reason_max);
  if (participant_ < 0 && !settings.security.empty()) {
    throw InputError("dds.security: " + settings.security + ": " + error +
                     "; expected valid files of `glint dds keys` for domain " +
                     std::to_string(settings.domain));
  }
  if (participant_ < 0) {
    const int code = -participant_;
    throw InputError("dds: cannot join domain " + std::to_string(settings.domain) +
                     " on interface " + settings.interface + ": " + dds_strretcode(code) +
                     "; expected free UDP ports and an interface that can send");
  }
}

Participant::~Participant() { dds_delete(participant_); }

dds_entity_t Participant::writer(const TopicType& type, const std::string& topic,
                                 const Quality& quality) {
  const Qos qos = qos_of(type, quality);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return checked(
      dds_create_writer(participant_, topic_of(participant_, type, topic), qos.get(), nullptr),
      "writer of " + topic);
}

dds_entity_t Participant::reader(const TopicType& type, const std::string& topic,
                                 const Quality& quality) {
  const Qos qos = qos_of(type, quality);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PROCESS);
  return checked(
      dds_create_reader(participant_, topic_of(participant_, type, topic), qos.get(), nullptr),
      "reader of " + topic);
}

dds_entity_t Participant::waitset() { return checked(dds_create_waitset(participant_), "waitset"); }

}  // namespace glint

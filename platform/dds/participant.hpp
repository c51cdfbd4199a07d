// One process's place in a DDS domain, and endpoints in it that ROS 2 recognises.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

#include "platform/dds/dds_settings.hpp"

namespace glint {

// A type and the hash by which ROS 2 (Iron and newer) knows it: RIHS01, the SHA-256 of its
// description as JSON (rosidl_generator_type_description).
struct TopicType {
  const dds_topic_descriptor_t* descriptor;
  const char* type_hash;
};

enum class Reliability { best_effort, reliable };
enum class Durability { volatile_data, transient_local };
inline constexpr int k_keep_all = 0;

struct Quality {
  Reliability reliability = Reliability::reliable;
  Durability durability = Durability::volatile_data;
  int depth = 10;  // keep_last, or k_keep_all
};

class Participant {
 public:
  // Several of one process may join the same domain. Throws MissingDevice (network interface) or
  // InputError (settings; this process is in the domain by another interface; the network refuses).
  explicit Participant(const DdsSettings& settings);
  ~Participant();  // leaves the domain with every endpoint of its own
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // Both throw std::runtime_error, which no setting should be able to cause. XCDR1 alone is offered
  // and asked for; endpoints carry their type hash as ROS 2's do. A reader reads no writer of this
  // process.
  dds_entity_t writer(const TopicType& type, const std::string& topic, const Quality& quality);
  dds_entity_t reader(const TopicType& type, const std::string& topic, const Quality& quality);
  dds_entity_t waitset();

 private:
  struct Domain;
  [[nodiscard]] static std::shared_ptr<Domain> domain_of(const DdsSettings& settings);

  std::shared_ptr<Domain> domain_;
  dds_entity_t participant_ = 0;
};

}  // namespace glint

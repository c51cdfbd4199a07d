// DDS participant of one process, with endpoints that ROS 2 recognises.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

#include "platform/sinks/dds/dds_settings.hpp"

namespace glint {

// A type and its ROS 2 type hash (Iron and newer): RIHS01, the SHA-256 of its description as JSON
// (rosidl_generator_type_description).
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
  // Participants of one process may share a domain. Throws MissingDevice (network interface) or
  // InputError (settings; this process uses the domain on another interface; network error).
  explicit Participant(const DdsSettings& settings);
  ~Participant();  // deletes its endpoints and leaves the domain
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // Both throw std::runtime_error; no setting should cause it. Offers and requests XCDR1 only.
  // Endpoints carry their type hash as in ROS 2. A reader ignores writers of this process.
  dds_entity_t writer(const TopicType& type, const std::string& topic, const Quality& quality);
  dds_entity_t reader(const TopicType& type, const std::string& topic, const Quality& quality);
  dds_entity_t waitset();
  [[nodiscard]] dds_entity_t entity() const noexcept { return participant_; }

 private:
  struct Domain;
  [[nodiscard]] static std::shared_ptr<Domain> domain_of(const DdsSettings& settings);

  std::shared_ptr<Domain> domain_;
  dds_entity_t participant_ = 0;
};

}  // namespace glint

// Serialisation of messages by Cyclone's own code, without a DDS domain: XCDR1, little endian, with
// its encapsulation.
#pragma once

#include <dds/ddsi/ddsi_cdrstream.h>

#include <cstdint>
#include <span>
#include <vector>

#include "platform/sinks/dds/participant.hpp"

namespace glint {

class Serialiser {
 public:
  Serialiser();
  ~Serialiser();
  Serialiser(const Serialiser&) = delete;
  Serialiser& operator=(const Serialiser&) = delete;

  // `message` has the type's C structure. Valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> bytes_of(const TopicType& type, const void* message);

 private:
  dds_ostreamLE_t stream_;
  std::vector<std::uint8_t> bytes_;
};

// Reverses it into a zeroed structure, to be freed by dds_sample_free. Changes `bytes`. Returns
// false if they are no message of the type; the structure is then unchanged.
[[nodiscard]] bool deserialise(const TopicType& type, std::span<std::uint8_t> bytes, void* message);

}  // namespace glint

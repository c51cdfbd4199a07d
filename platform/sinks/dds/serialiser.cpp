#include "platform/sinks/dds/serialiser.hpp"

#include <dds/ddsi/q_protocol.h>

#include <algorithm>
#include <array>
#include <bit>

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little, "deserialise() swaps no bytes");
constexpr std::array<std::uint8_t, 4> k_encapsulation{0, 1, 0, 0};
constexpr std::uint32_t k_first_size = 1024;

}  // namespace

Serialiser::Serialiser() { dds_ostreamLE_init(&stream_, k_first_size, CDR_ENC_VERSION_1); }

Serialiser::~Serialiser() { dds_ostreamLE_fini(&stream_); }

std::span<const std::uint8_t> Serialiser::bytes_of(const TopicType& type, const void* message) {
  stream_.x.m_index = 0;
  (void)dds_stream_writeLE(&stream_, static_cast<const char*>(message), type.descriptor->m_ops);
  bytes_.assign(k_encapsulation.begin(), k_encapsulation.end());
  bytes_.insert(bytes_.end(), stream_.x.m_buffer, stream_.x.m_buffer + stream_.x.m_index);
  return bytes_;
}

bool deserialise(const TopicType& type, std::span<std::uint8_t> bytes, void* message) {
  if (bytes.size() < k_encapsulation.size() ||
      !std::equal(k_encapsulation.begin(), k_encapsulation.begin() + 2, bytes.begin())) {
    return false;
  }
  char* const data = reinterpret_cast<char*>(bytes.data()) + k_encapsulation.size();
  const auto size = static_cast<std::uint32_t>(bytes.size() - k_encapsulation.size());
  std::uint32_t end = 0;
  if (dds_stream_normalize_data(data, &end, size, false, CDR_ENC_VERSION_1,
                                type.descriptor->m_ops) == nullptr) {
    return false;
  }
  dds_istream_t stream;
  dds_istream_init(&stream, end, data, CDR_ENC_VERSION_1);
  (void)dds_stream_read(&stream, static_cast<char*>(message), type.descriptor->m_ops);
  return true;
}

}  // namespace glint

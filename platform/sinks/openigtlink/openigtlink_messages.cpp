#include "platform/sinks/openigtlink/openigtlink_messages.hpp"

#include <algorithm>
#include <bit>

namespace glint {
namespace {

constexpr std::uint64_t k_version = 1;
constexpr std::size_t k_type_bytes = 12, k_device_bytes = 20, k_text_max = 64;
constexpr std::uint64_t k_instrument_6d = 2;  // TDATA: an instrument with six degrees of freedom
constexpr std::int64_t k_ns_per_s = 1'000'000'000;

// ECMA-182, most significant bit first, start value 0.
constexpr std::array<std::uint64_t, 256> make_crc_table() {
  constexpr std::uint64_t polynomial = 0x42F0E1EBA9EA3693;
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t crc = byte << 56;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc >> 63) != 0 ? polynomial : 0);
    table[byte] = crc;
  }
  return table;
}
constexpr std::array<std::uint64_t, 256> k_crc_table = make_crc_table();

std::uint64_t crc_of(std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = (crc << 8) ^ k_crc_table[(crc >> 56) ^ byte];
  return crc;
}

// Seconds and, in the lower half, their fraction in units of 2^-32 s.
std::uint64_t stamp_of(Time unix_time) noexcept {
  const std::int64_t ns = std::max<std::int64_t>(unix_time.nanoseconds, 0);
  const auto seconds = static_cast<std::uint64_t>(ns / k_ns_per_s);
  const auto rest = static_cast<std::uint64_t>(ns % k_ns_per_s);
  return (seconds << 32) | ((rest << 32) / k_ns_per_s);
}

}  // namespace

void OpenIgtLinkMessage::add_number(std::uint64_t value, std::size_t bytes) noexcept {
  for (std::size_t i = bytes; i-- > 0;) bytes_[size_++] = static_cast<std::uint8_t>(value >> 8 * i);
}

void OpenIgtLinkMessage::add_name(std::string_view text, std::size_t bytes) noexcept {
  const std::string_view cut = text.substr(0, bytes - 1);
  std::copy(cut.begin(), cut.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes;  // the rest is zero
}

// The columns of the rotation, then the position.
void OpenIgtLinkMessage::add_matrix(const Pose& pose) noexcept {
  constexpr double mm_per_m = 1000;
  const Matrix3 rotation = pose.rotation.toRotationMatrix();
  const auto add = [&](double value) {
    add_number(std::bit_cast<std::uint32_t>(static_cast<float>(value)), sizeof(float));
  };
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) add(rotation(row, column));
  }
  for (int row = 0; row < 3; ++row) add(mm_per_m * pose.translation[row]);
}

void OpenIgtLinkMessage::finish(std::string_view type, std::string_view device,
                                Time unix_time) noexcept {
  const std::size_t end = size_;
  const auto body =
      std::span(bytes_).subspan(k_openigtlink_header_bytes, end - k_openigtlink_header_bytes);
  size_ = 0;
  add_number(k_version, 2);
  add_name(type, k_type_bytes);
  add_name(device, k_device_bytes);
  add_number(stamp_of(unix_time), 8);
  add_number(body.size(), 8);
  add_number(crc_of(body), 8);
  size_ = end;
}

OpenIgtLinkMessage OpenIgtLinkMessage::transform(std::string_view device, Time unix_time,
                                                 const Pose& pose) noexcept {
  OpenIgtLinkMessage message;
  message.add_matrix(pose);
  message.finish("TRANSFORM", device, unix_time);
  return message;
}

OpenIgtLinkMessage OpenIgtLinkMessage::tracking(std::string_view device, Time unix_time,
                                                std::span<const OpenIgtLinkTool> tools) noexcept {
  OpenIgtLinkMessage message;
  for (const OpenIgtLinkTool& tool :
       tools.first(std::min<std::size_t>(tools.size(), k_tools_max))) {
    message.add_name(tool.name, k_openigtlink_name_bytes);
    message.add_number(k_instrument_6d, 1);
    message.add_number(0, 1);  // reserved
    message.add_matrix(tool.pose);
  }
  message.finish("TDATA", device, unix_time);
  return message;
}

OpenIgtLinkMessage OpenIgtLinkMessage::status(std::string_view device, Time unix_time,
                                              OpenIgtLinkStatus code, std::string_view name,
                                              std::string_view text) noexcept {
  OpenIgtLinkMessage message;
  message.add_number(static_cast<std::uint16_t>(code), 2);
  message.add_number(0, 8);  // no subcode
  message.add_name(name, k_openigtlink_name_bytes);
  const std::string_view cut = text.substr(0, k_text_max);
  message.add_name(cut, cut.size() + 1);  // ends with a zero
  message.finish("STATUS", device, unix_time);
  return message;
}

}  // namespace glint

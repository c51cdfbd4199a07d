// Protobuf wire format for the three field kinds of a Perfetto trace. Source: Protocol Buffers,
// Encoding: a field is the varint (number << 3 | wire type), then its value; wire type 0 is a
// varint, 2 a varint of the length and that many bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace glint {

class ProtobufWriter {
 public:
  void number(std::uint32_t field, std::uint64_t value) {
    varint(field << 3);
    varint(value);
  }
  void bytes(std::uint32_t field, std::string_view value) {
    varint(field << 3 | 2);
    varint(value.size());
    bytes_ += value;
  }
  void message(std::uint32_t field, const ProtobufWriter& value) { bytes(field, value.bytes_); }

  [[nodiscard]] const std::string& data() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace glint

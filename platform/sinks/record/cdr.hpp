// Serialisation of ROS 2 messages: XCDR1, little endian, each number aligned to its size after the
// 4 bytes of encapsulation. The writer reuses its buffer, so that a message costs no allocation.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "platform/sinks/record/bytes.hpp"

namespace glint {

inline constexpr std::size_t k_cdr_encapsulation_bytes = 4;

template <class T>
concept CdrNumber = std::integral<T> || std::same_as<T, double> || std::same_as<T, float>;

template <std::size_t N>
struct UnsignedOfSize;
template <>
struct UnsignedOfSize<1> {
  using Type = std::uint8_t;
};
template <>
struct UnsignedOfSize<2> {
  using Type = std::uint16_t;
};
template <>
struct UnsignedOfSize<4> {
  using Type = std::uint32_t;
};
template <>
struct UnsignedOfSize<8> {
  using Type = std::uint64_t;
};

class CdrWriter {
 public:
  CdrWriter() { begin(); }

  // Starts a new message; discards the last one.
  void begin() { bytes_ = {0, 1, 0, 0}; }

  template <CdrNumber Number>
  void put(Number number) {
    align(sizeof number);
    append(bytes_, std::bit_cast<typename UnsignedOfSize<sizeof number>::Type>(number));
  }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(bytes_, bytes_of(text));
    bytes_.push_back(0);
  }
  void put(const char* text) { put(std::string_view(text)); }
  void put_length(std::size_t count) { put(static_cast<std::uint32_t>(count)); }
  // uint8[]
  void put_bytes(std::span<const std::uint8_t> bytes) {
    put_length(bytes.size());
    append(bytes_, bytes);
  }

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  void align(std::size_t size) {
    while ((bytes_.size() - k_cdr_encapsulation_bytes) % size != 0) bytes_.push_back(0);
  }
  Bytes bytes_;
};

// Reads beyond the end return 0 or empty and set failed().
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> message) : reader_(message) {
    const auto encapsulation = reader_.take(k_cdr_encapsulation_bytes);
    wrong_encapsulation_ = reader_.failed() || encapsulation[0] != 0 || encapsulation[1] != 1;
  }

  template <CdrNumber Number>
  Number get() {
    align(sizeof(Number));
    if constexpr (std::same_as<Number, bool>) {
      return reader_.number<std::uint8_t>() != 0;
    } else {
      return std::bit_cast<Number>(reader_.number<typename UnsignedOfSize<sizeof(Number)>::Type>());
    }
  }
  std::string get_text() { return std::string(get_text_view()); }
  // References the message's memory.
  std::string_view get_text_view() {
    const auto taken = reader_.take(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.empty() ? 0 : taken.size() - 1};
  }
  std::span<const std::uint8_t> get_bytes() { return reader_.take(get<std::uint32_t>()); }

  [[nodiscard]] bool failed() const { return wrong_encapsulation_ || reader_.failed(); }
  [[nodiscard]] bool at_end() const { return reader_.at_end(); }

 private:
  void align(std::size_t size) {
    const std::size_t past = (reader_.position() - k_cdr_encapsulation_bytes) % size;
    if (!reader_.failed() && past != 0) reader_.take(size - past);
  }
  ByteReader reader_;
  bool wrong_encapsulation_ = false;
};

}  // namespace glint

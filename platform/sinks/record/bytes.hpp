// Byte buffer: appends little-endian numbers, strings and byte runs; reads them with bounds checks.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/wire/bits.hpp"

namespace glint {

using Bytes = std::vector<std::uint8_t>;

[[nodiscard]] inline std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <std::unsigned_integral Unsigned>
void append(Bytes& to, Unsigned value) {
  const std::size_t at = to.size();
  to.resize(at + sizeof value);
  put_little_endian(std::span(to).subspan(at), value);
}

inline void append(Bytes& to, std::span<const std::uint8_t> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

// MCAP's string: its length in 32 bits, then its bytes.
inline void append(Bytes& to, std::string_view text) {
  append(to, static_cast<std::uint32_t>(text.size()));
  append(to, bytes_of(text));
}

// Bounds-checked reader of a byte buffer. After a read beyond the end, failed() is true and all
// reads return 0 or empty.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Unsigned>
  Unsigned number() {
    return static_cast<Unsigned>(get_little_endian(take(sizeof(Unsigned))));
  }
  std::span<const std::uint8_t> take(std::uint64_t count) {
    if (failed_ || count > bytes_.size() - at_) {
      failed_ = true;
      return {};
    }
    const auto taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return taken;
  }
  std::string text() {
    const auto taken = take(number<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }
  // A separate reader for the next `count` bytes.
  ByteReader part(std::uint64_t count) { return ByteReader(take(count)); }

  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool at_end() const { return failed_ || at_ == bytes_.size(); }
  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace glint

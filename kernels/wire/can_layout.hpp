// Description of a CAN message: identifier, length, period and signals, in the terms of a DBC file.
//
// can_messages.hpp is the only table of them. Packing, decoding, the DBC file, identifiers, the bus
// load and the check for equal identifiers derive from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "kernels/nonblocking.hpp"
#include "kernels/wire/bits.hpp"

namespace glint {

inline constexpr std::uint32_t k_can_identifier_max = 0x7FF;                // 11 bits
inline constexpr std::uint32_t k_can_extended_identifier_max = 0x1FFFFFFF;  // 29 bits

enum class CanFormat : std::uint8_t {
  classic,        // five frames of 8 bytes for one pose
  fd,             // one frame of 64 bytes for one pose, data phase at the fast bit rate
  fd_covariance,  // that frame, and one of 48 bytes with the pose's covariance
};

// In the order of the enumerators, as cells and plans state them.
inline constexpr std::array<std::string_view, 3> k_can_format_names{"classic", "fd",
                                                                    "fd_covariance"};
[[nodiscard]] constexpr std::string_view name_of(CanFormat format) noexcept {
  return k_can_format_names[static_cast<std::size_t>(format)];
}
// Of one of these names; classic for another text.
[[nodiscard]] constexpr CanFormat can_format_of(std::string_view name) noexcept {
  for (const CanFormat format : {CanFormat::fd, CanFormat::fd_covariance}) {
    if (name_of(format) == name) return format;
  }
  return CanFormat::classic;
}
[[nodiscard]] constexpr bool is_fd(CanFormat format) noexcept {
  return format != CanFormat::classic;
}

struct CanUnit {
  std::string_view name;
  double in_si = 1;
};

struct CanValueName {
  std::uint32_t value = 0;
  std::string_view name;
};

struct CanValueRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

enum class CanCoding : std::uint8_t {
  intel,         // unsigned; `start` is the lowest bit
  intel_signed,  // two's complement
  motorola,      // unsigned, highest byte first; `start` is the highest bit
};

enum class CanMeaning : std::uint8_t {
  number,
  saturating,  // all ones: "this or more, or unknown"
  tool,        // index of a tool of the cell
};

// Bits of a signal. Beyond 8 bytes, and in Motorola order, they are whole bytes or lie in one byte.
struct CanField {
  int start = 0;
  int width = 0;
  CanCoding coding = CanCoding::intel;

  [[nodiscard]] constexpr bool operator==(const CanField&) const = default;
  // The first of `width` successive bits, counted from the lowest bit of byte 0.
  [[nodiscard]] constexpr int first_bit() const noexcept {
    if (coding != CanCoding::motorola) return start;
    return whole_bytes() ? start - 7 : start - width + 1;
  }
  [[nodiscard]] constexpr bool whole_bytes() const noexcept {
    return width % 8 == 0 && start % 8 == (coding == CanCoding::motorola ? 7 : 0);
  }
  [[nodiscard]] constexpr std::uint64_t all_ones() const noexcept {
    return ~std::uint64_t{0} >> (64 - width);
  }
};

struct CanSignal {
  std::string_view name;
  CanField field;
  double step = 1;         // of the integer on the bus, in SI
  CanUnit unit{};          // of the DBC file
  std::int64_t limit = 0;  // largest magnitude of the integer; 0: what the field holds
  CanMeaning meaning = CanMeaning::number;
  std::span<const CanValueName> names{};
  std::string_view selector{};  // multiplexor: the signal exists for these values; empty: always
  std::span<const CanValueRange> selected_by{};
  std::string_view comment{};

  [[nodiscard]] constexpr bool is_signed() const noexcept {
    return field.coding == CanCoding::intel_signed;
  }
  [[nodiscard]] constexpr std::int64_t raw_max() const noexcept {
    if (limit != 0) return limit;
    return static_cast<std::int64_t>(field.all_ones() >> (is_signed() ? 1 : 0));
  }
  [[nodiscard]] constexpr std::int64_t raw_min() const noexcept {
    if (!is_signed()) return 0;
    return limit != 0 ? -limit : -raw_max() - 1;
  }
};

enum class CanIdentifierRule : std::uint8_t {
  of_tool,  // base + 16 x tool + offset
  of_bus,   // base + offset
  of_node,  // offset + node (CiA 301)
  of_cell,  // the cell sets it; Glint receives this message
};

inline constexpr std::uint32_t k_can_tool_stride = 0x10;

// period_ms of a message without a fixed period.
inline constexpr int k_can_each_tick = 0;
inline constexpr int k_can_on_event = -1;

// Not a constant expression: the name is not in the table.
void no_such_can_name() noexcept GLINT_NONBLOCKING;

struct CanMessageLayout {
  std::string_view name;
  CanIdentifierRule rule = CanIdentifierRule::of_node;
  std::uint32_t offset = 0;
  int bytes = 8;
  CanFormat format = CanFormat::classic;
  int period_ms = k_can_on_event;
  std::span<const CanSignal> signals{};
  std::string_view comment{};

  [[nodiscard]] constexpr const CanSignal* find(std::string_view signal_name) const noexcept {
    for (const CanSignal& item : signals) {
      if (item.name == signal_name) return &item;
    }
    return nullptr;
  }
  // The signal of this name; without one the program does not compile.
  [[nodiscard]] consteval const CanSignal& signal(std::string_view signal_name) const {
    const CanSignal* const found = find(signal_name);
    if (found == nullptr) no_such_can_name();
    return *found;
  }
  // Likewise the `count` signals from this one on.
  template <std::size_t count>
  [[nodiscard]] consteval std::span<const CanSignal, count> signals_from(
      std::string_view first) const {
    return std::span<const CanSignal, count>(&signal(first), count);
  }
  // The poses of a run have one format; the other messages are always sent.
  [[nodiscard]] constexpr bool sent_in(CanFormat used) const noexcept {
    if (rule == CanIdentifierRule::of_tool)
      return format == used || (format == CanFormat::fd && used == CanFormat::fd_covariance);
    return rule != CanIdentifierRule::of_cell;
  }
};

// The identifiers that a cell sets.
struct CanAddress {
  std::uint32_t base = 0;
  std::uint32_t node = 0;
  std::uint32_t buttons = 0;
};

[[nodiscard]] constexpr std::uint32_t identifier_of(const CanMessageLayout& message,
                                                    const CanAddress& address,
                                                    int tool = 0) noexcept {
  switch (message.rule) {
    case CanIdentifierRule::of_tool:
      return address.base + k_can_tool_stride * static_cast<std::uint32_t>(tool) + message.offset;
    case CanIdentifierRule::of_bus:
      return address.base + message.offset;
    case CanIdentifierRule::of_node:
      return message.offset + address.node;
    case CanIdentifierRule::of_cell:
      return address.buttons;
  }
  return 0;
}

// The value's bits in the word of a classic frame in Intel order.
[[nodiscard]] constexpr std::uint64_t bits_at(const CanSignal& signal,
                                              std::uint64_t value) noexcept {
  return bits_at(value, signal.field.start, signal.field.width);
}

// Writes the low bits of a value; the signal's bits are 0 before.
constexpr void put(std::span<std::uint8_t> frame, const CanSignal& signal,
                   std::uint64_t value) noexcept {
  const CanField& field = signal.field;
  const auto at = static_cast<std::size_t>(field.first_bit() / 8);
  const auto bytes = static_cast<std::size_t>(field.width / 8);
  if (!field.whole_bytes()) {
    frame[at] |= static_cast<std::uint8_t>(bits_at(value, field.first_bit() % 8, field.width));
  } else if (field.coding == CanCoding::motorola) {
    put_big_endian(frame.subspan(at, bytes), value);
  } else {
    put_little_endian(frame.subspan(at, bytes), value);
  }
}

// Intel order only.
[[nodiscard]] constexpr std::uint64_t unsigned_of(std::span<const std::uint8_t> frame,
                                                  const CanSignal& signal) noexcept {
  const auto at = static_cast<std::size_t>(signal.field.start / 8);
  if (!signal.field.whole_bytes())
    return unsigned_at(frame[at], signal.field.start % 8, signal.field.width);
  return get_little_endian(frame.subspan(at, static_cast<std::size_t>(signal.field.width / 8)));
}

[[nodiscard]] constexpr std::int64_t signed_of(std::span<const std::uint8_t> frame,
                                               const CanSignal& signal) noexcept {
  return signed_at(unsigned_of(frame, signal), 0, signal.field.width);
}

}  // namespace glint

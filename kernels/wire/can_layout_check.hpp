// Compile-time check of a table of CAN messages.
//
// What:     names are unique; every signal lies inside its message, and outside the other signals
//           of the same multiplexor values; identifiers of one tool and the node differ.
// Cost:     none at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/wire/can_layout.hpp"

namespace glint {

// Whether no frame contains both signals: by different values of one multiplexor, directly or by
// the multiplexor's own multiplexor.
[[nodiscard]] constexpr bool are_exclusive(const CanMessageLayout& message, const CanSignal& a,
                                           const CanSignal& b) {
  if (!a.selector.empty() && a.selector == b.selector) {
    for (const CanValueRange& one : a.selected_by) {
      for (const CanValueRange& other : b.selected_by) {
        if (one.first <= other.last && other.first <= one.last) return false;
      }
    }
    return true;
  }
  const CanSignal* const above_a = message.find(a.selector);
  const CanSignal* const above_b = message.find(b.selector);
  return (above_a != nullptr && are_exclusive(message, *above_a, b)) ||
         (above_b != nullptr && are_exclusive(message, a, *above_b));
}

[[nodiscard]] constexpr bool overlap(const CanField& a, const CanField& b) {
  return a.first_bit() < b.first_bit() + b.width && b.first_bit() < a.first_bit() + a.width;
}

// Signals that put() writes are whole bytes or lie in one byte; words of 8 bytes are in Intel
// order.
[[nodiscard]] constexpr bool fits(const CanMessageLayout& message, const CanSignal& signal) {
  const CanField& field = signal.field;
  const int first = field.first_bit();
  const bool inside = field.width >= 1 && field.width <= 64 && first >= 0 &&
                      first + field.width <= 8 * message.bytes;
  const bool bytewise = field.whole_bytes() || first % 8 + field.width <= 8;
  const bool in_word = message.bytes <= 8 && field.coding != CanCoding::motorola;
  const bool known_selector = signal.selector.empty() || message.find(signal.selector) != nullptr;
  return inside && (bytewise || in_word) && known_selector &&
         static_cast<std::uint64_t>(signal.limit) <= field.all_ones();
}

[[nodiscard]] constexpr bool is_consistent(const CanMessageLayout& message) {
  const auto& signals = message.signals;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (!fits(message, signals[i])) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (signals[i].name == signals[j].name) return false;
      if (overlap(signals[i].field, signals[j].field) &&
          !are_exclusive(message, signals[i], signals[j])) {
        return false;
      }
    }
  }
  const bool classic = message.format == CanFormat::classic;
  return message.bytes >= 1 && message.bytes <= (classic ? 8 : 64);
}

// Offsets of a tool's messages and the bus' are among the tool's identifiers.
[[nodiscard]] constexpr bool is_consistent(std::span<const CanMessageLayout> messages) {
  const auto in_tool = [](const CanMessageLayout& m) {
    return m.rule == CanIdentifierRule::of_tool || m.rule == CanIdentifierRule::of_bus;
  };
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const CanMessageLayout& one = messages[i];
    if (!is_consistent(one) || (in_tool(one) && one.offset >= k_can_tool_stride)) return false;
    for (std::size_t j = 0; j < i; ++j) {
      const CanMessageLayout& other = messages[j];
      const bool same_space =
          in_tool(one) == in_tool(other) && (in_tool(one) || one.rule == other.rule);
      if (one.name == other.name || (same_space && one.offset == other.offset)) return false;
    }
  }
  return true;
}

}  // namespace glint

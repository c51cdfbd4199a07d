// Reads and writes lines of a `candump -L` log: "(1700000000.123456) can0 1A0#663507E65A364586".
// CAN FD: "1A8##5..." with Linux' flags in the digit after ## (1: bit rate switch, 4: FD frame, set
// by kernels since 6.1; both are read). 29-bit identifiers have 8 digits. can-utils, tshark,
// SavvyCAN and PlotJuggler read this format.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kernels/wire/can_frame.hpp"

namespace glint {

inline constexpr std::size_t k_interface_name_max = 15;  // IFNAMSIZ without its zero
inline constexpr std::size_t k_candump_line_max =
    sizeof "(-9223372036.854775) " + k_interface_name_max + sizeof " 1FFFFFFF##1" + 128;

using CandumpLine = std::array<char, k_candump_line_max>;

// Writes the line with its newline and returns its part of `buffer`. Truncates longer interface
// names, and times to microseconds, as candump does.
[[nodiscard]] std::string_view format_candump(const CanFrame& frame, std::int64_t unix_ns,
                                              std::string_view interface,
                                              CandumpLine& buffer) noexcept;

struct CandumpRecord {
  std::int64_t unix_ns = 0;
  std::string interface;
  CanFrame frame;
};

// Returns nothing for a line without a data frame (such as a remote request).
[[nodiscard]] std::optional<CandumpRecord> parse_candump(std::string_view line);

}  // namespace glint

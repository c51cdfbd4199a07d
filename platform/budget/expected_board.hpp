// The properties that this program's graphs and build require of a board file.
#pragma once

#include "platform/budget/board_file.hpp"

namespace glint {

[[nodiscard]] BoardExpectation expected_board();

// "0x" and 16 digits, the form of a graph's signature in board files and schedules.
[[nodiscard]] std::string signature_text(std::uint64_t signature);

}  // namespace glint

// What this program's own graphs and build need a board file to be.
#pragma once

#include "platform/budget/board_file.hpp"

namespace glint {

[[nodiscard]] BoardExpectation expected_board();

// "0x" and 16 digits, as board files and plans write a graph's signature.
[[nodiscard]] std::string signature_text(std::uint64_t signature);

}  // namespace glint

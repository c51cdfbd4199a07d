// glint_board_header BOARD HEADER: writes a board file as constants, for a build for that board.
//
// A file for other graphs, another compiler or other flags stops the build with its line.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "platform/budget/expected_board.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string header_of(const Board& board) {
  std::ostringstream out;
  out << "// Made by glint_board_header of the board file whose sha256 stands below.\n"
         "#pragma once\n\n#include <array>\n\n#include \"schedules/cost_table.hpp\"\n\n"
         "namespace glint::board {\n\n"
      << "inline constexpr std::array<KernelCost, " << board.costs.size() << "> k_costs = {{\n";
  for (const KernelCost& cost : board.costs) {
    out << "    {\"" << cost.kernel << "\", {";
    for (const std::string_view loop : cost.loops) out << "\"" << loop << "\", ";
    out << "}, {";
    for (const std::int64_t picoseconds : cost.cost_ps) out << picoseconds << ", ";
    out << "}},\n";
  }
  out << "}};\ninline constexpr CostTable k_table = {\"" << board.name << "\", \"" << board.build
      << "\",\n    \"" << board.sha256 << "\", k_costs};\n\n}  // namespace glint::board\n";
  return out.str();
}

int make_header(const std::string& board_file, const std::string& header) {
  const Board board = load_board(board_file, expected_board(), BoardUse::run_here);
  const std::string part = header + ".part";
  {
    std::ofstream out(part);
    out << header_of(board);
    if (!out.flush()) throw InputError(part + ": cannot be written");
  }
  std::filesystem::rename(part, header);
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "glint_board_header: expected BOARD HEADER\n");
    return 2;
  }
  try {
    return glint::make_header(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

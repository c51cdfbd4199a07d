// Writes a board as TOML, one value per line, for readers and line-by-line review.
#include <cstdio>
#include <sstream>

#include "platform/budget/board_file.hpp"

namespace glint {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

// Three decimals: a thousandth of an instruction or nanosecond per count is below any margin.
std::string number(double value) {
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.3f", value);
  return digits;
}

}  // namespace

std::string board_text(const Board& board) {
  std::ostringstream out;
  const BoardProvenance& from = board.provenance;
  const bool time = board.counter == CostCounter::time;
  out << "# What each loop of Glint costs on one board: an upper envelope of measured costs, with\n"
         "# the margin below already in it. Bounds made of these name this file by its sha256.\n";
  out << "name = " << quoted(board.name) << "\n";
  out << "build = " << quoted(board.build) << "\n";
  out << "counter = " << (time ? "\"time\"" : "\"instructions\"") << "\n";
  if (!time) {
    out << "ns_per_instruction = " << number(board.ns_per_instruction)
        << "  # declared, not measured\n";
  }
  out << "\n[graphs]\n";
  for (const GraphName& graph : board.graphs) {
    out << graph.name << " = " << quoted(graph.signature) << "\n";
  }
  out << "\n[provenance]\n";
  out << "machine = " << quoted(from.machine) << "\n";
  out << "kernel = " << quoted(from.kernel) << "\n";
  out << "governor = " << quoted(from.governor) << "\n";
  out << "version = " << quoted(from.version) << "\n";
  out << "date = " << quoted(from.date) << "\n";
  out << "command = " << quoted(from.command) << "\n";
  if (from.clock_mhz > 0) out << "clock_mhz = " << number(from.clock_mhz) << "\n";
  out << "inputs = " << from.inputs << "  # of each kernel\n";
  out << "margin_percent = " << number(from.margin_percent) << "\n";
  out << "\n[system]  # the operating system's share: estimates\n";
  out << "wake_up_ns = " << board.system.wake_up_ns << "\n";
  out << "interrupt_ns = " << board.system.interrupt_ns << "\n";
  out << "interrupt_gap_ns = " << board.system.interrupt_gap_ns << "\n";
  out << "can_write_ns = " << board.system.can_write_ns << "\n";
  out << "core_handover_ns = " << board.system.inter_core_delay_ns << "\n";
  out << "\n# " << (time ? "Nanoseconds" : "Instructions") << " a count.\n";
  for (const BoardKernel& kernel : board.kernels) {
    out << "[kernels." << kernel.loops.kernel << "]\n";
    for (std::size_t loop = 0; loop < kernel.cost.size(); ++loop) {
      out << kernel.loops.loops[loop] << " = " << number(kernel.cost[loop]) << "\n";
    }
    out << "\n";
  }
  std::string text = out.str();
  if (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace glint

// Board files: measured cost of each loop on a computer, with provenance.
//
//   name = "x86-64-emulated"
//   build = "x86_64 GNU 12.2.0 -O3 .."      # rejected by any other build
//   [graphs]                                # rejected by any other wiring
//   Tracker = "0x.."
//   Background = "0x.."                     # optional, with the costs of its kernels
//   [provenance] ..                         # machine, kernel, governor, date, inputs, margin
//   [system] ..                             # the operating system's share: estimates
//   [kernels.FindBlobs]                     # cost per count of each loop, in the counter's unit
//   call = 120.0
//
// A program compares a file with its own expectation. It rejects a file for another graph, build or
// set of loops, with the line, since those costs do not apply.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "schedules/cost_table.hpp"
#include "schedules/kernel_list.hpp"
#include "schedules/task_model.hpp"

namespace glint {

enum class CostCounter : std::uint8_t { instructions, time };

struct BoardProvenance {
  std::string machine, kernel, governor, version, date, command;
  double clock_mhz = 0;  // declared; 0: the counter does not depend on it
  std::int64_t inputs = 0;
  double margin_percent = 0;  // included in the costs
};

// Cost per count of each loop, in the order of the node's k_loops; instructions or nanoseconds.
struct BoardKernel {
  KernelLoops loops;
  std::vector<double> cost;
};

struct GraphName {
  std::string name, signature;
};

struct Board {
  std::string name, build, sha256;
  std::vector<GraphName> graphs;
  CostCounter counter = CostCounter::instructions;
  double ns_per_instruction = 1;  // 1 if the counter is time
  BoardProvenance provenance;
  SystemShare system;
  std::vector<BoardKernel> kernels;
  std::vector<KernelCost> costs;  // the same in picoseconds, rounded up

  // Views into this object, which must outlive the table.
  [[nodiscard]] CostTable table() const { return {name, build, sha256, costs}; }
};

// Properties that a program requires of a board file; expected_board() makes it from its graphs.
struct BoardExpectation {
  // A graph that not every cell runs; a board file may omit it.
  struct Optional {
    GraphName graph;
    std::vector<KernelLoops> kernels;
  };
  std::string build;
  std::vector<GraphName> graphs;
  std::vector<KernelLoops> kernels;
  std::vector<Optional> optional;
};

// Use of the costs: by this program on this computer, or for the analysis of another architecture
// (on a desktop).
enum class BoardUse : std::uint8_t { run_here, analyse };

// Throws InputError: file:line: what was found; what was expected.
[[nodiscard]] Board parse_board(const std::string& text, const std::string& file,
                                const BoardExpectation& expected, BoardUse use);

// Loads a built-in board by name, or a file by path.
[[nodiscard]] Board load_board(const std::string& name_or_path, const BoardExpectation& expected,
                               BoardUse use);
[[nodiscard]] std::vector<std::string> built_in_boards();

// Computes `costs` from `kernels`.
void compute_costs(Board& board);

// Text of a board file; parse_board() reads back the same costs.
[[nodiscard]] std::string board_text(const Board& board);

}  // namespace glint

// Board files: what each loop costs on a board, with where the figures come from.
//
//   name = "x86-64-emulated"
//   build = "x86_64 GNU 12.2.0 -O3 .."      # refused by any other build
//   [graphs]                                # refused by any other wiring
//   Tracker = "0x.."
//   Background = "0x.."                     # may be left out, with the costs of its kernels
//   [provenance] ..                         # machine, kernel, governor, date, inputs, margin
//   [system] ..                             # the operating system's share: estimates
//   [kernels.FindBlobs]                     # a count of each loop, in the counter's unit
//   call = 120.0
//
// A file is read against what a program expects, and refused by line where it was made for another
// graph, build or set of loops: a cost of something else is no cost.
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
  double margin_percent = 0;  // already in the costs
};

// Loop by loop in the order of the node's k_loops, in instructions or nanoseconds a count.
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
  double ns_per_instruction = 1;  // 1 where the counter is time
  BoardProvenance provenance;
  SystemShare system;
  std::vector<BoardKernel> kernels;
  std::vector<KernelCost> costs;  // the same in picoseconds, rounded up

  // Views into this board, which must outlive it.
  [[nodiscard]] CostTable table() const { return {name, build, sha256, costs}; }
};

// What a program can use: made from its own graphs by expected_board().
struct BoardExpectation {
  // A graph that not every cell runs: a board need not price it.
  struct Optional {
    GraphName graph;
    std::vector<KernelLoops> kernels;
  };
  std::string build;
  std::vector<GraphName> graphs;
  std::vector<KernelLoops> kernels;
  std::vector<Optional> optional;
};

// Whether the costs are to hold for this very program, or for one like it on another architecture
// (the analysis of a board on a desktop).
enum class BoardUse : std::uint8_t { run_here, analyse };

// Throws InputError: file:line: what was found; what was expected.
[[nodiscard]] Board parse_board(const std::string& text, const std::string& file,
                                const BoardExpectation& expected, BoardUse use);

// One of the built-in boards by name, or a file by its path.
[[nodiscard]] Board load_board(const std::string& name_or_path, const BoardExpectation& expected,
                               BoardUse use);
[[nodiscard]] std::vector<std::string> built_in_boards();

// Fills `costs` from `kernels`.
void price(Board& board);

// As a person would write it; parse_board reads it back to the same costs.
[[nodiscard]] std::string board_text(const Board& board);

}  // namespace glint

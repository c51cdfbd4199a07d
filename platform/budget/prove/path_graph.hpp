// The longest-path problem of one kernel: its basic blocks, edges, calls and loop maxima as numbers
// alone, so that a certificate can be checked without the program.
//
// What:   maximise the executed instructions over all flows from the root's entry. What enters a
//         block leaves it. A function is entered as often as the blocks that call it. A loop jumps
//         back at most `at_most` times for each entry, some loops together `at_most` times.
// Source: Li and Malik 1995, section 3 (implicit path enumeration).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glint::prove {

struct PathBlock {
  int function = 0;
  std::int64_t cost = 0;
  int callee = -1;      // function that it calls
  bool leaves = false;  // the function can end after it
  std::uint64_t address = 0;
  std::string place;  // source line, if known
};

struct PathLoop {
  int header = 0;  // block; the jumps back are the edges to it from blocks that it dominates
  std::int64_t at_most = 0;
};

// Maximum of the jumps back of some loops together, in an activation or for each entry of the loop
// around them; or of the runs of some blocks in an activation.
struct PathTotal {
  enum class Of : std::uint8_t { jumps_back, runs };
  std::vector<int> blocks;  // headers of the loops, or the blocks
  std::int64_t at_most = 0;
  Of of = Of::jumps_back;
  int scope = -1;  // header of the loop around them; negative: an activation
};

struct PathGraph {
  std::string kernel, machine, code_sha256;
  std::vector<std::string> functions;  // callees before their callers: the last one is the root
  std::vector<PathBlock> blocks;       // the first of a function is its entry
  std::vector<std::pair<int, int>> edges;
  std::vector<PathLoop> loops;
  std::vector<PathTotal> totals;
};

// The text that a certificate names by its SHA-256.
[[nodiscard]] std::string text_of(const PathGraph& graph);

// Role of an edge in the loop whose header it reaches.
enum class EdgeRole : std::uint8_t { plain, enters, jumps_back };

// By edge, then by function for the edge that enters it.
struct EdgeRoles {
  std::vector<EdgeRole> edges, entries;
  std::vector<int> loop_of_block;  // loop whose header a block is; -1
  std::vector<int> entry_of_function;
};
[[nodiscard]] EdgeRoles roles_of(const PathGraph& graph);

}  // namespace glint::prove

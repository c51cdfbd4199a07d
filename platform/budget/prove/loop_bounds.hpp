// Declared loop maxima by source line (loops.toml), and which of them a machine loop has.
//
//   [kernels]
//   FindBlobs = ["glint::find_blobs("]      # functions, the first that a program has
//   [loops."kernels/image/blobs.cpp"]
//   "57-71" = { text = "for (const Run& run : runs) {", at_most = "blobs", total.FindBlobs = "runs"
//   }
//
// `at_most`: iterations of one execution of the statement, of names of Limits. `total`: iterations
// in one activation of a kernel, of its loops' worst(limits). A file instead of a statement in the
// code, because any statement there changes how a compiler optimises the loop.
//   [copies."kernels/image/blobs.cpp"]      # bytes of a memcpy, memmove or memset
//   "33" = { text = "std::copy_n(first, count, out);", at_most = "8 * blobs" }
//   [calls."kernels/sort_pairs.hpp"]        # calls of a line in one activation
//   "100" = { text = "detail::sort_rows<32>(values, count);", total.BackProject = "samples / 33" }
//
// `per` and `in_each`: jumps back for each execution of the loop around it that `per` names, as of
// a triangular loop.
//
// A machine loop has an entry if all its instructions come from the lines of the entry or from
// calls inlined there. A jump back to its start must come from the first line, or from that of
// `jumps_from`. `also` lists lines outside, whose instructions a compiler moves into the loop. So
// an entry never serves for a loop that lies inside or outside of its own. `each = true`: the
// maximum holds for each of the nested loops of a statement, as those of a matrix expression.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "platform/budget/prove/expression.hpp"
#include "platform/budget/prove/function_graph.hpp"
#include "platform/budget/prove/source_lines.hpp"

namespace glint::prove {

// A line of a [loops] table, of a [copies] table (`at_most` are bytes there) or of [calls].
struct LoopEntry {
  std::string file;
  int first = 0, last = 0;
  std::vector<std::string> also;        // "file:line" outside, moved into the loop by a compiler
  std::vector<std::string> jumps_from;  // more "file:line" that a jump back may come from
  bool each = false;                    // the maximum is that of each of its nested loops
  bool together = false;                // of all its nested loops, for each entry of the outermost
  std::string text;                     // of the first line, without its indentation
  std::string at_most;                  // "": no maximum of one execution
  std::map<std::string, std::string> total;  // by kernel
  std::string per, in_each;                  // "file:line" of a loop around it; "": none
  std::string place;                         // "loops.toml:12"

  [[nodiscard]] std::string line_text() const { return file + ":" + std::to_string(first); }
};

// Entry of a loop; or, without one, the entry that has a jump back of the loop and not all of its
// instructions, with the first instruction that is outside.
struct LoopMatch {
  const LoopEntry* entry = nullptr;
  const LoopEntry* near = nullptr;
  std::uint64_t outside = 0;
};

class LoopBounds {
 public:
  // Throws InputError. Reads the source files that it names beneath `source_folder`, and rejects an
  // entry whose line has another text.
  LoopBounds(const std::string& file, const std::string& source_folder);

  // Name and functions of each kernel, in the order of the file's text.
  [[nodiscard]] const std::map<std::string, std::vector<std::string>>& kernels() const {
    return kernels_;
  }
  [[nodiscard]] LoopMatch match(const FunctionGraph& graph, const Loop& loop,
                                const SourceLines& lines) const;
  // Entry of a call that copies a computed number of bytes; null if there is none.
  [[nodiscard]] const LoopEntry* entry_of_copy(const std::vector<SourceLine>& frames) const;
  // Entry of a call that an activation makes a limited number of times; null if there is none.
  [[nodiscard]] const LoopEntry* entry_of_call(const std::vector<SourceLine>& frames) const;

 private:
  std::map<std::string, std::vector<std::string>> kernels_;
  std::vector<LoopEntry> loops_, copies_, calls_;
};

}  // namespace glint::prove

// Source lines of machine code, from a program's DWARF line table and its inlined calls.
//
// Source: DWARF 5, sections 3.3.8.2 (inlined subroutines) and 6.2 (line table).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glint::prove {

struct SourceLine {
  std::string file;
  int line = 0;  // 0: unknown
};

class SourceLines {
 public:
  explicit SourceLines(const std::string& program);
  ~SourceLines();
  SourceLines(const SourceLines&) = delete;
  SourceLines& operator=(const SourceLines&) = delete;

  [[nodiscard]] bool empty() const;
  // The instruction's own line first, then that of each call around it that was inlined.
  [[nodiscard]] const std::vector<SourceLine>& of(std::uint64_t address) const;

 private:
  [[nodiscard]] std::vector<SourceLine> read(std::uint64_t address) const;
  struct Dwarf;
  std::unique_ptr<Dwarf> dwarf_;
};

// True if `file` is `project_file` ("kernels/image/blobs.cpp") under any root folder.
[[nodiscard]] bool is_file(const std::string& file, const std::string& project_file);

// "kernels/image/run_writer.hpp:63 in kernels/image/roi_threshold.cpp:83": the lines in the
// project's own code, the innermost first; "" if there is none.
[[nodiscard]] std::string place_text(const std::vector<SourceLine>& frames);

}  // namespace glint::prove

// Text file of complete lines only, renamed to its final name when closed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace glint {

// Buffers lines in memory; write_out() writes them in one piece. A device or pipe is written
// directly, without a temporary file.
class LineFile {
 public:
  // Throws InputError, with the file's name, if it cannot be created.
  explicit LineFile(std::filesystem::path file);
  // Writes the remaining lines and renames the file.
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  // Adds one line with its newline. After a write error, lines are only counted.
  void add(std::string_view line) noexcept;
  // Writes the buffered lines to the file.
  void write_out() noexcept;
  // Lines that did not reach the disk.
  [[nodiscard]] std::uint64_t lines_lost() const noexcept { return lines_lost_; }
  // errno of the failed write; 0: none failed.
  [[nodiscard]] int error() const noexcept { return error_; }

 private:
  void truncate_to_complete_lines(std::string_view unwritten) noexcept;

  std::filesystem::path file_;
  std::filesystem::path written_as_;
  int descriptor_ = -1;
  bool failed_ = false;
  int error_ = 0;
  std::int64_t bytes_ = 0;  // on disk, complete lines only
  std::uint64_t lines_lost_ = 0;
  std::string buffered_;
};

}  // namespace glint

// A text file that holds whole lines only, and appears under its own name when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace glint {

// Gathers lines in memory; write_out() writes them in one piece. What is no regular file (a device,
// a pipe) is written directly, without the temporary.
class LineFile {
 public:
  // Throws InputError naming the file where it cannot be made.
  explicit LineFile(std::filesystem::path file);
  // Writes the rest and gives the file its name.
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  // One line with its newline. Once the disk has refused, lines are only counted.
  void add(std::string_view line) noexcept;
  // Hands what was gathered to the system.
  void write_out() noexcept;
  // Lines that did not reach the disk.
  [[nodiscard]] std::uint64_t lines_lost() const noexcept { return lines_lost_; }
  // errno of the write that failed; 0: none did.
  [[nodiscard]] int error() const noexcept { return error_; }

 private:
  void give_up(std::string_view unwritten) noexcept;

  std::filesystem::path file_;
  std::filesystem::path written_as_;
  int descriptor_ = -1;
  bool failed_ = false;
  int error_ = 0;
  std::int64_t bytes_ = 0;  // on disk, whole lines only
  std::uint64_t lines_lost_ = 0;
  std::string gathered_;
};

}  // namespace glint

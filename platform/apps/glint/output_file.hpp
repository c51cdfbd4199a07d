// Output files of a command, written completely or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "platform/part_file.hpp"

namespace glint {

// Creates the file's folder. Throws InputError if the file cannot be written.
void write_text(const std::string& path, const std::string& text);

// --json FILE: the figures of the table. An empty path writes nothing.
void write_json(const std::string& path, const nlohmann::ordered_json& figures);

// Prints one line per failure, an unreadable part of the input, on standard error. Returns the exit
// code: 1, or 0 if there is none.
[[nodiscard]] int report_losses(const std::vector<std::string>& failures);

// Text file that is written line by line beside its final path; finish() gives it its name. A path
// that is not a regular file is written in place.
class LineWriter {
 public:
  // Creates the folder. Throws InputError if the file cannot be created.
  explicit LineWriter(const std::string& path);
  // Removes an unfinished file.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  // `line` without its newline. add() and finish() throw InputError if a write fails.
  void add(std::string_view line);
  void finish();

 private:
  void write_out();
  [[noreturn]] void fail() const;

  std::string path_;
  bool in_place_;
  PartFile part_;
  std::string waiting_;
};

// Create the folder of a file, or a folder. Both throw InputError on failure.
void make_folder_of(const std::string& path);
void make_folder(const std::string& path);

// Disk space reserved for a file that is written last, so that earlier output cannot use it.
class ReservedDiskSpace {
 public:
  // Reserves beside `path`; nothing for an empty path or a file system without support.
  explicit ReservedDiskSpace(const std::string& path);
  ~ReservedDiskSpace() { release(); }
  ReservedDiskSpace(const ReservedDiskSpace&) = delete;
  ReservedDiskSpace& operator=(const ReservedDiskSpace&) = delete;

  void release() noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace glint

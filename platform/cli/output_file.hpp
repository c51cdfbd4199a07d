// Files that a command leaves behind, written whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "platform/part_file.hpp"

namespace glint {

// Throws InputError where the file cannot be written; its folder is made.
void write_text(const std::string& path, const std::string& text);

// --json FILE: the figures of the table. An empty path writes nothing.
void write_json(const std::string& path, const nlohmann::ordered_json& figures);

// What of a command's input could not be read: a line each on standard error. The exit code: 1, or
// 0 where nothing was lost.
[[nodiscard]] int report_losses(const std::vector<std::string>& failures);

// A text file that grows line by line beside its final path and gets its name in finish(). What is
// no regular file is written in place.
class GrowingText {
 public:
  // Makes its folder. Throws InputError where the file cannot be made.
  explicit GrowingText(const std::string& path);
  // Removes what is not finished.
  ~GrowingText();
  GrowingText(const GrowingText&) = delete;
  GrowingText& operator=(const GrowingText&) = delete;

  // The line without its newline. Both throw InputError where the system refuses a write.
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

// Makes the folder a file is to be in. Throws InputError where that cannot be.
void make_folder_of(const std::string& path);
void make_folder(const std::string& path);

// Room on the disk for a file that is written last: what fills the disk in between leaves it free.
class ReservedRoom {
 public:
  // Beside `path`; an empty path, or a file system that cannot do this, reserves nothing.
  explicit ReservedRoom(const std::string& path);
  ~ReservedRoom() { release(); }
  ReservedRoom(const ReservedRoom&) = delete;
  ReservedRoom& operator=(const ReservedRoom&) = delete;

  void release() noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace glint

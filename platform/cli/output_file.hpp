// Files that a command leaves behind, written whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint {

// Throws InputError where the file cannot be written; its folder is made.
void write_text(const std::string& path, const std::string& text);

// --json FILE: the figures of the table. An empty path writes nothing.
void write_json(const std::string& path, const nlohmann::ordered_json& figures);

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

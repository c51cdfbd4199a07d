// A file that only grows, has room kept for its ending, and gets its name when it is whole.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "kernels/units.hpp"
#include "platform/record/file_sync.hpp"

namespace glint {

class GrowingFile {
 public:
  // Makes a new PATH.part (part_file.hpp). Throws InputError with the system's words.
  explicit GrowingFile(std::string path);
  ~GrowingFile();  // leaves part_path() behind unless name() succeeded
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // Takes room on the disk for that many bytes from the end on, without growing the file. False:
  // there is none, and error() says so. A file system that cannot do this lets every call pass.
  [[nodiscard]] bool reserve(std::uint64_t bytes);

  // From now on a thread of its own brings the file to the disk once a period (fdatasync).
  void sync_every(Duration period) { sync_.emplace(descriptor_, period); }

  // All parts or nothing: after a failure the file ends where it ended before.
  [[nodiscard]] bool append(std::initializer_list<std::span<const std::uint8_t>> parts);

  // Gives back room not used, waits until the disk has it all, gives the file its name.
  [[nodiscard]] bool name();

  [[nodiscard]] const std::string& part_path() const { return part_path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint32_t crc() const { return crc_; }  // of all bytes so far
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  bool write_pieces(std::span<const std::uint8_t> bytes);
  bool check_sync();
  bool fail(const char* doing, int error);

  std::string path_, part_path_, error_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t reserved_end_ = 0;
  std::uint32_t crc_ = 0;
  std::optional<FileSync> sync_;
};

}  // namespace glint

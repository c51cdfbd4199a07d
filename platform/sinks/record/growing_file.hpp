// Append-only file with space reserved for its ending, renamed to its final name when complete.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "kernels/units.hpp"
#include "platform/sinks/record/file_sync.hpp"

namespace glint {

class GrowingFile {
 public:
  // Creates a new PATH.part (part_file.hpp). Throws InputError with the system's message.
  explicit GrowingFile(std::string path);
  ~GrowingFile();  // keeps part_path() unless finish() succeeded
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // Reserves disk space for that many bytes from the end, without growing the file. Returns false,
  // with error(), if there is none. Always true on a file system without this function.
  [[nodiscard]] bool reserve(std::uint64_t bytes);

  // Starts a thread that synchronises the file to the disk once per period (fdatasync).
  void sync_every(Duration period) { sync_.emplace(descriptor_, period); }

  // Appends all parts or none: after a failure the file is cut back to its previous end.
  [[nodiscard]] bool append(std::initializer_list<std::span<const std::uint8_t>> parts);

  // Releases unused space, waits for the disk, and renames the file.
  [[nodiscard]] bool finish();

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

// A file that only grows, has room kept for its ending, and gets its name when it is whole.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

namespace glint {

class GrowingFile {
 public:
  // Makes PATH.part. Throws InputError with the system's words.
  explicit GrowingFile(std::string path);
  ~GrowingFile();  // leaves PATH.part behind unless name() succeeded
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // Takes room on the disk for that many bytes from the end on, without growing the file. False:
  // there is none, and error() says so. A file system that cannot do this lets every call pass.
  [[nodiscard]] bool reserve(std::uint64_t bytes);

  // All parts or nothing: after a failure the file ends where it ended before.
  [[nodiscard]] bool append(std::initializer_list<std::span<const std::uint8_t>> parts);

  // Gives back room not used, waits until the disk has it all, renames PATH.part to PATH.
  [[nodiscard]] bool name();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint32_t crc() const { return crc_; }  // of all bytes so far
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  bool write_all(std::span<const std::uint8_t> bytes);
  bool fail(const char* doing, int error);

  std::string path_, part_path_, error_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t reserved_end_ = 0;
  std::uint32_t crc_ = 0;
};

}  // namespace glint

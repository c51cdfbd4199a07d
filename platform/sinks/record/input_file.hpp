// File for random-access reads; errors state the file and the byte.
#pragma once

#include <cstdint>
#include <string>

#include "platform/sinks/record/bytes.hpp"

namespace glint {

class InputFile {
 public:
  // Throws InputError.
  explicit InputFile(std::string path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Reads exactly `count` bytes from `offset`, which must be inside the file; reuses `bytes`.
  void read(std::uint64_t offset, std::uint64_t count, Bytes& bytes) const;

  // Throws InputError("path:byte N: found; expected ...").
  [[noreturn]] void refuse(std::uint64_t offset, const std::string& found,
                           const std::string& expected) const;

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace glint

// Line reader of a file with text lines and optional trailing bytes; errors name file and line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glint {

class FileText {
 public:
  // Throws InputError like read_file (k_data_bytes_max).
  FileText(std::string path, const std::string& expected);

  // Reads the next line, split at blanks. Returns false at the end of the file.
  [[nodiscard]] bool next_line(std::vector<std::string_view>& words);
  // All bytes after the lines read.
  [[nodiscard]] std::string_view rest() const { return std::string_view(bytes_).substr(at_); }
  [[nodiscard]] std::size_t position() const { return at_; }

  // Parses a complete word as a number (finite, infinite or NaN), or as a count up to `maximum`.
  // Throws InputError naming the line.
  [[nodiscard]] double number(std::string_view word) const;
  [[nodiscard]] std::size_t count(std::string_view word, std::size_t maximum) const;

  // Throws InputError("path:line N: found; expected ...").
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace glint

// A file with lines of text, and perhaps bytes behind them; whatever is wrong names file and place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glint {

class FileText {
 public:
  // Throws InputError as read_file does (k_data_bytes_max).
  FileText(std::string path, const std::string& expected);

  // The next line without its end, split at blanks. False: none is left.
  [[nodiscard]] bool next_line(std::vector<std::string_view>& words);
  // All that is behind the lines read.
  [[nodiscard]] std::string_view rest() const { return std::string_view(bytes_).substr(at_); }
  [[nodiscard]] std::size_t position() const { return at_; }

  // A whole word as a finite or infinite number or NaN, or as a count up to `most`.
  // Throw InputError naming the line.
  [[nodiscard]] double number(std::string_view word) const;
  [[nodiscard]] std::size_t count(std::string_view word, std::size_t most) const;

  // Throws InputError("path:line N: found; expected ...").
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace glint

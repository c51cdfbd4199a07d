#include "platform/tools/mapping/file_text.hpp"

#include <algorithm>
#include <charconv>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr std::size_t k_word_shown = 40;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string shown(std::string_view word) {
  return '"' + std::string(word.substr(0, k_word_shown)) + '"';
}

}  // namespace

FileText::FileText(std::string path, const std::string& expected)
    : path_(std::move(path)), bytes_(read_file(path_, k_data_bytes_max, expected)) {}

bool FileText::next_line(std::vector<std::string_view>& words) {
  words.clear();
  if (at_ >= bytes_.size()) return false;
  ++line_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  for (std::size_t i = at_; i < end;) {
    while (i < end && is_blank(bytes_[i])) ++i;
    const std::size_t first = i;
    while (i < end && !is_blank(bytes_[i])) ++i;
    if (i > first) words.emplace_back(bytes_.data() + first, i - first);
  }
  at_ = std::min(end + 1, bytes_.size());
  return true;
}

double FileText::number(std::string_view word) const {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) refuse(shown(word), "a number");
  return value;
}

std::size_t FileText::count(std::string_view word, std::size_t maximum) const {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || value > maximum) {
    refuse(shown(word), "a count up to " + std::to_string(maximum));
  }
  return value;
}

void FileText::refuse(const std::string& found, const std::string& expected) const {
  throw InputError(path_ + ":line " + std::to_string(line_) + ": " + found + "; expected " +
                   expected);
}

}  // namespace glint

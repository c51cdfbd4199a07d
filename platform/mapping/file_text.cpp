#include "platform/mapping/file_text.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::uintmax_t k_bytes_max = std::uintmax_t{1} << 30;
constexpr std::size_t k_word_shown = 40;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string shown(std::string_view word) {
  return '"' + std::string(word.substr(0, k_word_shown)) + '"';
}

}  // namespace

FileText::FileText(std::string path, const std::string& expected) : path_(std::move(path)) {
  if (!std::filesystem::is_regular_file(path_)) {
    throw InputError(path_ + ": is no file; expected " + expected);
  }
  const std::uintmax_t size = std::filesystem::file_size(path_);
  if (size > k_bytes_max) {
    throw InputError(path_ + ": " + std::to_string(size) + " bytes; expected at most " +
                     std::to_string(k_bytes_max));
  }
  std::ifstream file(path_, std::ios::binary);
  bytes_.resize(static_cast<std::size_t>(size));
  if (!file.read(bytes_.data(), static_cast<std::streamsize>(size))) {
    throw InputError(path_ + ": cannot be read; expected " + expected);
  }
}

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

std::size_t FileText::count(std::string_view word, std::size_t most) const {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || value > most) {
    refuse(shown(word), "a count up to " + std::to_string(most));
  }
  return value;
}

void FileText::refuse(const std::string& found, const std::string& expected) const {
  throw InputError(path_ + ":line " + std::to_string(line_) + ": " + found + "; expected " +
                   expected);
}

}  // namespace glint

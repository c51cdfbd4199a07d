#include "platform/cells/toml_keys.hpp"

#include <algorithm>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t k_end = std::string_view::npos;

// Returns the position after the string that begins at `at` with a quote. Returns the end of the
// line for an unterminated string, which the parser refuses.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool basic = quote == '"';
  const std::string closing(text.substr(at, 3) == std::string(3, quote) ? 3 : 1, quote);
  for (std::size_t i = at + closing.size(); i < text.size(); ++i) {
    if (basic && text[i] == '\\') {
      ++i;
    } else if (closing.size() == 1 && text[i] == '\n') {
      return i;
    } else if (text.substr(i, closing.size()) == closing) {
      i += closing.size();
      // Of five quotes the first two belong to the text.
      for (int more = 0; closing.size() == 3 && more < 2 && i < text.size() && text[i] == quote;) {
        ++i, ++more;
      }
      return i;
    }
  }
  return text.size();
}

}  // namespace

void check_key_parts(std::string_view text, const std::string& file) {
  std::size_t dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (std::string_view("=,[]{}\n").find(c) != k_end) dots = 0;
    if (c == '.' && ++dots == k_toml_key_parts_max) {
      const auto line =
          1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
      throw InputError(file + ":" + std::to_string(line) + ": a key of more than " +
                       std::to_string(k_toml_key_parts_max) + " parts; expected a shorter key");
    }
    ++i;
  }
}

}  // namespace glint

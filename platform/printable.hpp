// Sanitises text from files and the network for display in error messages, tables, HTML and SVG.
// Control characters would move the cursor, rewrite lines or change the direction of the text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace glint {

// Returns the number of bytes of the UTF-8 character at the start of `text`; 0 if it is not valid
// UTF-8. Unicode 15, table 3-7: overlong forms and surrogates are invalid.
[[nodiscard]] inline std::size_t utf8_character(std::string_view text, char32_t& character) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  character = first;
  if (first < 0x80) return 1;
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < size) return 0;
  character = first & (0xFFu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    character = character << 6 | (byte(i) & 0x3Fu);
  }
  constexpr char32_t code_point_min[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  return character < code_point_min[size] || character > 0x10FFFF || surrogate ? 0 : size;
}

// Whether a terminal shows the character as a glyph or a blank, without reordering the text.
[[nodiscard]] inline bool is_printable(char32_t c) {
  const auto within = [c](char32_t low, char32_t high) { return c >= low && c <= high; };
  const bool control = c < 0x20 || within(0x7F, 0x9F);
  const bool invisible_or_bidi_control = c == 0x61C || within(0x200B, 0x200F) ||
                                         within(0x2028, 0x202E) || within(0x2060, 0x206F) ||
                                         c == 0xFEFF || within(0xFFF9, 0xFFFB);
  return !control && !invisible_or_bidi_control;
}

// Returns one line: '?' replaces each character that is_printable rejects and each byte that is not
// valid UTF-8.
[[nodiscard]] inline std::string printable(std::string_view untrusted) {
  std::string clean;
  clean.reserve(untrusted.size());
  while (!untrusted.empty()) {
    char32_t character = 0;
    const std::size_t size = utf8_character(untrusted, character);
    if (size == 0 || !is_printable(character)) {
      clean += '?';
    } else {
      clean += untrusted.substr(0, size);
    }
    untrusted.remove_prefix(size == 0 ? 1 : size);
  }
  return clean;
}

// printable() per line, for a table: keeps line feeds.
[[nodiscard]] inline std::string printable_lines(std::string_view untrusted) {
  std::string clean;
  for (std::size_t end = 0; (end = untrusted.find('\n')) != std::string_view::npos;) {
    clean += printable(untrusted.substr(0, end)) + '\n';
    untrusted.remove_prefix(end + 1);
  }
  return clean + printable(untrusted);
}

// printable_lines(), escaped for HTML, XML or SVG, between tags or in a double-quoted attribute.
// Line feeds are kept; they render as blanks.
[[nodiscard]] inline std::string printable_markup(std::string_view untrusted) {
  std::string text;
  for (const char c : printable_lines(untrusted)) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      case '"':
        text += "&quot;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

}  // namespace glint

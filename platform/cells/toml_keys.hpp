// Bounds how deep the tables of a TOML text are nested, before it is parsed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glint {

// toml++ makes a table of every part of a.b.c, without a limit, and destroys them by recursion: a
// megabyte of "a." overflows the stack. Its nested arrays and inline tables it limits itself.
inline constexpr std::size_t k_toml_key_parts_max = 64;

// Throws InputError: file:line, where a key has more parts. Dots in strings and comments are none.
void check_key_parts(std::string_view text, const std::string& file);

}  // namespace glint

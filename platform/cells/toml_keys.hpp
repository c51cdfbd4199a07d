// Limits the nesting of TOML tables before the text is parsed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glint {

// toml++ makes a table of every part of a.b.c, without a limit, and destroys them by recursion: a
// megabyte of "a." overflows the stack. It limits nested arrays and inline tables itself.
inline constexpr std::size_t k_toml_key_parts_max = 64;

// Throws InputError with file:line if a key has more parts. Ignores dots in strings and comments.
void check_key_parts(std::string_view text, const std::string& file);

}  // namespace glint

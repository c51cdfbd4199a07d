// Whole-number expressions of a loop's maximum: "2 * blobs + 1".
//
// Operators: + - * / and parentheses; a quotient is rounded up. Numbers and results are below 2^53.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace glint::prove {

using NamedCounts = std::map<std::string, std::int64_t, std::less<>>;

// Throws InputError with `place` for a syntax error, an unknown name or a negative result.
[[nodiscard]] std::int64_t value_of(std::string_view expression, const NamedCounts& names,
                                    const std::string& place);

}  // namespace glint::prove

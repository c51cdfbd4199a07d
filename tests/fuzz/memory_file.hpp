// A file in memory with a path, for readers that open their file themselves.
#pragma once

#include <string>

#include "tests/fuzz/fuzz_target.hpp"

namespace glint::fuzz {

// Returns the path of a file with these bytes and this ending of its name ("" or ".png"). Valid
// until the next call with the same ending.
[[nodiscard]] std::string file_of(Bytes bytes, const std::string& ending = "");

}  // namespace glint::fuzz

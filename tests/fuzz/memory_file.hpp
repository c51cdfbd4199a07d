// A file in memory with a path, for readers that open their file themselves.
#pragma once

#include <string>

#include "tests/fuzz/fuzz_target.hpp"

namespace glint::fuzz {

// The path of a file that holds these bytes and whose name has this ending ("" or ".png"). Valid
// until the next call with the same ending.
[[nodiscard]] std::string file_of(Bytes bytes, const std::string& ending = "");

}  // namespace glint::fuzz

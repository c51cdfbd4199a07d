// Arrays as NumPy saves them: little-endian float32 in C order, nothing else.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace glint {

struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

// Throws InputError naming the file, the place and what was expected.
[[nodiscard]] NpyArray read_npy_float32(const std::string& path);

// The file that read_npy_float32 reads back.
[[nodiscard]] std::string npy_float32_bytes(const NpyArray& array);

}  // namespace glint

// Arrays as NumPy saves them, little-endian and in C order.
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

struct NpyNumbers {
  std::vector<std::size_t> shape;
  std::vector<double> values;
  bool integer = false;  // as they stand in the file
};

// The same for float32, float64 and unsigned integers of 8 and 16 bit.
[[nodiscard]] NpyNumbers read_npy_numbers(const std::string& path);

// The file that read_npy_float32 reads back.
[[nodiscard]] std::string npy_float32_bytes(const NpyArray& array);

}  // namespace glint

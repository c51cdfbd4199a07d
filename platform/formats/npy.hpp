// Reader and writer of NumPy arrays (.npy), little-endian and in C order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace glint {

struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

// Throws InputError that names the file, the position and the expectation.
[[nodiscard]] NpyArray read_npy_float32(const std::string& path);

struct NpyNumbers {
  std::vector<std::size_t> shape;
  std::vector<double> values;
  bool integer = false;  // integers in the file
};

// Same for float32, float64 and unsigned integers of 8 and 16 bit.
[[nodiscard]] NpyNumbers read_npy_numbers(const std::string& path);

// Returns the bytes of a file for read_npy_float32.
[[nodiscard]] std::string npy_float32_bytes(const NpyArray& array);

}  // namespace glint

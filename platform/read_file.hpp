// Reads a whole file, up to a size limit: a device never ends. Rejects a folder.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "platform/input_error.hpp"

namespace glint {

inline constexpr std::size_t k_text_bytes_max = 64 << 20;  // text files
inline constexpr std::size_t k_data_bytes_max = 1 << 30;   // measured data

// Throws InputError with the path if the file is absent, a folder, unreadable, or longer than
// `bytes_max`.
[[nodiscard]] inline std::string read_file(const std::string& path, std::size_t bytes_max,
                                           const std::string& expected) {
  std::error_code failed;
  const bool folder = std::filesystem::is_directory(path, failed);
  std::ifstream file(path, std::ios::binary);
  if (!file || folder) {
    throw InputError(path + ": " + (folder ? "is a folder" : "cannot be read") + "; expected " +
                     expected);
  }
  std::string bytes;
  std::array<char, 1 << 16> part;
  while (file.read(part.data(), part.size()), file.gcount() > 0) {
    bytes.append(part.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > bytes_max) {
      throw InputError(path + ": longer than " + std::to_string(bytes_max) + " bytes; expected " +
                       expected);
    }
  }
  if (file.bad()) throw InputError(path + ": cannot be read; expected " + expected);
  return bytes;
}

}  // namespace glint

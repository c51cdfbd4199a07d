// The files inside a tar archive (POSIX ustar, GNU long names), by their places in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/record/input_file.hpp"

namespace glint {

struct TarEntry {
  std::string name;
  std::uint64_t offset = 0, bytes = 0;  // of its contents in the archive
};

inline constexpr std::size_t k_tar_entries_max = 2'000'000;

// The regular files, in the archive's order. An archive that was cut short ends at its last whole
// file; `cut_bytes` are those behind it. Throws InputError: path, byte, found, expected.
[[nodiscard]] std::vector<TarEntry> tar_entries(const InputFile& archive, std::uint64_t& cut_bytes);

}  // namespace glint

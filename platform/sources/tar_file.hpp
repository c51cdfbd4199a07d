// Lists the files in a tar archive (POSIX ustar, GNU long names), with offset and size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/sinks/record/input_file.hpp"

namespace glint {

struct TarEntry {
  std::string name;
  std::uint64_t offset = 0, bytes = 0;  // of its contents in the archive
};

inline constexpr std::size_t k_tar_entries_max = 2'000'000;

// Returns the regular files in the archive's order. A truncated archive ends at its last complete
// file; `truncated_bytes` receives the bytes after it. Throws InputError: path, byte, found,
// expected.
[[nodiscard]] std::vector<TarEntry> tar_entries(const InputFile& archive,
                                                std::uint64_t& truncated_bytes);

}  // namespace glint

#include "platform/sources/tar_file.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace glint {
namespace {

constexpr std::uint64_t k_block = 512;
// Header fields: offset and length.
constexpr std::size_t k_name_length = 100, k_size = 124, k_size_length = 12;
constexpr std::size_t k_sum = 148, k_sum_length = 8, k_type = 156, k_prefix = 345,
                      k_prefix_length = 155;
constexpr std::uint64_t k_name_bytes_max = 4096;

std::string text_at(const Bytes& header, std::size_t offset, std::size_t length) {
  const char* from = reinterpret_cast<const char*>(header.data()) + offset;
  return {from, ::strnlen(from, length)};
}

// Parses octal digits, surrounded by blanks and terminated by NUL or blank.
std::optional<std::uint64_t> octal_at(const Bytes& header, std::size_t offset, std::size_t length) {
  std::uint64_t value = 0;
  bool any = false;
  for (std::size_t i = offset; i < offset + length; ++i) {
    if (header[i] >= '0' && header[i] <= '7') {
      value = value << 3 | static_cast<std::uint64_t>(header[i] - '0');
      any = true;
    } else if (header[i] == 0 || header[i] == ' ') {
      if (any) break;
    } else {
      return std::nullopt;
    }
  }
  return any ? std::optional(value) : std::nullopt;
}

// Checks the header's sum of all bytes, with blanks in place of the sum's own field.
bool sum_holds(const Bytes& header) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < header.size(); ++i) {
    sum += i >= k_sum && i < k_sum + k_sum_length ? ' ' : header[i];
  }
  return octal_at(header, k_sum, k_sum_length) == sum;
}

}  // namespace

std::vector<TarEntry> tar_entries(const InputFile& archive, std::uint64_t& truncated_bytes) {
  std::vector<TarEntry> entries;
  std::string long_name;
  Bytes header;
  std::uint64_t at = 0;
  truncated_bytes = 0;
  while (archive.size() - at >= k_block) {
    archive.read(at, k_block, header);
    if (std::all_of(header.begin(), header.end(), [](std::uint8_t b) { return b == 0; })) {
      return entries;
    }
    const auto bytes = octal_at(header, k_size, k_size_length);
    if (!bytes || !sum_holds(header)) {
      archive.refuse(at, "no tar header", "a tar archive");
    }
    const std::uint64_t contents = at + k_block;
    if (*bytes > archive.size() - contents) break;
    const char type = static_cast<char>(header[k_type]);
    if (type == 'L' && *bytes <= k_name_bytes_max) {
      Bytes name;
      archive.read(contents, *bytes, name);
      long_name.assign(name.begin(), std::find(name.begin(), name.end(), 0));
    } else {
      const std::string prefix = std::memcmp(header.data() + 257, "ustar\0", 6) == 0
                                     ? text_at(header, k_prefix, k_prefix_length)
                                     : "";
      std::string name = text_at(header, 0, k_name_length);
      if (!prefix.empty()) name = prefix + "/" + name;
      if (!long_name.empty()) name = std::exchange(long_name, "");
      if (type == '0' || type == 0) entries.push_back({std::move(name), contents, *bytes});
      if (entries.size() > k_tar_entries_max) {
        archive.refuse(at, "more than " + std::to_string(k_tar_entries_max) + " files", "fewer");
      }
    }
    const std::uint64_t whole = contents + (*bytes + k_block - 1) / k_block * k_block;
    if (whole > archive.size()) return entries;  // only the padding of the last file is missing
    at = whole;
  }
  truncated_bytes = archive.size() - at;
  return entries;
}

}  // namespace glint

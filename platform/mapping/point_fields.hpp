// The fields of a point as a file declares them, and its points read by them.
#pragma once

#include <string>
#include <vector>

#include "platform/mapping/file_text.hpp"
#include "platform/mapping/host_cloud.hpp"

namespace glint {

struct PointField {
  std::string name;
  char kind = 'F';       // F floating, I signed, U unsigned
  std::size_t size = 4;  // bytes: 1, 2, 4, 8
  std::size_t count = 1;
};

// Fields x, y, z, and normal_x, normal_y, normal_z or nx, ny, nz where they are.
// ascii: a point a line; binary: one behind the other, little-endian, all in `rest()`; compressed:
// how many bytes follow and how many they unpack to, four bytes each, then LZF of all points' first
// field, then of their second, and so on.
// Throw InputError: no x, y, z, too few lines, words or bytes. No memory is taken for points that
// the file is too small for.
[[nodiscard]] HostCloud read_ascii_points(FileText& file, const std::vector<PointField>& fields,
                                          std::size_t points);
[[nodiscard]] HostCloud read_binary_points(const FileText& file,
                                           const std::vector<PointField>& fields,
                                           std::size_t points);
[[nodiscard]] HostCloud read_compressed_points(const FileText& file,
                                               const std::vector<PointField>& fields,
                                               std::size_t points);

}  // namespace glint

// Point fields as declared by a file header, and readers of points with them.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/mapping/file_text.hpp"
#include "platform/tools/mapping/host_cloud.hpp"

namespace glint {

struct PointField {
  std::string name;
  char kind = 'F';       // F floating, I signed, U unsigned
  std::size_t size = 4;  // bytes: 1, 2, 4, 8
  std::size_t count = 1;
};

// Reads fields x, y, z, and normal_x, normal_y, normal_z or nx, ny, nz if present. ascii: one point
// per line. binary: contiguous little-endian records in `rest()`. compressed: packed and unpacked
// size in bytes, four bytes each, then LZF of all points' first field, of their second, and so on.
// Throws InputError for missing x, y, z and for too few lines, words or bytes. Allocates no memory
// for points that the file is too small for.
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

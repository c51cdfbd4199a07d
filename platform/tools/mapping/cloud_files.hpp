// Point cloud files: PLY and PCD, text or binary.
//
// Reads PLY 1.0 (ascii, binary_little_endian; vertices first, further elements ignored) and PCD 0.7
// (ascii, binary, binary_compressed). Units: metres. Reads normals if present and ignores other
// fields. Keeps points that are not finite, as NaN; kernels drop and count them. Writes binary,
// with normals if present, to a temporary file that is then renamed.
#pragma once

#include <string>

#include "platform/tools/mapping/host_cloud.hpp"

namespace glint {

// By extension, .ply or .pcd. Throws InputError naming file, line, found and expected.
[[nodiscard]] HostCloud read_cloud(const std::string& path);
// Throws InputError for another extension or if the file cannot be written.
void write_cloud(const std::string& path, const HostCloud& cloud);

[[nodiscard]] HostCloud read_ply(const std::string& path);
[[nodiscard]] HostCloud read_pcd(const std::string& path);

}  // namespace glint

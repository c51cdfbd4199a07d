// Clouds in files: PLY and PCD, text or binary.
//
// Read: PLY 1.0 (ascii, binary_little_endian; vertices first, further elements are passed over) and
// PCD 0.7 (ascii, binary, binary_compressed); metres; normals where there are some, other fields
// are passed over. Points that are not finite stay in, as NaN: kernels leave them out and count
// them. Written: binary, with normals if there are some; to a temporary file first, then renamed.
#pragma once

#include <string>

#include "platform/mapping/host_cloud.hpp"

namespace glint {

// By the ending, .ply or .pcd. Throws InputError naming file, line, what was found and expected.
[[nodiscard]] HostCloud read_cloud(const std::string& path);
// Throws InputError: another ending, or the file cannot be written.
void write_cloud(const std::string& path, const HostCloud& cloud);

[[nodiscard]] HostCloud read_ply(const std::string& path);
[[nodiscard]] HostCloud read_pcd(const std::string& path);

}  // namespace glint

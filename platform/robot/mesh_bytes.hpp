// What glint_mesh_reader writes and read_mesh takes: the triangles of one mesh file, or the reason
// why there are none.
//
//   u8   'M'  then u32 skipped, u32 count, count * 9 float32 (corners a, b, c)
//   u8   'E'  then the reason as text
// In the byte order of the machine that both run on.
#pragma once

#include <string>
#include <string_view>

#include "platform/robot/mesh_file.hpp"

namespace glint {

[[nodiscard]] std::string mesh_bytes(const Mesh& mesh);
[[nodiscard]] std::string mesh_error_bytes(std::string_view reason);

// Throws InputError naming the mesh's file `path`: with the reason, or where the bytes are neither.
[[nodiscard]] Mesh mesh_of_bytes(std::string_view bytes, const std::string& path);

}  // namespace glint

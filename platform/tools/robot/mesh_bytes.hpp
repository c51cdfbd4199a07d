// Byte format from glint_mesh_reader to read_mesh: the triangles of one mesh file, or an error.
//
//   u8   'M'  then u32 skipped, u32 count, count * 9 float32 (corners a, b, c)
//   u8   'E'  then the error as text
// Byte order: that of the machine that both run on.
#pragma once

#include <string>
#include <string_view>

#include "platform/tools/robot/mesh_file.hpp"

namespace glint {

[[nodiscard]] std::string mesh_bytes(const Mesh& mesh);
[[nodiscard]] std::string mesh_error_bytes(std::string_view reason);

// Throws InputError naming the mesh's file `path`, with the error, or for bytes of another format.
[[nodiscard]] Mesh mesh_of_bytes(std::string_view bytes, const std::string& path);

}  // namespace glint

#include "platform/tools/robot/mesh_bytes.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t k_head_bytes = 1 + 2 * sizeof(std::uint32_t);
using Corners = std::array<float, 9>;

}  // namespace

std::string mesh_bytes(const Mesh& mesh) {
  const std::uint32_t head[] = {static_cast<std::uint32_t>(mesh.skipped),
                                static_cast<std::uint32_t>(mesh.triangles.size())};
  std::string bytes(1, 'M');
  bytes.append(reinterpret_cast<const char*>(head), sizeof head);
  for (const Triangle& t : mesh.triangles) {
    const Corners corners = {t.a.x(), t.a.y(), t.a.z(), t.b.x(), t.b.y(),
                             t.b.z(), t.c.x(), t.c.y(), t.c.z()};
    bytes.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
  }
  return bytes;
}

std::string mesh_error_bytes(std::string_view reason) {
  std::string bytes(1, 'E');
  return bytes.append(reason);
}

Mesh mesh_of_bytes(std::string_view bytes, const std::string& path) {
  if (bytes.starts_with('E')) throw InputError(path + ": " + std::string(bytes.substr(1)));
  std::array<std::uint32_t, 2> head{};
  if (bytes.size() >= k_head_bytes) std::memcpy(head.data(), bytes.data() + 1, sizeof head);
  const std::size_t count = head[1];
  if (!bytes.starts_with('M') || count > k_mesh_triangles_max ||
      bytes.size() != k_head_bytes + count * sizeof(Corners)) {
    throw InputError(path + ": its reader wrote " + std::to_string(bytes.size()) +
                     " bytes of an invalid mesh; expected a mesh of a robot's link");
  }
  Mesh mesh;
  mesh.skipped = static_cast<int>(head[0] & 0x7FFFFFFFu);
  mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Corners v{};
    std::memcpy(v.data(), bytes.data() + k_head_bytes + i * sizeof v, sizeof v);
    const Triangle triangle{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
    if (!triangle.a.allFinite() || !triangle.b.allFinite() || !triangle.c.allFinite()) {
      throw InputError(path + ": triangle " + std::to_string(i) +
                       " is not finite; expected metres");
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace glint

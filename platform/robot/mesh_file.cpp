#include "platform/robot/mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::uintmax_t k_mesh_bytes_max = 256u << 20;
constexpr int k_nodes_deep_max = 64;
// A link of ten metres is a crane's; one of a millimetre is nobody's.
constexpr double k_extent_max_m = 10, k_extent_min_m = 1e-3;
// Corners of real meshes are a tenth of a millimetre apart or more: this is a line or a point.
constexpr double k_area_min_m2 = 1e-12;

// A binary STL says how many triangles it has: believed only where the file is as long.
void check_binary_stl(const std::string& path, std::uintmax_t size) {
  std::ifstream file(path, std::ios::binary);
  char head[84] = {};
  file.read(head, sizeof head);
  if (file.gcount() < 6) throw InputError(path + ": too short; expected an STL mesh");
  if (std::strncmp(head, "solid", 5) == 0 || size < sizeof head) return;
  std::uint32_t count = 0;
  std::memcpy(&count, head + 80, sizeof count);
  const std::uintmax_t expected = sizeof head + std::uintmax_t{50} * count;
  if (size < expected) {
    throw InputError(path + ":byte 80: " + std::to_string(count) + " triangles would take " +
                     std::to_string(expected) + " bytes, the file has " + std::to_string(size));
  }
}

struct Reader {
  const std::string& path;
  Eigen::Vector3d scale;
  Mesh mesh;

  void add(const aiMesh& part, const aiMatrix4x4& to_root) {
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) {
        ++mesh.skipped;  // a lone point or line
        continue;
      }
      Eigen::Vector3d corner[3];
      for (int k = 0; k < 3; ++k) {
        const aiVector3D v = to_root * part.mVertices[face.mIndices[k]];
        corner[k] = scale.cwiseProduct(Eigen::Vector3d(v.x, v.y, v.z));
      }
      const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
      if (!(area > k_area_min_m2) || !std::isfinite(area)) {
        ++mesh.skipped;
        continue;
      }
      if (mesh.triangles.size() >= k_mesh_triangles_max) {
        throw InputError(path + ": more than " + std::to_string(k_mesh_triangles_max) +
                         " triangles; expected a mesh of a robot's link");
      }
      mesh.triangles.push_back(
          {corner[0].cast<float>(), corner[1].cast<float>(), corner[2].cast<float>()});
    }
  }

  void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, int depth) {
    if (depth > k_nodes_deep_max) {
      throw InputError(path + ": nodes nested more than " + std::to_string(k_nodes_deep_max) +
                       " deep; expected a mesh of a robot's link");
    }
    const aiMatrix4x4 to_root = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene.mMeshes[node.mMeshes[m]], to_root);
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      add(scene, *node.mChildren[c], to_root, depth + 1);
    }
  }
};

double extent_of(const Mesh& mesh) {
  Eigen::Vector3f low = mesh.triangles[0].a, high = low;
  for (const Triangle& t : mesh.triangles) {
    low = low.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
    high = high.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
  }
  return static_cast<double>((high - low).norm());
}

}  // namespace

Mesh read_mesh(const std::string& path, const Eigen::Vector3d& scale) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  if (failed) throw InputError(path + ": cannot be opened; expected a mesh");
  if (size > k_mesh_bytes_max) {
    throw InputError(path + ": " + std::to_string(size) + " bytes; expected a mesh of at most " +
                     std::to_string(k_mesh_bytes_max));
  }
  std::string kind = std::filesystem::path(path).extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (kind != ".stl" && kind != ".dae" && kind != ".obj") {
    throw InputError(path + ": expected a mesh as .stl, .dae or .obj");
  }
  if (kind == ".stl") check_binary_stl(path, size);

  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InputError(path + ": no mesh: " + importer.GetErrorString());
  }
  Reader reader{path, scale, {}};
  reader.add(*scene, *scene->mRootNode, aiMatrix4x4(), 0);
  if (reader.mesh.triangles.empty()) {
    throw InputError(path + ": none of its " + std::to_string(reader.mesh.skipped) +
                     " triangles has an area; expected a surface");
  }
  const double extent = extent_of(reader.mesh);
  if (extent > k_extent_max_m) {
    throw InputError(path + ": spans " + std::to_string(extent) +
                     " m; expected a robot's link: is the mesh in millimetres? Then give its <mesh>"
                     " scale=\"0.001 0.001 0.001\"");
  }
  if (extent < k_extent_min_m) {
    throw InputError(path + ": spans " + std::to_string(extent * 1e3) +
                     " mm; expected a robot's link: was it scaled twice?");
  }
  return std::move(reader.mesh);
}

std::string find_mesh(const std::string& name, const RobotFiles& files) {
  namespace fs = std::filesystem;
  constexpr std::string_view package = "package://", file = "file://";
  if (name.starts_with(file)) return name.substr(file.size());
  std::string rest = name, wanted;
  if (name.starts_with(package)) {
    rest = name.substr(package.size());
    wanted = rest.substr(0, rest.find('/'));
  } else if (files.text.empty()) {
    const fs::path beside = fs::path(files.urdf).parent_path() / name;
    if (fs::is_regular_file(beside)) return beside.string();
  }
  std::string looked;
  for (const std::string& entry : files.package_dirs) {
    const std::size_t equals = entry.find('=');
    const bool named = equals != std::string::npos;
    if (named && entry.substr(0, equals) != wanted) continue;
    const fs::path folder = named ? entry.substr(equals + 1) : entry;
    looked += (looked.empty() ? "" : ", ") + folder.string();
    for (std::string part = rest;;) {
      if (fs::is_regular_file(folder / part)) return (folder / part).string();
      const std::size_t slash = part.find('/');
      if (slash == std::string::npos) break;
      part = part.substr(slash + 1);
    }
  }
  throw InputError(files.urdf + ": mesh '" + name + "' is not there; looked below: " +
                   (looked.empty() ? "nothing (give --package-dir)" : looked));
}

}  // namespace glint

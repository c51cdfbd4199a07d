// glint_mesh_reader: reads one mesh file with assimp, in a separate process with limits.
//
//   glint_mesh_reader FILE SCALE_X SCALE_Y SCALE_Z MEMORY_MB
// The output format is that of platform/tools/robot/mesh_bytes.hpp.
// On a damaged file assimp may crash or allocate without limit: then this process ends, not glint.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "platform/tools/robot/limit_memory.hpp"
#include "platform/tools/robot/mesh_bytes.hpp"

namespace glint {
namespace {

constexpr int k_nodes_deep_max = 64;
// Corners of real meshes are at least 0.1 mm apart: a smaller triangle is a line or a point.
constexpr double k_area_min_m2 = 1e-12;

struct MeshReader {
  Eigen::Vector3d scale;
  Mesh mesh;

  void add(const aiMesh& part, const aiMatrix4x4& to_root) {
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) {
        ++mesh.skipped;  // a single point or line
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
        throw std::runtime_error("more than " + std::to_string(k_mesh_triangles_max) +
                                 " triangles; expected a mesh of a robot's link");
      }
      mesh.triangles.push_back(
          {corner[0].cast<float>(), corner[1].cast<float>(), corner[2].cast<float>()});
    }
  }

  void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, int depth) {
    if (depth > k_nodes_deep_max) {
      throw std::runtime_error("nodes nested more than " + std::to_string(k_nodes_deep_max) +
                               " deep; expected a mesh of a robot's link");
    }
    const aiMatrix4x4 to_root = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene.mMeshes[node.mMeshes[m]], to_root);
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      add(scene, *node.mChildren[c], to_root, depth + 1);
    }
  }
};

Mesh read(const char* path, const Eigen::Vector3d& scale) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    throw std::runtime_error("not a mesh: " + why);
  }
  MeshReader reader{scale, {}};
  reader.add(*scene, *scene->mRootNode, aiMatrix4x4(), 0);
  return std::move(reader.mesh);
}

std::string answer(char** arguments) {
  const std::string memory = arguments[5];
  limit_memory(std::strtoull(memory.c_str(), nullptr, 10) << 20);
  try {
    const Eigen::Vector3d scale(std::atof(arguments[2]), std::atof(arguments[3]),
                                std::atof(arguments[4]));
    return mesh_bytes(read(arguments[1], scale));
  } catch (const std::bad_alloc&) {
    return mesh_error_bytes("takes more than " + memory +
                            " MB of memory to read; expected a mesh of a robot's link");
  } catch (const std::exception& error) {
    return mesh_error_bytes(error.what());
  }
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const std::string bytes = glint::answer(argv);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}

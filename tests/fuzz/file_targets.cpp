// Fuzz targets of binary files: tools, arrays, images, point clouds, meshes, robots.
#include <algorithm>
#include <filesystem>
#include <string>

#include "platform/cells/tool_formats.hpp"
#include "platform/formats/c3d_reader.hpp"
#include "platform/formats/image_file.hpp"
#include "platform/formats/npy.hpp"
#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/point_fields.hpp"
#include "platform/tools/reference/depth_image.hpp"
#include "platform/tools/robot/mesh_bytes.hpp"
#include "platform/tools/robot/mesh_file.hpp"
#include "platform/tools/robot/robot_cloud.hpp"
#include "platform/tools/robot/urdf_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace glint::fuzz {
namespace {

void read_rom(Bytes bytes) { (void)tool_from_rom_bytes(text_of(bytes), "tool.rom"); }

void read_npy(Bytes bytes) { (void)read_npy_numbers(file_of(bytes)); }

void read_pgm_file(Bytes bytes) {
  const Image picture = read_pgm(file_of(bytes));
  expect(picture.values.size() ==
             static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
         "as many pixels as its size states");
}

// Decoded by libspng, after a check of the size.
void read_png_file(Bytes bytes) {
  CameraModel camera;
  camera.width = 8;
  camera.height = 4;
  (void)read_depth(file_of(bytes, ".png"), camera);
}

void read_pcd_cloud(Bytes bytes) { (void)read_pcd(file_of(bytes)); }

void read_ply_cloud(Bytes bytes) { (void)read_ply(file_of(bytes)); }

void read_robot_cloud_file(Bytes bytes) {
  const RobotCloud robot = read_robot_cloud(file_of(bytes));
  const std::vector<double> positions(robot.inputs.size(), 0.1);
  (void)posed_cloud(robot, positions, "positions");
}

// Input is the answer of the assimp process, which is untrusted.
void read_mesh_bytes(Bytes bytes) { (void)mesh_of_bytes(text_of(bytes), "a.stl"); }

// Input is a mesh name in a robot description.
void find_mesh_file(Bytes bytes) {
  const RobotFiles files{"/robot_description", {"/proc/self/fdinfo"}, Geometry::collision, "x"};
  const std::filesystem::path found = find_mesh(text_of(bytes), files);
  expect(found.string().starts_with("/proc/self/fdinfo/") &&
             std::find(found.begin(), found.end(), "..") == found.end(),
         "a mesh lies in the package's folder");
}

void read_urdf_bytes(Bytes bytes) {
  const UrdfFile file = read_urdf_text(text_of(bytes), "/robot_description");
  expect(file.model != nullptr, "a model");
}

void read_c3d(Bytes bytes) { (void)C3dFile(file_of(bytes)).read(); }

constexpr Target k_file_targets[] = {
    {"rom_tool", read_rom},
    {"npy", read_npy},
    {"pgm", read_pgm_file},
    {"png", read_png_file},
    {"pcd", read_pcd_cloud},
    {"ply", read_ply_cloud},
    {"robot_cloud", read_robot_cloud_file},
    {"mesh", read_mesh_bytes},
    {"mesh_name", find_mesh_file},
    {"urdf", read_urdf_bytes},
    {"c3d", read_c3d},
};

}  // namespace

std::span<const Target> file_targets() { return k_file_targets; }

}  // namespace glint::fuzz

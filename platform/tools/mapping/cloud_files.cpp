#include "platform/tools/mapping/cloud_files.hpp"

#include <cstring>
#include <filesystem>

#include "platform/input_error.hpp"
#include "platform/sinks/record/growing_file.hpp"

namespace glint {
namespace {

std::string ending_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".ply" && ending != ".pcd") {
    throw InputError(path + ": ends in \"" + ending + "\"; expected .ply or .pcd");
  }
  return ending;
}

std::string ply_header(std::size_t points, bool normals) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(points) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
  return out + "end_header\n";
}

std::string pcd_header(std::size_t points, bool normals) {
  const std::string count = std::to_string(points);
  const auto six = [normals](const std::string& word) {
    std::string line;
    for (int i = 0; i < (normals ? 6 : 3); ++i) line += " " + word;
    return line;
  };
  return std::string("VERSION 0.7\nFIELDS x y z") + (normals ? " normal_x normal_y normal_z" : "") +
         "\nSIZE" + six("4") + "\nTYPE" + six("F") + "\nCOUNT" + six("1") + "\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
}

}  // namespace

HostCloud read_cloud(const std::string& path) {
  return ending_of(path) == ".ply" ? read_ply(path) : read_pcd(path);
}

void write_cloud(const std::string& path, const HostCloud& cloud) {
  const bool normals = !cloud.normals.empty();
  std::string bytes = ending_of(path) == ".ply" ? ply_header(cloud.points.size(), normals)
                                                : pcd_header(cloud.points.size(), normals);
  const auto append = [&bytes](const std::array<float, 3>& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof values);
  };
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    append(cloud.points[i]);
    if (normals) append(cloud.normals[i]);
  }
  GrowingFile file(path);
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (!file.append({std::span(data, bytes.size())}) || !file.finish()) {
    throw InputError(path + ": " + file.error() + "; expected a writable path");
  }
}

}  // namespace glint

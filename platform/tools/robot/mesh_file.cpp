#include "platform/tools/robot/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "platform/input_error.hpp"
#include "platform/tools/robot/limited_process.hpp"
#include "platform/tools/robot/mesh_bytes.hpp"

namespace glint {
namespace {

constexpr std::uintmax_t k_mesh_bytes_max = 256u << 20;
// Limits of a link's extent: a larger or smaller mesh has the wrong unit.
constexpr double k_extent_max_m = 10, k_extent_min_m = 1e-3;
// Requires that a binary STL is at least as long as its triangle count implies.
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

// glint_mesh_reader is in the folder of this program.
std::string reader_program() {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  return (self.parent_path() / "glint_mesh_reader").string();
}

std::string number_text(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", number);
  return text.data();
}

Mesh read_apart(const std::string& path, const Eigen::Vector3d& scale, const MeshLimits& limits) {
  const ProcessOutput output =
      output_of({reader_program(), path, number_text(scale.x()), number_text(scale.y()),
                 number_text(scale.z()), std::to_string(limits.memory_mb)},
                {std::size_t{40} * k_mesh_triangles_max, limits.time});
  switch (output.end) {
    case ProcessEnd::done:
      return mesh_of_bytes(output.bytes, path);
    case ProcessEnd::timed_out:
      throw InputError(path + ": takes longer than " +
                       std::to_string(limits.time.nanoseconds / 1'000'000) +
                       " ms to read; expected a mesh of a robot's link");
    case ProcessEnd::failed:
    case ProcessEnd::killed:
    case ProcessEnd::too_much:
      break;
  }
  throw InputError(path + ": the mesh library cannot read it; expected an undamaged mesh");
}

double extent_of(const Mesh& mesh) {
  Eigen::Vector3f low = mesh.triangles[0].a, high = low;
  for (const Triangle& t : mesh.triangles) {
    low = low.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
    high = high.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
  }
  return static_cast<double>((high - low).norm());
}

}  // namespace

Mesh read_mesh(const std::string& path, const Eigen::Vector3d& scale, const MeshLimits& limits) {
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

  Mesh mesh = read_apart(path, scale, limits);
  if (mesh.triangles.empty()) {
    throw InputError(path + ": none of its " + std::to_string(mesh.skipped) +
                     " triangles has an area; expected a surface");
  }
  const double extent = extent_of(mesh);
  if (extent > k_extent_max_m) {
    throw InputError(path + ": spans " + std::to_string(extent) +
                     " m; expected a robot's link; for a mesh in millimetres set scale=\"0.001 "
                     "0.001 0.001\" in <mesh>");
  }
  if (extent < k_extent_min_m) {
    throw InputError(path + ": spans " + std::to_string(extent * 1e3) +
                     " mm; expected a robot's link; check for double scaling");
  }
  return mesh;
}

namespace {

namespace fs = std::filesystem;

// Returns whether `path` is in `folder`, lexically: symbolic links in a package folder are its
// owner's and may lead out of it.
bool is_inside(const fs::path& folder, const fs::path& path) {
  fs::path base = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
  if (!base.has_filename()) base = base.parent_path();  // "folder/" has an empty last part
  const auto [end, _] = std::mismatch(base.begin(), base.end(), path.begin(), path.end());
  return end == base.end();
}

// `entry` of --package-dir: FOLDER or NAME=FOLDER.
fs::path folder_of(const std::string& entry) {
  return entry.substr(entry.find('=') == std::string::npos ? 0 : entry.find('=') + 1);
}

// Without exceptions: for example a name that is too long is not a file.
bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Checks a path that is absolute or relative to the URDF. Folders, devices and pipes are not
// meshes.
std::string confined(const fs::path& path, const std::string& name, const RobotFiles& files,
                     bool beside) {
  std::error_code error;  // an empty name has no absolute path
  const fs::path found = fs::absolute(path, error).lexically_normal();
  bool inside = beside && is_inside(fs::path(files.urdf).parent_path(), found);
  for (const std::string& entry : files.package_dirs) {
    inside = inside || is_inside(folder_of(entry), found);
  }
  if (!inside) {
    throw InputError(files.urdf + ": mesh '" + name + "' lies outside of " +
                     (beside ? "the URDF's folder and " : "") +
                     "every --package-dir; expected a path inside one");
  }
  if (!is_file(found)) {
    throw InputError(files.urdf + ": mesh '" + name + "': " + found.string() +
                     " is not a file; expected a mesh");
  }
  return found.string();
}

}  // namespace

std::string find_mesh(const std::string& name, const RobotFiles& files) {
  constexpr std::string_view package = "package://", file = "file://";
  if (name.starts_with(file)) return confined(name.substr(file.size()), name, files, false);
  std::string rest = name, wanted;
  if (name.starts_with(package)) {
    rest = name.substr(package.size());
    wanted = rest.substr(0, rest.find('/'));
  } else if (fs::path(name).is_absolute()) {
    return confined(name, name, files, false);
  } else if (files.text.empty()) {
    const fs::path beside = fs::path(files.urdf).parent_path() / name;
    if (is_file(beside)) return confined(beside, name, files, true);
  }
  // The loop below removes leading parts of the path, so each part must be a name.
  const fs::path parts(rest);
  if (parts.is_absolute() || rest.find("//") != std::string::npos ||
      std::find(parts.begin(), parts.end(), "..") != parts.end()) {
    throw InputError(files.urdf + ": mesh '" + name +
                     "' leads out of its package; expected a path of names, without '..' and '//'");
  }
  std::string searched;
  for (const std::string& entry : files.package_dirs) {
    const std::size_t equals = entry.find('=');
    if (equals != std::string::npos && entry.substr(0, equals) != wanted) continue;
    const fs::path folder = folder_of(entry);
    searched += (searched.empty() ? "" : ", ") + folder.string();
    for (std::string part = rest;;) {
      if (is_file(folder / part)) return (folder / part).string();
      const std::size_t slash = part.find('/');
      if (slash == std::string::npos) break;
      part = part.substr(slash + 1);
    }
  }
  throw InputError(files.urdf + ": mesh '" + name + "' is missing; searched below: " +
                   (searched.empty() ? "no folder (set --package-dir)" : searched));
}

}  // namespace glint

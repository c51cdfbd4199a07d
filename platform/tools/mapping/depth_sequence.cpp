#include "platform/tools/mapping/depth_sequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "kernels/pose/best_rotation.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/mapping/file_text.hpp"

namespace glint {
namespace {

constexpr double k_not_rigid = 0.01;  // limit of an axis's length error, or a cosine
constexpr std::size_t k_frames_max = 10'000;

std::vector<double> numbers_of(FileText& file, std::size_t count) {
  std::vector<double> numbers;
  std::vector<std::string_view> words;
  while (file.next_line(words)) {
    for (const std::string_view word : words) {
      numbers.push_back(file.number(word));
      if (!std::isfinite(numbers.back())) file.refuse("a number that is not finite", "finite ones");
      if (numbers.size() > count) file.refuse("more numbers", std::to_string(count));
    }
  }
  if (numbers.size() < count) {
    file.refuse(std::to_string(numbers.size()) + " numbers", std::to_string(count));
  }
  return numbers;
}

Pose load_pose(const std::string& path) {
  FileText file(path, "a pose of 16 numbers");
  const std::vector<double> n = numbers_of(file, 16);
  Matrix3 rotation;
  rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const double off = (rotation.transpose() * rotation - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= k_not_rigid) || rotation.determinant() < 0) {
    file.refuse("a rotation with an orthonormality error of " + std::to_string(off),
                "an orthonormal one");
  }
  if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1) {
    file.refuse("another last row", "0 0 0 1");
  }
  return {best_rotation(rotation), Vector3(n[3], n[7], n[11])};
}

CameraModel load_pinhole(const std::string& path) {
  FileText file(path, "a pinhole's matrix of 9 numbers");
  const std::vector<double> k = numbers_of(file, 9);
  if (!(k[0] > 0 && k[4] > 0) || k[1] != 0 || k[8] != 1) {
    file.refuse("another matrix", "fx 0 cx  0 fy cy  0 0 1, fx and fy above 0");
  }
  CameraModel camera;
  camera.fx = k[0], camera.fy = k[4];
  camera.cx = k[2] + 0.5, camera.cy = k[5] + 0.5;
  return camera;
}

DepthFrame load_npy(const std::string& path) {
  NpyArray array = read_npy_float32(path);
  if (array.shape.size() != 2 || array.shape[0] > k_depth_side_max ||
      array.shape[1] > k_depth_side_max) {
    throw InputError(path + ": " + std::to_string(array.shape.size()) +
                     " axes; expected rows and columns, at most " +
                     std::to_string(k_depth_side_max));
  }
  return {static_cast<int>(array.shape[1]),
          static_cast<int>(array.shape[0]),
          std::move(array.values),
          {},
          {}};
}

std::vector<ExclusionCapsule> load_left_out(const std::string& path) {
  std::vector<ExclusionCapsule> out;
  if (!std::filesystem::exists(path)) return out;
  const std::string expected = "x y z  x y z  radius of a thick line, finite, the radius above 0";
  FileText file(path, expected);
  std::vector<std::string_view> words;
  while (file.next_line(words)) {
    if (words.empty()) continue;
    if (words.size() != 7) file.refuse(std::to_string(words.size()) + " numbers", expected);
    std::array<double, 7> n{};
    for (std::size_t i = 0; i < n.size(); ++i) {
      n[i] = file.number(words[i]);
      if (!std::isfinite(n[i])) file.refuse("a number that is not finite", expected);
    }
    if (!(n[6] > 0)) file.refuse("no radius", expected);
    if (static_cast<int>(out.size()) == k_exclusion_capsules_max) {
      file.refuse("one more", "at most " + std::to_string(k_exclusion_capsules_max) + " lines");
    }
    out.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]});
  }
  return out;
}

}  // namespace

DepthSequence read_depth_sequence(const std::string& folder, DepthPngReader png) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(folder))
    throw InputError(folder + ": is not a folder; expected depth images");
  DepthSequence out;
  out.camera = load_pinhole((fs::path(folder) / "camera-intrinsics.txt").string());
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().string();
    if (name.ends_with(".depth.png") || name.ends_with(".depth.npy")) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  if (files.empty() || files.size() > k_frames_max) {
    throw InputError(folder + ": " + std::to_string(files.size()) +
                     " depth images; expected 1 to " + std::to_string(k_frames_max) +
                     " NAME.depth.png or .npy");
  }
  for (const std::string& file : files) {
    const bool is_png = file.ends_with(".png");
    if (is_png && png == nullptr) {
      throw InputError(file + ": a PNG, not supported on a board; expected NAME.depth.npy");
    }
    DepthFrame frame = is_png ? png(file) : load_npy(file);
    if (out.frames.empty()) {
      out.camera.width = frame.width;
      out.camera.height = frame.height;
    } else if (frame.width != out.camera.width || frame.height != out.camera.height) {
      throw InputError(
          file + ": " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
          " pixels; expected the size of the first image, " + std::to_string(out.camera.width) +
          " x " + std::to_string(out.camera.height));
    }
    const std::string stem = file.substr(0, file.size() - std::string(".depth.png").size());
    frame.T_world_camera = load_pose(stem + ".pose.txt");
    frame.left_out = load_left_out(stem + ".left_out.txt");
    out.frames.push_back(std::move(frame));
  }
  return out;
}

}  // namespace glint

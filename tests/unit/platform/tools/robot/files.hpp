// Files of a test in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "platform/tools/robot/robot_model.hpp"

namespace glint::test {

class Files {
 public:
  Files() {
    std::string name = (std::filesystem::temp_directory_path() / "glint_robot_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~Files() { std::filesystem::remove_all(folder_); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  std::string write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }
  [[nodiscard]] std::string folder() const { return folder_.string(); }

 private:
  std::filesystem::path folder_;
};

inline std::string stl_bytes(const std::vector<Triangle>& triangles) {
  std::string bytes(80, ' ');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& t : triangles) {
    const float values[12] = {0,       0,       0,       t.a.x(), t.a.y(), t.a.z(),
                              t.b.x(), t.b.y(), t.b.z(), t.c.x(), t.c.y(), t.c.z()};
    bytes.append(reinterpret_cast<const char*>(values), sizeof values);
    bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string robot_xml(const std::string& inside) {
  return "<?xml version='1.0'?>\n<robot name='arm'>\n" + inside + "</robot>\n";
}

inline std::string joint_xml(const std::string& name, const std::string& type,
                             const std::string& parent, const std::string& child,
                             const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><axis xyz='0 0 1'/>" +
         "<limit effort='1' velocity='1' lower='-9' upper='9'/>" + more + "</joint>\n";
}

}  // namespace glint::test

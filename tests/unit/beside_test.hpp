// Path of a build folder file next to the running test. A path in a compile definition would make
// the object code depend on the location of the checkout.
#pragma once

#include <filesystem>
#include <string>

namespace glint {

inline std::string path_beside_test(const char* name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

}  // namespace glint

// Files of the build folder, found beside the running test: a path in a compile definition would
// make the object code depend on where the checkout is.
#pragma once

#include <filesystem>
#include <string>

namespace glint {

inline std::string beside_test(const char* name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

}  // namespace glint

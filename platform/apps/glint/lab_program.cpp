#include "platform/apps/glint/lab_program.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "platform/input_error.hpp"

namespace glint {

void start_lab() {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "glint_lab").string();
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words{std::istreambuf_iterator<char>(file), {}};  // each ends with a zero byte
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < words.size(); at += std::strlen(&words[at]) + 1)
    arguments.push_back(&words[at]);
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw MissingDevice(program + ": " + std::strerror(errno) +
                      "; expected glint_lab beside glint, for experiments and --method baseline");
}

}  // namespace glint

#include "tests/fuzz/memory_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>

namespace glint::fuzz {
namespace {

// Symbolic links that give /proc/self/fd/N a name with an ending. The folder's name is random and
// libFuzzer uses every comparison, so readers get a path without that name.
class Files {
 public:
  Files() {
    std::string name = (std::filesystem::temp_directory_path() / "glint_fuzz_XXXXXX").string();
    expect(mkdtemp(name.data()) != nullptr, "a temporary folder");
    folder_ = name;
    const int folder = open(name.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    expect(folder >= 0, "a temporary folder");
    path_ = "/proc/self/fd/" + std::to_string(folder);
  }
  ~Files() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  std::string write(Bytes bytes, const std::string& ending) {
    const auto [file, fresh] = descriptors_.try_emplace(ending, -1);
    if (fresh) {
      file->second = memfd_create("input", MFD_CLOEXEC);
      std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(file->second),
                                      folder_ / ("input" + ending));
    }
    const auto size = static_cast<ssize_t>(bytes.size());
    expect(ftruncate(file->second, 0) == 0 &&
               pwrite(file->second, bytes.data(), bytes.size(), 0) == size,
           "a file in memory");
    return path_ + "/input" + ending;
  }

 private:
  std::filesystem::path folder_;
  std::string path_;
  std::map<std::string, int> descriptors_;
};

}  // namespace

std::string file_of(Bytes bytes, const std::string& ending) {
  static Files files;
  return files.write(bytes, ending);
}

}  // namespace glint::fuzz

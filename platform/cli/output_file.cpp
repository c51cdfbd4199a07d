#include "platform/cli/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {

void make_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError(path + ": " + error.message() + "; expected a folder to write to");
}

void make_folder_of(const std::string& path) {
  make_folder(std::filesystem::path(path).parent_path().string());
}

void write_text(const std::string& path, const std::string& text) {
  make_folder_of(path);
  if (const std::string reason = write_whole_file(path, text); !reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason + "; expected a place for a file");
  }
}

ReservedRoom::ReservedRoom(const std::string& path) {
  constexpr off_t k_bytes = off_t{64} << 10;  // a summary with its notices has about 10 kB
  if (path.empty()) return;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  descriptor_ =
      ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor_ >= 0 && ::fallocate(descriptor_, 0, 0, k_bytes) != 0) release();
}

void ReservedRoom::release() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void write_json(const std::string& path, const nlohmann::ordered_json& figures) {
  // Names of files may be no UTF-8, which JSON does not hold.
  constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
  if (!path.empty()) write_text(path, figures.dump(2, ' ', false, replace) + "\n");
}

}  // namespace glint

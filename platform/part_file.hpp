// Atomic file write: a temporary file beside the final path, renamed when complete.
//
// The temporary name is always new: it overwrites neither the unfinished file of a crashed run nor
// another program's file. Symbolic links are never followed.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace glint {

struct PartFile {
  std::string path;
  int descriptor = -1;  // -1 on failure; errno holds the reason
};

// Creates PATH.part; if that exists, PATH.1.part and so on.
[[nodiscard]] inline PartFile open_part_file(const std::string& path) {
  constexpr int k_names_max = 1000;
  PartFile part;
  for (int n = 0; n < k_names_max; ++n) {
    part.path = path;
    if (n > 0) part.path.append(".").append(std::to_string(n));
    part.path.append(".part");
    part.descriptor =
        ::open(part.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (part.descriptor >= 0 || errno != EEXIST) break;
  }
  return part;
}

// Whether the path is a device, a pipe or a descriptor: a rename would replace it by a file.
[[nodiscard]] inline bool is_special_file(const std::string& path) {
  if (path.starts_with("/dev/") || path.starts_with("/proc/")) return true;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

[[nodiscard]] inline bool write_all(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Writes the whole file or nothing. Returns the system's error text, or "" on success.
[[nodiscard]] inline std::string write_file_atomically(const std::string& path,
                                                       std::string_view text) {
  const bool in_place = is_special_file(path);
  const PartFile file =
      in_place ? PartFile{path, ::open(path.c_str(), O_WRONLY | O_CLOEXEC)} : open_part_file(path);
  if (file.descriptor < 0) return std::generic_category().message(errno);
  const auto failed = [&] {
    const std::string reason = std::generic_category().message(errno);
    if (!in_place) ::unlink(file.path.c_str());
    return reason;
  };
  if (!write_all(file.descriptor, text)) {
    const std::string reason = failed();
    ::close(file.descriptor);
    return reason;
  }
  if (::close(file.descriptor) != 0) return failed();
  if (!in_place && std::rename(file.path.c_str(), path.c_str()) != 0) return failed();
  return {};
}

}  // namespace glint

#include "platform/apps/glint/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "platform/input_error.hpp"

namespace glint {

void make_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError(path + ": " + error.message() + "; expected a writable folder");
}

void make_folder_of(const std::string& path) {
  make_folder(std::filesystem::path(path).parent_path().string());
}

void write_text(const std::string& path, const std::string& text) {
  make_folder_of(path);
  if (const std::string reason = write_file_atomically(path, text); !reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason + "; expected a writable path");
  }
}

int report_losses(const std::vector<std::string>& failures) {
  std::fflush(stdout);
  for (const std::string& line : failures) {
    std::fprintf(stderr, "glint: %s\n", one_line(line).c_str());
  }
  return failures.empty() ? 0 : 1;
}

LineWriter::LineWriter(const std::string& path) : path_(path), in_place_(is_special_file(path)) {
  make_folder_of(path);
  part_ =
      in_place_ ? PartFile{path, ::open(path.c_str(), O_WRONLY | O_CLOEXEC)} : open_part_file(path);
  if (part_.descriptor < 0) fail();
}

LineWriter::~LineWriter() {
  if (part_.descriptor < 0) return;
  ::close(part_.descriptor);
  if (!in_place_) ::unlink(part_.path.c_str());
}

void LineWriter::fail() const {
  throw InputError(path_ + ": cannot be written: " + std::generic_category().message(errno) +
                   "; expected a writable path");
}

void LineWriter::write_out() {
  if (!write_all(part_.descriptor, waiting_)) fail();
  waiting_.clear();
}

void LineWriter::add(std::string_view line) {
  constexpr std::size_t k_waiting_max = std::size_t{64} << 10;
  waiting_.append(line) += '\n';
  if (waiting_.size() >= k_waiting_max) write_out();
}

void LineWriter::finish() {
  write_out();
  const bool closed = ::close(std::exchange(part_.descriptor, -1)) == 0;
  if (in_place_) {
    if (!closed) fail();
  } else if (!closed || std::rename(part_.path.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    ::unlink(part_.path.c_str());
    errno = error;
    fail();
  }
}

ReservedDiskSpace::ReservedDiskSpace(const std::string& path) {
  constexpr off_t k_bytes = off_t{64} << 10;  // a summary with its notices has about 10 kB
  if (path.empty()) return;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  descriptor_ =
      ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor_ >= 0 && ::fallocate(descriptor_, 0, 0, k_bytes) != 0) release();
}

void ReservedDiskSpace::release() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void write_json(const std::string& path, const nlohmann::ordered_json& figures) {
  // File names may be invalid UTF-8, which JSON cannot hold.
  constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
  if (!path.empty()) write_text(path, figures.dump(2, ' ', false, replace) + "\n");
}

}  // namespace glint

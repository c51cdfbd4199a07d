#include "platform/sinks/can/line_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {

LineFile::LineFile(std::filesystem::path file) : file_(std::move(file)), written_as_(file_) {
  if (is_special_file(file_.string())) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    const PartFile part = open_part_file(file_.string());
    written_as_ = part.path;
    descriptor_ = part.descriptor;
  }
  if (descriptor_ < 0)
    throw InputError(file_.string() + ": cannot be written: " + std::strerror(errno) +
                     "; expected a writable path");
}

LineFile::~LineFile() {
  write_out();
  ::close(descriptor_);
  if (written_as_ != file_) std::rename(written_as_.c_str(), file_.c_str());
}

void LineFile::add(std::string_view line) noexcept {
  if (failed_)
    ++lines_lost_;
  else
    buffered_.append(line);
}

void LineFile::write_out() noexcept {
  std::string_view rest = buffered_;
  while (!failed_ && !rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      truncate_to_complete_lines(rest);
    else
      rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!failed_) bytes_ += static_cast<std::int64_t>(buffered_.size());
  buffered_.clear();
}

// Part of the buffered lines may be on the disk: keep the complete ones.
void LineFile::truncate_to_complete_lines(std::string_view unwritten) noexcept {
  failed_ = true;
  error_ = errno;
  const std::string_view all = buffered_;
  const std::string_view written = all.substr(0, all.size() - unwritten.size());
  const auto last_end = written.rfind('\n');
  const std::size_t kept = last_end == std::string_view::npos ? 0 : last_end + 1;
  bytes_ += static_cast<std::int64_t>(kept);
  lines_lost_ += static_cast<std::uint64_t>(
      std::count(all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(), '\n'));
  // If truncation fails, too, the partial line stays.
  if (written_as_ != file_ && ::ftruncate(descriptor_, bytes_) != 0) return;
}

}  // namespace glint

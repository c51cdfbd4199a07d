#include "platform/sinks/record/growing_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/sinks/record/crc32.hpp"

namespace glint {
namespace {

// A kernel without full preemption keeps the core until write() returns: chunks of 4 MiB in one
// call delayed ticks by 2 to 3 ms, once a second.
constexpr std::size_t k_piece_bytes = std::size_t{64} << 10;

}  // namespace

GrowingFile::GrowingFile(std::string path) : path_(std::move(path)) {
  if (is_special_file(path_)) throw InputError(path_ + ": a device; expected a regular file");
  PartFile part = open_part_file(path_);
  part_path_ = std::move(part.path);
  descriptor_ = part.descriptor;
  if (descriptor_ >= 0) return;
  fail("open", errno);
  throw InputError(error_ + "; expected a writable folder");
}

GrowingFile::~GrowingFile() {
  sync_.reset();
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool GrowingFile::fail(const char* doing, int error) {
  if (!error_.empty()) return false;  // the first failure is the cause of the others
  error_ = part_path_ + ": " + doing + " at byte " + std::to_string(size_) + ": " +
           std::generic_category().message(error);
  return false;
}

bool GrowingFile::reserve(std::uint64_t bytes) {
  const std::uint64_t end = size_ + bytes;
  if (end <= reserved_end_) return true;
  int result = 0;
  do {
    result = ::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(size_),
                         static_cast<off_t>(bytes));
  } while (result != 0 && errno == EINTR);
  if (result != 0 && errno != EOPNOTSUPP && errno != ENOSYS) return fail("make room", errno);
  reserved_end_ = end;
  return true;
}

bool GrowingFile::write_pieces(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::write(descriptor_, bytes.data(), std::min(bytes.size(), k_piece_bytes));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

bool GrowingFile::append(std::initializer_list<std::span<const std::uint8_t>> parts) {
  if (!check_sync()) return false;
  std::uint64_t size = size_;
  std::uint32_t crc = crc_;
  for (const auto part : parts) {
    if (!write_pieces(part)) {
      fail("write", errno);
      if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0 ||
          ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET) < 0)
        fail("cut back", errno);
      reserved_end_ = size_;
      return false;
    }
    size += part.size();
    crc = crc32(crc, part);
  }
  size_ = size;
  crc_ = crc;
  return true;
}

// After a failed synchronisation any part of the file may be lost.
bool GrowingFile::check_sync() {
  const int error = sync_ ? sync_->error() : 0;
  return error == 0 || fail("synchronise", error);
}

bool GrowingFile::finish() {
  if (sync_) sync_->stop();
  if (!check_sync()) return false;
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) return fail("cut", errno);
  if (::fsync(descriptor_) != 0) return fail("flush", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) return fail("close", errno);
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) return fail("rename", errno);
  return true;
}

}  // namespace glint

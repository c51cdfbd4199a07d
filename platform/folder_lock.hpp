// Exclusive lock of an output folder: one run at a time writes to it. Refuses a second run, with
// the process id of the first.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {

class FolderLock {
 public:
  // Requires an existing folder. Throws InputError with the other process's id if the folder is in
  // use. The lock ends with its process, also after a crash.
  explicit FolderLock(const std::string& folder) : path_(folder + "/.glint.lock") {
    while (!take(folder)) {
    }
    const std::string text = std::to_string(::getpid()) + "\n";
    if (::ftruncate(descriptor_, 0) != 0 || !write_all(descriptor_, text)) {
      const std::string reason = std::generic_category().message(errno);
      ::close(descriptor_);
      throw InputError(path_ + ": " + reason + "; expected a writable folder");
    }
  }
  ~FolderLock() {
    ::unlink(path_.c_str());  // while the lock is held: the file is this process's own
    ::close(descriptor_);
  }
  // Whether the last run in this folder ended without its destructors: a crash, SIGKILL, a power
  // cut.
  [[nodiscard]] bool after_crash() const noexcept { return after_crash_; }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  // Returns false on EINTR, or if the last owner removed the file meanwhile: call again.
  [[nodiscard]] bool take(const std::string& folder) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
      throw InputError(path_ + ": " + std::generic_category().message(errno) +
                       "; expected a writable folder");
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string owner = error == EWOULDBLOCK ? owner_text() : "";
      ::close(descriptor_);
      if (error == EINTR) return false;
      if (error != EWOULDBLOCK) {
        throw InputError(path_ + ": cannot be locked: " + std::generic_category().message(error) +
                         "; expected a file system with locks");
      }
      throw InputError(folder + ": another run writes to it (process " + owner +
                       "); expected another folder, or the end of that run");
    }
    struct stat held {
    }, there{};
    if (::fstat(descriptor_, &held) == 0 && ::stat(path_.c_str(), &there) == 0 &&
        held.st_ino == there.st_ino) {
      after_crash_ = held.st_size > 0;
      return true;
    }
    ::close(descriptor_);
    return false;
  }
  [[nodiscard]] std::string owner_text() const {
    std::array<char, 16> text{};
    const ssize_t size = ::pread(descriptor_, text.data(), text.size(), 0);
    std::string owner(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    owner = owner.substr(0, owner.find_first_not_of("0123456789"));
    return owner.empty() ? "unknown" : owner;
  }

  std::string path_;
  int descriptor_ = -1;
  bool after_crash_ = false;
};

}  // namespace glint

// File `stop_safe` in a service's folder: while it exists, the run sends no pose. A crash creates
// it, and only a person removes it.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {

class StopSafeFile {
 public:
  // Creates the file if `after_crash`. Throws InputError if that fails: the state must survive the
  // next restart.
  StopSafeFile(const std::string& folder, bool after_crash) : path_(folder + "/stop_safe") {
    if (!after_crash) return;
    const int descriptor = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor < 0) {
      throw InputError(path_ + ": " + std::generic_category().message(errno) +
                       "; expected a writable folder");
    }
    constexpr std::string_view k_text =
        "The last run ended without closing its files. Poses are sent again once this file is "
        "removed.\n";
    (void)write_all(descriptor, k_text);  // a full disk takes the name, not the text
    ::close(descriptor);
  }

  // Whether poses may be sent. An error other than a missing file means no.
  [[nodiscard]] bool removed() const noexcept {
    struct stat found {};
    return ::lstat(path_.c_str(), &found) != 0 && errno == ENOENT;
  }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

}  // namespace glint

#include "platform/sinks/record/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "platform/input_error.hpp"

namespace glint {

InputFile::InputFile(std::string path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0)
    throw InputError(path_ + ": " + std::generic_category().message(errno) +
                     "; expected a recording");
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw InputError(path_ + ": not a regular file; expected a recording");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(std::uint64_t offset, std::uint64_t count, Bytes& bytes) const {
  bytes.resize(count);
  for (std::size_t done = 0; done < count;) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(offset + done, std::generic_category().message(errno), "a readable file");
    if (got == 0) refuse(offset + done, "the file ends", "the size at opening");
    done += static_cast<std::size_t>(got);
  }
}

void InputFile::refuse(std::uint64_t offset, const std::string& found,
                       const std::string& expected) const {
  throw InputError(path_ + ":byte " + std::to_string(offset) + ": " + found + "; expected " +
                   expected);
}

}  // namespace glint

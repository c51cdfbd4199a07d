#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what);
}

}  // namespace

FrameLoopWriter::FrameLoopWriter(std::string path, const FrameLoopHeader& header)
    : path_(std::move(path)), header_(header) {
  PartFile part = open_part_file(path_);
  part_path_ = std::move(part.path);
  descriptor_ = part.descriptor;
  if (descriptor_ < 0) refuse(part_path_, std::string("cannot be made: ") + std::strerror(errno));
  write_padded(&header_, sizeof header_);
}

FrameLoopWriter::~FrameLoopWriter() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(part_path_.c_str());
}

void FrameLoopWriter::add(const LoopFrame& frame, const FrameBuffer& pixels) {
  const bool bytes = header_.reflectivity_bits == 8;
  const std::size_t count = static_cast<std::size_t>(header_.width) * header_.height;
  const std::size_t found = bytes ? pixels.reflectivity_8.size() : pixels.reflectivity_16.size();
  if (found != count || pixels.depth.size() != (header_.has_depth != 0 ? count : 0)) {
    refuse(path_,
           "a frame of " + std::to_string(found) + " pixels; expected " + std::to_string(count));
  }
  write_padded(&frame, sizeof frame);
  if (bytes) {
    write_padded(pixels.reflectivity_8.data(), count);
  } else {
    write_padded(pixels.reflectivity_16.data(), count * 2);
  }
  if (header_.has_depth != 0) write_padded(pixels.depth.data(), count * 2);
  ++added_;
}

void FrameLoopWriter::close() {
  if (added_ != header_.frames) {
    refuse(path_, std::to_string(added_) + " frames; expected " + std::to_string(header_.frames));
  }
  if (::close(std::exchange(descriptor_, -1)) != 0 ||
      std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    ::unlink(part_path_.c_str());
    refuse(path_, std::string("cannot be written: ") + std::strerror(errno));
  }
}

void FrameLoopWriter::write_padded(const void* bytes, std::size_t count) {
  static constexpr std::array<char, k_loop_alignment> zeros{};
  const auto write_all = [this](const char* at, std::size_t left) {
    while (left > 0) {
      const ssize_t written = ::write(descriptor_, at, left);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) refuse(path_, std::string("cannot be written: ") + std::strerror(errno));
      at += written;
      left -= static_cast<std::size_t>(written);
    }
  };
  write_all(static_cast<const char*>(bytes), count);
  write_all(zeros.data(), (k_loop_alignment - count % k_loop_alignment) % k_loop_alignment);
}

}  // namespace glint

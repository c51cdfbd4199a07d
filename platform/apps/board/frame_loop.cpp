#include "platform/apps/board/frame_loop.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "kernels/limits.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t padded(std::size_t bytes) {
  return (bytes + k_loop_alignment - 1) / k_loop_alignment * k_loop_alignment;
}

std::size_t plane_bytes(const FrameLoopHeader& header, std::uint32_t bits) {
  return padded(static_cast<std::size_t>(header.width) * header.height * (bits / 8));
}

std::size_t frame_size(const FrameLoopHeader& header) {
  return padded(sizeof(LoopFrame)) + plane_bytes(header, header.reflectivity_bits) +
         (header.has_depth != 0 ? plane_bytes(header, 16) : 0);
}

[[noreturn]] void refuse(const std::string& path, std::size_t byte, const std::string& found,
                         const std::string& expected) {
  throw InputError(path + ":byte " + std::to_string(byte) + ": " + found + "; expected " +
                   expected);
}

void check(const std::string& path, const FrameLoopHeader& header, std::size_t size) {
  const auto number = [&](std::size_t offset, const char* name, std::int64_t found, bool good,
                          const std::string& expected) {
    if (!good) refuse(path, offset, std::string(name) + " " + std::to_string(found), expected);
  };
  if (std::memcmp(header.magic, FrameLoopHeader{}.magic, sizeof header.magic) != 0) {
    refuse(path, 0, "no loop of frames", "GLNTLOOP, a file of glint_board_frames");
  }
  number(offsetof(FrameLoopHeader, layout), "layout", header.layout, header.layout == 1, "1");
  number(offsetof(FrameLoopHeader, width), "width", header.width,
         header.width > 0 && header.width <= k_width_max, "1 to " + std::to_string(k_width_max));
  number(offsetof(FrameLoopHeader, height), "height", header.height,
         header.height > 0 && header.height <= k_height_max,
         "1 to " + std::to_string(k_height_max));
  number(offsetof(FrameLoopHeader, reflectivity_bits), "bits", header.reflectivity_bits,
         header.reflectivity_bits == 8 || header.reflectivity_bits == 16, "8 or 16");
  number(offsetof(FrameLoopHeader, has_depth), "has depth", header.has_depth, header.has_depth <= 1,
         "0 or 1");
  number(offsetof(FrameLoopHeader, frames), "frames", header.frames, header.frames > 0,
         "at least 1");
  number(offsetof(FrameLoopHeader, period_ns), "period_ns", header.period_ns, header.period_ns > 0,
         "more than 0");
  const std::size_t expected_bytes =
      padded(sizeof header) + static_cast<std::size_t>(header.frames) * frame_size(header);
  if (size != expected_bytes) {
    refuse(
        path, size, "the end",
        std::to_string(expected_bytes) + " bytes for " + std::to_string(header.frames) + " frames");
  }
}

}  // namespace

FrameLoop::FrameLoop(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) ::close(descriptor);
    throw InputError(path + ": cannot be read: " + why);
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ < padded(sizeof header_)) {
    ::close(descriptor);
    refuse(path, size_, "the end",
           "a header of " + std::to_string(padded(sizeof header_)) + " bytes");
  }
  // MAP_POPULATE: no page fault at the first access to a frame.
  void* const mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor, 0);
  const int error = errno;
  ::close(descriptor);
  if (mapped == MAP_FAILED) throw InputError(path + ": cannot be mapped: " + std::strerror(error));
  bytes_ = static_cast<const std::byte*>(mapped);
  std::memcpy(&header_, bytes_, sizeof header_);
  try {
    check(path, header_, size_);
  } catch (...) {
    ::munmap(mapped, size_);
    throw;
  }
}

FrameLoop::~FrameLoop() { ::munmap(const_cast<std::byte*>(bytes_), size_); }

std::uint32_t FrameLoop::index_of(std::uint64_t number) const noexcept {
  const std::uint64_t last = header_.frames - 1;
  if (last == 0) return 0;
  const std::uint64_t step = number % (2 * last);  // shows the end frames once
  return static_cast<std::uint32_t>(step <= last ? step : 2 * last - step);
}

const std::byte* FrameLoop::frame_bytes(std::uint32_t index) const noexcept {
  return bytes_ + padded(sizeof header_) + index * frame_size(header_);
}

const LoopFrame& FrameLoop::entry(std::uint32_t index) const noexcept {
  return *reinterpret_cast<const LoopFrame*>(frame_bytes(index));
}

Frame FrameLoop::view(std::uint32_t index, Time arrival, std::uint64_t sequence) const noexcept {
  const int width = static_cast<int>(header_.width), height = static_cast<int>(header_.height);
  const std::byte* const reflectivity = frame_bytes(index) + padded(sizeof(LoopFrame));
  const std::byte* const depth = reflectivity + plane_bytes(header_, header_.reflectivity_bits);
  Frame frame;
  frame.mid_exposure = arrival - Duration{entry(index).exposure_to_arrival_ns};
  frame.arrival = arrival;
  frame.sequence = sequence;
  if (header_.reflectivity_bits == 8) {
    frame.reflectivity_8 = {reinterpret_cast<const std::uint8_t*>(reflectivity), width, height};
  } else {
    frame.reflectivity_16 = {reinterpret_cast<const std::uint16_t*>(reflectivity), width, height};
  }
  if (header_.has_depth != 0) {
    frame.depth = {reinterpret_cast<const std::uint16_t*>(depth), width, height};
  }
  return frame;
}

HeadPose FrameLoop::head(std::uint32_t index, Time arrival) const noexcept {
  const LoopFrame& from = entry(index);
  HeadPose head;
  head.time = arrival - Duration{from.exposure_to_arrival_ns};
  head.valid = from.head_valid != 0;
  const double* const q = from.rotation_xyzw;
  head.T_world_camera.rotation = Quaternion(q[3], q[0], q[1], q[2]);
  head.T_world_camera.translation =
      Vector3(from.position_m[0], from.position_m[1], from.position_m[2]);
  return head;
}

}  // namespace glint

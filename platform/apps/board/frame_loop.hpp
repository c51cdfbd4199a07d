// Loop of frames in memory, repeated forward and backward without limit: a simulated camera for a
// companion computer. glint_board_frames writes the file on the host; here it is memory-mapped.
//
// File, little endian, every part padded with zeros to a multiple of 64 bytes:
//   header   "GLNTLOOP" | u32 layout 1 | u32 width | u32 height | u32 bits of reflectivity (8, 16)
//            | u32 has depth (0, 1) | u32 frames | i64 period_ns
//   frame    i64 ns from mid-exposure to the last byte in memory | u32 kind | u32 head pose valid
//            | f64 x,y,z [m] of T_world_camera | f64 x,y,z,w of its rotation
//            then reflectivity, then depth (u16): rows from the top, no padding between rows
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "kernels/image/frame.hpp"
#include "kernels/pose/head_pose.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

enum class LoopFrameKind : std::uint32_t {
  rendered = 0,  // by the simulator
  worst = 1,     // drawn to reach a loop's maximum
};

struct FrameLoopHeader {
  char magic[8] = {'G', 'L', 'N', 'T', 'L', 'O', 'O', 'P'};
  std::uint32_t layout = 1;
  std::uint32_t width = 0, height = 0;
  std::uint32_t reflectivity_bits = 16;
  std::uint32_t has_depth = 0;
  std::uint32_t frames = 0;
  std::int64_t period_ns = 0;
};
static_assert(sizeof(FrameLoopHeader) == 40);

struct LoopFrame {
  std::int64_t exposure_to_arrival_ns = 0;
  LoopFrameKind kind = LoopFrameKind::rendered;
  std::uint32_t head_valid = 0;
  double position_m[3] = {0, 0, 0};
  double rotation_xyzw[4] = {0, 0, 0, 1};
};
static_assert(sizeof(LoopFrame) == 72);

inline constexpr std::size_t k_loop_alignment = 64;

// Writes such a file frame by frame; renames it to its final name when it is complete.
class FrameLoopWriter {
 public:
  // Throws InputError if the file cannot be created.
  FrameLoopWriter(std::string path, const FrameLoopHeader& header);
  ~FrameLoopWriter();
  FrameLoopWriter(const FrameLoopWriter&) = delete;
  FrameLoopWriter& operator=(const FrameLoopWriter&) = delete;

  void add(const LoopFrame& frame, const FrameBuffer& pixels);
  void close();  // throws InputError unless header.frames were added and all is on disk

 private:
  void write_padded(const void* bytes, std::size_t count);

  std::string path_, part_path_;
  FrameLoopHeader header_;
  std::uint32_t added_ = 0;
  int descriptor_ = -1;
};

// The file, mapped into memory.
class FrameLoop {
 public:
  // Throws InputError: "path:byte N: found; expected ...".
  explicit FrameLoop(const std::string& path);
  ~FrameLoop();
  FrameLoop(const FrameLoop&) = delete;
  FrameLoop& operator=(const FrameLoop&) = delete;

  [[nodiscard]] const FrameLoopHeader& header() const noexcept { return header_; }
  // Index in the file of the frame delivered as number `number`: forward, then backward, so that a
  // pen never jumps.
  [[nodiscard]] std::uint32_t index_of(std::uint64_t number) const noexcept;
  [[nodiscard]] const LoopFrame& entry(std::uint32_t index) const noexcept;
  // Pixels and head pose of a frame, with the given arrival time.
  [[nodiscard]] Frame view(std::uint32_t index, Time arrival,
                           std::uint64_t sequence) const noexcept;
  [[nodiscard]] HeadPose head(std::uint32_t index, Time arrival) const noexcept;

 private:
  [[nodiscard]] const std::byte* frame_bytes(std::uint32_t index) const noexcept;

  FrameLoopHeader header_;
  const std::byte* bytes_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace glint

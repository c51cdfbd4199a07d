// Single frames from files, for `glint inspect`.
//
// Layouts:
//   adi   512 x 512, for each pixel depth u16, confidence u8, active brightness u16, little-endian;
//         the brightness stands 32 columns to the right of the depth and is moved back
//   ahat  512 x 512, a plane of depth u16, then a plane of active brightness u16, little-endian:
//         what hl2ss sends in RAW mode
//   pgm   HoloLens2ForCV's recorder: NAME.pgm depth and NAME_ab.pgm active brightness, P5, 16 bit,
//         big-endian, any size up to the largest frame
#pragma once

#include <string>

#include "platform/sensors/frame_buffer.hpp"

namespace glint {

enum class FrameFileLayout { adi, ahat, pgm };

// Throws InputError naming what was found and expected.
[[nodiscard]] FrameFileLayout frame_file_layout_of(const std::string& name);

// pgm: the path of the depth or of the brightness picture; the other must stand beside it.
// Throws InputError naming the file, the place, what was found and expected.
[[nodiscard]] FrameBuffer load_frame(const std::string& path, FrameFileLayout layout);

// The file's bytes in layout ahat. Throws InputError, beginning with `what`, for a camera of
// another size.
[[nodiscard]] std::string ahat_bytes(const Frame& frame, const std::string& what);

}  // namespace glint

// Readers of single frames from files, for `glint inspect`.
//
// Layouts:
//   adi   512 x 512, for each pixel depth u16, confidence u8, active brightness u16, little-endian;
//         the brightness is displaced 32 columns to the right of the depth and is realigned
//   ahat  512 x 512, a plane of depth u16, then a plane of active brightness u16, little-endian:
//         the RAW mode of hl2ss
//   pgm   HoloLens2ForCV's recorder: NAME.pgm depth and NAME_ab.pgm active brightness, P5, 16 bit,
//         big-endian, any size up to the largest frame
#pragma once

#include <string>

#include "platform/formats/frame_buffer.hpp"

namespace glint {

enum class FrameFileLayout { adi, ahat, pgm };

// Throws InputError that states the found and the expected names.
[[nodiscard]] FrameFileLayout frame_file_layout_of(const std::string& name);

// pgm: path of the depth or the brightness image; the other must be in the same folder.
// Throws InputError that states the file, the position, found and expected.
[[nodiscard]] FrameBuffer load_frame(const std::string& path, FrameFileLayout layout);

// Returns the file's bytes in layout ahat. Throws InputError, beginning with `what`, for a camera
// of another size.
[[nodiscard]] std::string ahat_bytes(const Frame& frame, const std::string& what);

}  // namespace glint

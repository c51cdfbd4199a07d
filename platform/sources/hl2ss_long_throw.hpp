// Planes of hl2ss's long throw frames. Needs PNG: separate from the wire format, which a companion
// computer has too.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/formats/camera.hpp"

namespace glint {

// Returns the bytes of depth, then of active brightness: planes of u16. `png` is an image whose
// pixels are these bytes as blue, green, red and alpha. Throws InputError with `name`. Memory: that
// of an image of the camera's size.
[[nodiscard]] std::vector<std::uint8_t> hl2ss_long_throw_planes(std::span<const std::uint8_t> png,
                                                                const Camera& camera,
                                                                const std::string& name);

}  // namespace glint

// The files of `glint calibrate` that a cell may name, read into what the cell makes of them.
//
// Each reader asks for one table of the file and for its keys alone; what else calibrate wrote
// there, residuals and sigmas, is the user's. Throws InputError: file:line: table.key, what was
// found, what was expected.
#pragma once

#include <string>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/bias_correction.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/depth_bias.hpp"
#include "platform/cells/named_file.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// [depth_bias]: of the markers in use.
[[nodiscard]] DepthBias depth_bias_of(const NamedFile& file);

// [camera]: another lens for a camera of the same picture size.
[[nodiscard]] CameraModel lens_of(const NamedFile& file, const CameraModel& camera);

// [motion]: noise and damping; the rest is as built in.
[[nodiscard]] MotionSettings motion_of(const NamedFile& file);

// [correction]: a mean error and where it holds.
[[nodiscard]] BiasCorrection correction_of(const NamedFile& file);

}  // namespace glint

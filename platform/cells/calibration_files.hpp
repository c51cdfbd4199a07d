// The files of `glint calibrate` that a cell may name, read into what the cell makes of them.
//
// Each reader reads one table of the file; other tables and keys are for the user. Throws
// InputError: file:line: table.key, what was found, what was expected.
#pragma once

#include <string>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/bias_correction.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/depth_bias.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "platform/cells/named_file.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// [depth_bias]: of the markers in use.
[[nodiscard]] DepthBias depth_bias_of(const NamedFile& file);
// Of the same file: the bias's standard deviations, where it states them, and what the focal length
// by which the ranges were measured adds.
void read_range_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty);

// [camera]: another lens for a camera of the same picture size.
[[nodiscard]] CameraModel lens_of(const NamedFile& file, const CameraModel& camera);

// [motion]: noise and damping; the rest is as built in.
[[nodiscard]] MotionSettings motion_of(const NamedFile& file);

// [correction]: a mean error and where it holds.
[[nodiscard]] BiasCorrection correction_of(const NamedFile& file);

}  // namespace glint

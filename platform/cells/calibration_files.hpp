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
// Of the same file: the bias's standard deviations, where it states them.
void read_range_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty);

// [camera]: another lens for a camera of the same picture size.
[[nodiscard]] CameraModel lens_of(const NamedFile& file, const CameraModel& camera);

// What standard deviations of a bias's offset and of its slope leave open of all ranges, with the
// focal length by which they were measured, and the error over the range that neither follows.
void state_range_uncertainty(double offset_sigma_m, double slope_sigma,
                             CameraUncertainty& uncertainty);
// Of [camera]'s file: what it states of the principal point and the focal length.
void read_lens_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty);

// [motion]: noise and damping; the rest is as built in.
[[nodiscard]] MotionSettings motion_of(const NamedFile& file);

// [correction]: a mean error and where it holds.
[[nodiscard]] BiasCorrection correction_of(const NamedFile& file);

}  // namespace glint

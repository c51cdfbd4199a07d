// Readers of the `glint calibrate` files that a cell names: lens, depth bias, motion, correction.
//
// Each function reads one table of the file and ignores other tables and keys. Throws InputError:
// file:line: table.key, found, expected.
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

// [depth_bias]: valid for the markers in use.
[[nodiscard]] DepthBias depth_bias_of(const NamedFile& file);
// Same file: standard deviations of the bias, if stated.
void read_range_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty);

// [camera]: lens parameters. Requires the image size of `camera`.
[[nodiscard]] CameraModel lens_of(const NamedFile& file, const CameraModel& camera);

// Sets the range uncertainty from the standard deviations of a bias's offset and slope. Adds that
// of the focal length by which they were measured, and the range error that neither models.
void state_range_uncertainty(double offset_sigma_m, double slope_sigma,
                             CameraUncertainty& uncertainty);
// File of [camera]: standard deviations of principal point and focal length, if stated.
void read_lens_uncertainty(const NamedFile& file, CameraUncertainty& uncertainty);

// [motion]: process noise and damping; the rest has the built-in values.
[[nodiscard]] MotionSettings motion_of(const NamedFile& file);

// [correction]: mean error and its region of validity.
[[nodiscard]] BiasCorrection correction_of(const NamedFile& file);

}  // namespace glint

// Joint covariance of a tool's tip over several touches.
//
// Three rows per touch, of the mean of its observations. Contributions: random noise; each marker's
// slow errors, two Gauss-Markov processes; lens residual and range ripple, independent between
// positions; headset drift, a Gauss-Markov process, and its increase by head motion; the tip's
// error, which rotates with the tool. Calibration errors are constant: they are separate columns.
// Source: consider parameters: Bierman 1977, chapter VIII; means of a Gauss-Markov process over two
//         windows: Brown and Hwang 2012, section 3.6.
#pragma once

#include <Eigen/Core>
#include <span>

#include "platform/tools/verify/holds.hpp"

namespace glint {

// same: lens residual and range ripple are common to all touches.
enum class TouchPositions { apart, same };

// Covariance of all errors except the calibration errors.
[[nodiscard]] Eigen::MatrixXd joint_covariance(std::span<const Touch> touches,
                                               const StatedErrors& stated,
                                               TouchPositions positions);

// One column per calibration error: the effect of one stated sigma.
[[nodiscard]] Eigen::MatrixXd calibration_columns(std::span<const Touch> touches);

}  // namespace glint

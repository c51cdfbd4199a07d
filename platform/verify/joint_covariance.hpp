// How the errors of a tool's tip in several touches hang together.
//
// Of the means of sightings, three rows a touch: random noise; each marker's slow errors, two
// Gauss-Markov processes; the lens's residual and the range's ripple, which differ from place to
// place; the headset's drift, which returns with its correlation time, and what the head's motion
// adds; the tip's error, which turns with the tool. Calibration errors are constant: they are
// columns of their own. Source: consider parameters: Bierman 1977, chapter VIII; means of a
// Gauss-Markov process over two
//         windows: Brown and Hwang 2012, section 3.6.
#pragma once

#include <Eigen/Core>
#include <span>

#include "platform/verify/holds.hpp"

namespace glint {

enum class Places { apart, same };  // touches in one place have lens and ripple in common

// All but the calibration errors.
[[nodiscard]] Eigen::MatrixXd joint_covariance(std::span<const Touch> touches,
                                               const StatedErrors& stated, Places places);

// A column each, for one stated sigma.
[[nodiscard]] Eigen::MatrixXd calibration_columns(std::span<const Touch> touches);

}  // namespace glint

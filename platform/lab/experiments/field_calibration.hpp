// A field's device after its user's calibrations, each from a recording of the same device: lens,
// tool, ranges, tip, noise at rest, the headset's drift.
#pragma once

#include "platform/cells/cell.hpp"

namespace glint {

// What a user has measured apart: the tool's two markers farthest apart, by calliper.
inline constexpr double k_calliper_sigma_m = 0.0001;

// Of the recordings.
struct CalibrationSeconds {
  double board = 14, turn = 90, pivot = 40, rest = 120, look = 60;
};

// `drawn`: a cell of scenario "field", as field_cell() gives it, with one tool. Throws InputError
// where a calibration refuses its recording.
[[nodiscard]] Cell calibrated_field_cell(const Cell& drawn, const CalibrationSeconds& seconds = {});

}  // namespace glint

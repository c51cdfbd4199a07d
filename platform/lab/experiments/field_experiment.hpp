// Accuracy and consistency of the output for simulated devices with calibration errors.
//
// Each random seed draws one device, tool, headset and robot (platform/sim/field.hpp) and runs
// them for 30 s with the shipped settings, uncalibrated. Judged at the output: every tick's pose
// against truth, in the robot's frame, at the actuation time. A second row judges the same runs
// without the device's errors, their settings stated as exact: what noise, motion and the
// headset's drift leave. With tries, so many seeds after their user's calibrations, beside an
// oracle on the same devices; finished runs stand in field_runs.txt. With data, a real frame of
// hands and a drill stands behind the tool of every fourth device.
#pragma once

#include <cstdint>

#include "platform/lab/experiments/case_list.hpp"
#include "platform/runtime/session/session.hpp"
#include "platform/sim/room.hpp"

namespace glint {

// As drawn and uncalibrated; after its user's calibrations (field_calibration.hpp); an
// oracle, for which every constant error is corrected; without errors.
enum class FieldDevice { drawn, calibrated, oracle, exact };

// The built-in cell with the device of a random seed; nothing leaves the process.
[[nodiscard]] Cell field_cell(std::uint64_t seed, double duration_s);

// One random seed's run. background: empty: the simulator's room.
[[nodiscard]] SessionResult run_field_device(FieldDevice device, std::uint64_t seed,
                                             double duration_s, const std::string& out,
                                             const sim::BackgroundFrame& background = {});

[[nodiscard]] CaseList run_field(const CaseOptions& options);

}  // namespace glint

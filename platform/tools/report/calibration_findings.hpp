// Findings of calibration errors larger than their stated standard deviations, estimated from the
// sums of kernels/pose/calibration_errors.
//
// An error is assessed only if the data reduce its variance to less than half of the stated one.
// Errors that the data do not separate form one finding: a range offset and a range scale at a
// single range. Sizes are in stated standard deviations, along the principal axes of the remaining
// covariance.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/motion/world_errors.hpp"
#include "kernels/pose/calibration_errors.hpp"

namespace glint {

enum class ErrorSource : std::uint8_t {
  range_offset,
  range_scale,
  range,  // range offset and scale, not separated
  principal_point,
  focal_length,
  time_offset,  // of the head poses relative to the frames
  head_drift,   // of the headset's own localisation
  tool_geometry
};

[[nodiscard]] std::string_view name_of(ErrorSource source);

struct CalibrationFinding {
  std::string tool;  // the tool's name; empty: an error common to all tools
  ErrorSource source = ErrorSource::range;
  // Units: m for offsets (at range_m), for `range` (at range_m) and for the geometry (rms of the
  // markers); 1 for scales; px for the principal point (its distance); s for time; for the drift
  // the ratio to the declared drift.
  double estimate = 0, sigma = 0, range_m = 0;
  double size_in_stated_sigmas = 0;  // size of the error
  // Over the axes that the data determine. 0 axes: more than half of the stated variance remains.
  double chi_square = 0;
  int axes = 0;
  bool exceeds_stated = false;  // larger than the stated standard deviations explain
};

// Unit in which the estimate of a source is printed.
struct ErrorUnit {
  const char* text;
  double per_base;
};
[[nodiscard]] ErrorUnit unit_of(ErrorSource source);

// Example: "pen: tool geometry 1.20 mm (sigma 0.31), 4.0 times what is stated; glint calibrate
// tool".
[[nodiscard]] std::string text_of(const CalibrationFinding& finding);

// Newest findings, shared by the thread that computes them and the thread that publishes them.
class CalibrationFindingsStore {
 public:
  void set(std::vector<CalibrationFinding> findings);
  [[nodiscard]] std::vector<CalibrationFinding> all() const;

 private:
  mutable std::mutex mutex_;
  std::vector<CalibrationFinding> findings_;
};

// Accumulated errors of one tool.
struct ToolErrors {
  std::string tool;  // the tool's name
  int markers = 0;
  double marker_sigma_m = 0;  // as stated
  CalibrationErrors sums;     // of at least one fit
};

// Returns findings of the errors common to all tools and of each tool's own. world: errors of a
// static body, null if there is none. time_sigma_s: stated standard deviation of the time offset of
// the head poses relative to the frames.
[[nodiscard]] std::vector<CalibrationFinding> calibration_findings(
    std::span<const ToolErrors> tools, const CameraUncertainty& stated,
    const WorldErrors* world = nullptr, double time_sigma_s = 0);

}  // namespace glint

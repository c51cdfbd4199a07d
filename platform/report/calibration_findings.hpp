// Which calibration errors are larger than stated, out of the sums of
// kernels/pose/calibration_errors.
//
// An error counts where the data show it: where they leave less than half of its stated variance.
// Errors that the data do not separate are one finding: a range offset and a range scale at one
// range. Sizes are in stated standard deviations, along the axes of what the data leave.
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
  range,  // the two, not separated
  principal_point,
  focal_length,
  time_offset,  // of the head's poses against the frames
  head_drift,   // of the headset's own localisation
  tool_geometry
};

[[nodiscard]] std::string_view name_of(ErrorSource source);

struct CalibrationFinding {
  std::string tool;  // its name; empty: an error that all tools share
  ErrorSource source = ErrorSource::range;
  // Of an offset and of `range` m, at range_m; of scales 1; of the principal point its distance,
  // px; of the time s; of the drift the factor of what is declared; of the geometry the markers'
  // rms, m.
  double estimate = 0, sigma = 0, range_m = 0;
  double stated_sigmas = 0;  // the error's size
  // Along the axes that the data show; 0 axes: they leave more than half of its stated variance.
  double chi_square = 0;
  int axes = 0;
  bool named = false;  // larger than the stated standard deviations explain
};

// In which unit a source's estimate is printed.
struct ErrorUnit {
  const char* text;
  double per_base;
};
[[nodiscard]] ErrorUnit unit_of(ErrorSource source);

// "pen: tool geometry 1.20 mm (sigma 0.31), 4.0 times what is stated; glint calibrate tool".
[[nodiscard]] std::string text_of(const CalibrationFinding& finding);

// The newest findings, between two threads: one computes them, one publishes them.
class CalibrationNotes {
 public:
  void set(std::vector<CalibrationFinding> findings);
  [[nodiscard]] std::vector<CalibrationFinding> all() const;

 private:
  mutable std::mutex one_;
  std::vector<CalibrationFinding> findings_;
};

// What was seen of one tool.
struct ToolErrors {
  std::string tool;  // its name
  int markers = 0;
  double marker_sigma_m = 0;  // as stated
  CalibrationErrors sums;     // of at least one fit
};

// Of the errors that the tools share, and of each tool's own. world: of a body that stands still,
// null: none; time_sigma_s: of the head's poses against the frames, as stated.
[[nodiscard]] std::vector<CalibrationFinding> calibration_findings(
    std::span<const ToolErrors> tools, const CameraUncertainty& stated,
    const WorldErrors* world = nullptr, double time_sigma_s = 0);

}  // namespace glint

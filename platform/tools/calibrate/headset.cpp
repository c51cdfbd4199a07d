#include "platform/tools/calibrate/headset.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/runtime/session/calibration_watch.hpp"

namespace glint {

HeadsetCalibration calibrate_headset(RecordedFrames& recorded, std::size_t tool) {
  recorded.cell.reference = static_cast<int>(tool);
  const auto watch = std::make_unique<CalibrationMonitor>(recorded.cell);
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked,
                   [&](const ArrivedFrame&, Tracker& tracker) { watch->add_frame(tracker); });
  HeadsetCalibration result;
  result.frames = tracked.frames;
  result.failures = std::move(tracked.failures);
  const std::vector<CalibrationFinding> findings = watch->findings();
  const auto find = [&](ErrorSource source) {
    return std::find_if(findings.begin(), findings.end(), [&](const CalibrationFinding& finding) {
      return finding.source == source;
    });
  };
  const auto drift = find(ErrorSource::head_drift), time = find(ErrorSource::time_offset);
  if (drift == findings.end()) {
    throw InputError(
        recorded.path + ": the tool \"" + recorded.cell.tools.items[tool].name.data() +
        "\" and a head pose are in too few of " + std::to_string(tracked.frames) +
        " frames; expected both for 20 s or more: lay the tool down and view it from all sides");
  }
  result.best_factor = drift->estimate;
  result.sigma = drift->sigma / drift->estimate;
  result.factor = result.best_factor * (1 + result.sigma);
  if (time != findings.end()) {
    result.head_delay_s = time->estimate;
    result.head_late_sigma_s = time->sigma;
  }
  result.noise = recorded.cell.head_noise;
  HeadNoise& noise = result.noise;
  for (double* part :
       {&noise.rest_position_m, &noise.rest_angle_rad, &noise.position_per_speed_s,
        &noise.position_per_turn_m, &noise.angle_per_speed_s_m, &noise.angle_per_turn_s})
    *part *= result.factor;
  return result;
}

}  // namespace glint

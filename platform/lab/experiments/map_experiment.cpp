#include "platform/lab/experiments/map_experiment.hpp"

#include <cmath>
#include <limits>

#include "platform/tools/mapping/depth_png.hpp"
#include "platform/tools/mapping/map_halves.hpp"

namespace glint {
namespace {

constexpr std::size_t k_planes_judged = 3;
constexpr double k_missing = std::numeric_limits<double>::infinity();

ExperimentCase case_of(const PlaneAgreement& plane, std::size_t place) {
  ExperimentCase out{"plane " + std::to_string(place + 1), "glint", plane.points, {}};
  out.figures = {
      {"angle", "deg", plane.matched ? plane.angle_deg : k_missing, Bar::at_most(0.15)},
      {"offset", "mm", plane.matched ? 1e3 * plane.offset_m : k_missing, Bar::at_most(0.5)},
      {"voxel_rms", "mm", 1e3 * plane.voxel_rms_m},
      {"smooth_rms", "mm", 1e3 * plane.smooth_rms_m},
      {"rms_part", "", plane.smooth_rms_m / plane.voxel_rms_m, Bar::at_most(0.5)},
      {"held_out_mean", "mm", plane.held_out > 0 ? 1e3 * std::abs(plane.held_out_m) : k_missing,
       Bar::at_most(1.5)}};
  return out;
}

}  // namespace

CaseList run_map(const CaseOptions& options) {
  const DepthSequence sequence = load_depth_sequence(options.data);
  MapSettings settings;
  if (options.quick) settings.depth.stride = 3;
  if (options.progress) options.progress(0, 2);
  const MapHalves halves = compare_halves(sequence, settings);
  if (options.progress) options.progress(2, 2);
  CaseList out;
  out.experiment = "map";
  for (std::size_t i = 0; i < halves.planes.size(); ++i) {
    out.cases.push_back(case_of(halves.planes[i], i));
  }
  out.cases.push_back(
      {"all planes",
       "glint",
       halves.projected,
       {{"planes", "", static_cast<double>(halves.planes.size()),
         Bar::at_least(static_cast<double>(k_planes_judged))},
        {"moved_most", "mm", 1e3 * halves.displacement_max_m,
         Bar::at_most(1e3 * static_cast<double>(settings.planes.gate.threshold_m) + 1e-3)},
        {"swallowed", "", halves.wrong_normal_share, Bar::at_most(0.02)}}});
  return out;
}

}  // namespace glint

#include "platform/experiments/estimator_settings.hpp"

#include <nlohmann/json.hpp>

#include "platform/experiments/declared.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

Json correspond_json(const CorrespondSettings& settings) {
  return {{"focal_px", settings.focal_px},
          {"area_factor", settings.area_factor},
          {"range_sigma_m", settings.range_sigma_m},
          {"pixel_sigma_px", settings.pixel_sigma_px},
          {"gate_sigmas", settings.gate_sigmas},
          {"delta_min_m", settings.delta_min_m},
          {"max_rms_m", settings.max_rms_m},
          {"prior_gate_m", settings.prior_gate_m},
          {"min_markers_without_prior", settings.min_markers_without_prior},
          {"min_markers_with_prior", settings.min_markers_with_prior},
          {"fewer_kept", settings.fewer_kept},
          {"markers_max", settings.markers_max},
          {"search_steps_max", settings.search_steps_max}};
}

Json pixel_noise_json(const PixelNoise& noise) {
  return {{"read_counts", noise.read_counts},
          {"shot_counts", noise.shot_counts},
          {"proportional", noise.proportional}};
}

}  // namespace

std::string estimator_text() {
  const EstimatorSettings settings;
  return Json{{"correspond", correspond_json(settings.correspond)},
              {"pixel_noise", pixel_noise_json(settings.pixel_noise)}}
      .dump();
}

std::string estimator_hash() { return fnv1a_text(estimator_text()); }

}  // namespace glint

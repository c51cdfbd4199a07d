#include "platform/lab/experiments/estimator_settings.hpp"

#include <nlohmann/json.hpp>

#include "platform/lab/experiments/declared.hpp"

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
          {"few_gate_m", settings.partial_gate_m},
          {"min_markers_without_prior", settings.min_markers_without_prior},
          {"min_markers_with_prior", settings.min_markers_with_prior},
          {"fewer_kept", settings.fewer_markers_max},
          {"markers_max", settings.markers_max},
          {"search_steps_max", settings.search_steps_max}};
}

Json pixel_noise_json(const PixelNoise& noise) {
  return {{"read_counts", noise.read_counts},
          {"shot_counts", noise.shot_counts},
          {"proportional", noise.proportional}};
}

Json adaptation_json(const AdaptationSettings& settings) {
  return {{"frames", settings.frames},
          {"floor", settings.floor},
          {"ceiling", settings.ceiling},
          {"innovation_max", settings.nis_ratio_max}};
}

Json motion_json(const ToolMotionSettings& settings) {
  return {{"linear_noise_m2_s5", settings.motion.linear_noise_m2_s5},
          {"linear_damping_1_s", settings.motion.linear_damping_1_s},
          {"angular_noise_rad2_s5", settings.motion.angular_noise_rad2_s5},
          {"angular_damping_1_s", settings.motion.angular_damping_1_s},
          {"start_speed_m_s", settings.motion.start_speed_m_s},
          {"start_turn_rad_s", settings.motion.start_angular_speed_rad_s},
          {"linear", adaptation_json(settings.linear)},
          {"angular", adaptation_json(settings.angular)},
          {"short_chi_square_max", settings.rest.short_chi_square_max},
          {"long_chi_square_max", settings.rest.long_chi_square_max},
          {"drift_chi_square", settings.rest.drift_chi_square},
          {"frames_min", settings.rest.frames_min},
          {"rest_gap_max_ns", settings.rest.gap_max.nanoseconds},
          {"partial_noise", settings.partial_visibility_noise},
          {"briskest_frames", settings.peak_scale_frames},
          {"gap_max_ns", settings.gap_max.nanoseconds}};
}

Json refine_json(const RefineSettings& settings) {
  return {{"steps_max", settings.steps_max},
          {"left_out_max", settings.rejected_max},
          {"left_out_steps_max", settings.rejection_steps_max},
          {"markers_left_least", settings.markers_kept_min}};
}

}  // namespace

std::string estimator_text() {
  const EstimatorSettings settings;
  return Json{{"correspond", correspond_json(settings.correspond)},
              {"pixel_noise", pixel_noise_json(settings.pixel_noise)},
              {"motion", motion_json(settings.motion)},
              {"refine", refine_json(settings.refine)}}
      .dump();
}

std::string estimator_hash() { return fnv1a_text(estimator_text()); }

}  // namespace glint

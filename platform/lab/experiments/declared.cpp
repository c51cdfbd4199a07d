#include "platform/lab/experiments/declared.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>

#include "platform/lab/baseline/baseline_settings.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Json camera_json(const Camera& camera) {
  return {{"name", camera.name},
          {"threshold", camera.threshold},
          {"period_ns", camera.period.nanoseconds},
          {"exposure_ns", camera.exposure.nanoseconds},
          {"focal_px", camera.model.fx}};
}

Json noise_json(const sim::NoiseSettings& noise) {
  return {{"blob_pixel_sigma_px", noise.blob_pixel_sigma_px},
          {"blob_range_sigma_m", noise.blob_range_sigma_m},
          {"read_sigma", noise.read_sigma},
          {"shot_counts", noise.shot_counts},
          {"depth_floor_m", noise.depth_floor_m},
          {"depth_at_100_counts_m", noise.depth_at_100_counts_m},
          {"signal_min", noise.signal_min},
          {"depth_saturation", noise.depth_saturation}};
}

Json signal_json(const sim::SignalSettings& signal) {
  return {{"marker", signal.marker},
          {"skin", signal.skin},
          {"pen_body", signal.pen_body},
          {"wall", signal.wall},
          {"sphere_limb", signal.sphere_limb}};
}

Json localisation_json(const sim::LocalisationSettings& settings) {
  return {{"rest_position_m", settings.rest_position_m},
          {"rest_angle_rad", settings.rest_angle_rad},
          {"rest_correlation_s", settings.rest_correlation_s},
          {"position_per_speed_s", settings.position_per_speed_s},
          {"position_per_turn_m", settings.position_per_angular_speed_m},
          {"angle_per_speed_s_m", settings.angle_per_speed_s_m},
          {"angle_per_turn_s", settings.angle_per_angular_speed_s},
          {"motion_correlation_s", settings.motion_correlation_s},
          {"motion_position_bias", vector_json(settings.motion_position_bias)},
          {"motion_angle_bias", vector_json(settings.motion_angle_bias)},
          {"latency_s", settings.latency_s},
          {"pivot_m", settings.pivot_m}};
}

Json baseline_json(const BaselineSettings& settings) {
  return {{"delta_m", settings.delta_m},
          {"max_rms_m", settings.max_rms_m},
          {"min_markers", settings.min_markers},
          {"roi_margin_px", settings.roi_margin_px}};
}

}  // namespace

std::string declared_parameters(const std::vector<ExperimentRun>& runs) {
  Json json;
  if (!runs.empty()) {
    const sim::Scenario& scenario = runs.front().scenario;
    json["camera"] = camera_json(scenario.camera);
    json["noise"] = noise_json(scenario.noise);
    json["signal"] = signal_json(scenario.signal);
    json["localisation"] = localisation_json(scenario.localisation);
    json["reference"] = {{"position_sigma_m", scenario.reference.position_sigma_m},
                         {"angle_sigma_rad", scenario.reference.angle_sigma_rad}};
  }
  json["baseline_settings"] = baseline_json(BaselineSettings{});
  json["runs"] = Json::array();
  for (const ExperimentRun& run : runs) {
    json["runs"].push_back({{"seed", run.scenario.seed},
                            {"skipped", run.skipped},
                            {"aligning", run.aligning},
                            {"judged", run.judged}});
  }
  return json.dump();
}

std::string fnv1a_text(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3u;
  }
  constexpr std::string_view digits = "0123456789abcdef";
  std::string name;
  for (int shift = 60; shift >= 0; shift -= 4) name += digits[hash >> shift & 0xF];
  return name;
}

}  // namespace glint

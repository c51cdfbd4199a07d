#include "platform/lab/experiments/centroid_cases.hpp"

#include <cmath>

#include "kernels/image/blob.hpp"

namespace glint {
namespace {

constexpr double k_focal_px = 253;
constexpr double k_diameters_px[] = {4, 5, 6, 8, 10};
// The rim error varies with the diameter at the period of a pixel: diameters cover a pixel evenly.
constexpr double k_diameter_spread_px = 0.5;
// Error of the renderer itself: with 64 rays per rim pixel, its signal is off by up to a hundredth,
// independently from pixel to pixel; a motion-blurred sphere is the mean of eight renderings.
constexpr double k_render_error = 0.006, k_blurred_render_error = 0.002;

CentroidCase base(const std::string& name, double diameter_px) {
  CentroidCase one;
  one.name = name;
  one.diameter_px = diameter_px;
  Camera& camera = one.setting.camera;
  camera.name = "pinhole";
  camera.model.fx = camera.model.fy = k_focal_px;
  camera.threshold = 1280;
  one.setting.range_m = range_of_diameter(diameter_px, k_focal_px, one.setting.radius_m);
  const sim::NoiseSettings& noise = one.setting.noise;
  one.stated = {noise.read_sigma, noise.shot_counts, k_render_error};
  return one;
}

void add_motion_blur(CentroidCase& one) {
  one.setting.smear_px = 2;
  one.stated.proportional = k_blurred_render_error;
}

CentroidCase sized(const std::string& kind, double diameter_px) {
  CentroidCase one =
      base(kind + ", " + std::to_string(static_cast<int>(diameter_px)) + " px", diameter_px);
  one.setting.radius_spread_m = one.setting.radius_m * k_diameter_spread_px / diameter_px;
  one.rms_max_px = diameter_px < 5 ? 0.04 : 0.03;
  return one;
}

// Sets the peak signal to `times` the sensor's full scale.
void saturate(CentroidCase& one, double times) {
  one.setting.peak_counts = times * 65535.0;
  one.rms_max_px = one.diameter_px < 5 ? 0.08 : one.diameter_px < 6 ? 0.06 : 0.05;
}

// 70 counts of 8 bits, noise 2 % of full scale, threshold half-way.
void reduce_signal(CentroidCase& one) {
  one.setting.camera.reflectivity_bits = 8;
  one.setting.camera.threshold = 55;
  one.setting.background_counts = 20;
  one.setting.peak_counts = 70;
  one.setting.noise.read_sigma = 0.02 * 255;
  one.setting.noise.shot_counts = 0;
  one.stated = {one.setting.noise.read_sigma, 0, k_render_error};
  one.rms_max_px = 0.08;
}

// Diameter 6.2 px: between two spheres 8 px apart exactly one pixel column stays dark.
CentroidCase disturbed(const std::string& name, std::uint8_t flag) {
  CentroidCase one = base(name, 6.2);
  one.whole = false;
  one.flag = flag;
  return one;
}

CentroidCase off_axis(const std::string& name, double range_m, const Camera* camera) {
  CentroidCase one = base(name, 6);
  if (camera != nullptr) one.setting.camera = *camera;
  one.setting.range_m = range_m;
  one.setting.off_axis_rad = 3.14159265358979323846 / 4;
  return one;
}

}  // namespace

std::vector<CentroidCase> sized_cases() {
  std::vector<CentroidCase> cases;
  for (const double diameter : k_diameters_px) cases.push_back(sized("plain", diameter));
  for (const double diameter : k_diameters_px) {
    cases.push_back(sized("smeared by 2 px", diameter));
    add_motion_blur(cases.back());
  }
  for (const double diameter : k_diameters_px) {
    cases.push_back(sized("3 x saturated", diameter));
    saturate(cases.back(), 3);
  }
  for (const double diameter : k_diameters_px) {
    cases.push_back(sized("3 x saturated, smeared", diameter));
    saturate(cases.back(), 3);
    add_motion_blur(cases.back());
  }
  for (const double diameter : k_diameters_px) {
    cases.push_back(sized("70 counts, 2 % noise", diameter));
    reduce_signal(cases.back());
  }
  return cases;
}

std::vector<CentroidCase> disturbed_cases() {
  std::vector<CentroidCase> cases;
  cases.push_back(disturbed("cut by the frame", k_blob_touches_edge));
  cases.back().setting.place_px = {0.5, 32};
  cases.push_back(disturbed("another beside", k_blob_has_neighbour));
  cases.back().setting.second_offset_px = {8, 0};
  cases.push_back(disturbed("merged with another", k_blob_partial_or_merged));
  cases.back().setting.second_offset_px = {6, 0};
  cases.push_back(sized("1.2 x saturated", 6));
  saturate(cases.back(), 1.2);
  cases.back().whole = false;
  cases.back().flag = k_blob_saturated;
  cases.push_back(sized("10 x saturated", 6));
  saturate(cases.back(), 10);
  cases.back().rms_max_px = 0;
  return cases;
}

std::vector<CentroidCase> off_axis_cases() {
  const Camera headset = hololens2_ahat();
  return {off_axis("45 deg, 0.5 m, pinhole", 0.5, nullptr),
          off_axis("45 deg, 0.3 m, pinhole", 0.3, nullptr),
          off_axis("45 deg, 0.5 m, AHAT", 0.5, &headset),
          off_axis("45 deg, 0.3 m, AHAT", 0.3, &headset)};
}

}  // namespace glint

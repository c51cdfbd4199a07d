// Description of one time-of-flight camera: lens, depth, reflectivity, timing, noise, and presets.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/image/pixel_noise.hpp"
#include "kernels/motion/correlated_errors.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/depth_settings.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "kernels/units.hpp"

namespace glint {

struct Camera {
  std::string name;
  CameraModel model;
  DepthSettings depth;
  int reflectivity_bits = 16;   // 8: Frame::reflectivity_8, 16: Frame::reflectivity_16
  std::uint16_t threshold = 0;  // a marker's pixels are brighter; 0: not declared
  PixelNoise noise{};           // of reflectivity; no device's is published
  // Standard deviations of a marker's range and of its centre (per axis), in addition to the noise
  // of its pixels. Measured on a HoloLens 2 at 0.4 to 0.7 m: 0.5 to 1.1 mm and 0.035 px.
  double range_sigma_m = 0.0015, pixel_sigma_px = 0.1;
  bool estimate_noise = true;  // refine these online from the residuals of the tools' fits
  CameraUncertainty uncertainty;
  CorrelationTimes correlation;  // of errors that are correlated over many frames
  Duration period;               // nominal gap between frames
  Duration exposure;
  Duration transport;                               // end of exposure -> last byte in memory
  double range_min_m = 0.15, range_max_m = 1.0;     // range in which tools are expected
  std::shared_ptr<const std::vector<float>> table;  // owns model.table.rays, if any
};

// HoloLens 1 short-throw: 448 x 450, 30 Hz, 8-bit reflectivity, Brown lens, threshold 250 (Puljiz
// et al.).
[[nodiscard]] Camera hololens1_short_throw();

// HoloLens 2 AHAT: 512 x 512, 45 Hz, 16-bit, radial depth that wraps at 1.055 m, rational lens.
[[nodiscard]] Camera hololens2_ahat();

// HoloLens 2 long throw: 320 x 288, radial depth.
// Azure Kinect and Femto Bolt: 1024 x 1024 wide, 640 x 576 narrow, binned 512 x 512 and 320 x 288;
// z depth.
// Magic Leap 2: 544 x 480, short range, radial depth.
// generic: z depth in millimetres, 16 bits; the cell must state its size as well.
// None of these has a lens or a threshold.
[[nodiscard]] std::optional<Camera> camera_named(std::string_view name);
// Returns "hololens2_ahat, hololens1_short_throw, ...".
[[nodiscard]] std::string camera_names();
// Returns whether pixels have rays; a preset without a published calibration has none.
[[nodiscard]] bool has_lens(const Camera& camera);

// Returns the camera with a device's own table of unit rays: .npy (float32, pixels x 3 or h x w x
// 3), StreamRecorder's _lut.bin, or hl2ss's calibration as its server sends it. Throws InputError
// that names the file, the position and the expectation.
[[nodiscard]] Camera with_ray_table(Camera camera, const std::string& path);
// Same with 3 numbers per pixel; zeros where the lens maps nothing.
[[nodiscard]] Camera with_rays(Camera camera, std::vector<float> rays, const std::string& path);

// hl2ss's calibration, float32 little-endian: x and y of each pixel on the plane z = 1, 16 of the
// extrinsics, scale, alias (wrapped ranges only), a map of two planes, 4 of the undistorted image.
inline constexpr std::size_t k_hl2ss_extrinsics = 16;
[[nodiscard]] std::size_t hl2ss_calibration_bytes(const CameraModel& model, bool alias);
// Returns its unit rays, 3 numbers per pixel. Requires one of the sizes above.
[[nodiscard]] std::vector<float> rays_of_hl2ss_calibration(std::span<const std::uint8_t> bytes,
                                                           const CameraModel& model);

}  // namespace glint

#include "platform/lab/experiments/centroid_methods.hpp"

#include <limits>

#include "kernels/image/centroid.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "platform/lab/baseline/front_end.hpp"

namespace glint {
namespace {

constexpr std::uint32_t k_area_max_px = 2000;

// Saturation level: the sensor's largest value.
std::uint16_t saturated_from(const Camera& camera) {
  return camera.reflectivity_bits == 8 ? 255 : 0xFFFF;
}

// Returns the index of the position nearest to `to`, or -1 if none is within k_near_px. `at(i)`
// returns position i.
template <class At>
int nearest(int count, const Vector2& to, At at) {
  int best = -1;
  double least = CentroidMethods::k_near_px;
  for (int i = 0; i < count; ++i) {
    const double distance = (at(i) - to).norm();
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

}  // namespace

CentroidMethods::CentroidMethods(const Camera& camera, const PixelNoise& noise,
                                 const NominalMarker& nominal)
    : camera_(camera),
      settings_{2, k_area_max_px, camera.threshold, saturated_from(camera), noise},
      nominal_(nominal),
      shift_(sphere_offset(camera.model)),
      baseline_(std::make_unique<BaselineFrontEnd>(camera, BaselineSettings{})) {}

CentroidMethods::~CentroidMethods() = default;

std::optional<CentroidMethods::Located> CentroidMethods::locate(const Frame& frame,
                                                                const Vector2& truth_px) {
  threshold_runs(frame, whole_frame(frame), settings_.threshold, {}, *runs_);
  const Runs* const bands[] = {runs_.get()};
  find_blobs(frame, bands, settings_, {}, *scratch_, *blobs_);
  const int found = nearest(blobs_->count, truth_px, [&](int i) -> const Vector2& {
    return blobs_->items[static_cast<std::size_t>(i)].centroid_px;
  });
  if (found < 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(found);
  const Component& component = scratch_->components[scratch_->candidate[at]];
  Located out;
  out.blob = blobs_->items[at];
  out.weighted = weighted_centroid(frame, *scratch_, component, settings_.threshold).position_px;
  out.binary = binary_centroid(frame, *scratch_, component).position_px;
  Marker marker;
  if (measure_marker(frame, out.blob, 0, camera_.model, shift_, camera_.depth, nominal_, marker)) {
    out.marker = marker;
  }
  return out;
}

std::optional<Vector2> CentroidMethods::locate_by_baseline(const Frame& frame,
                                                           const Vector2& truth_px) {
  baseline_->undistort(frame);
  baseline_->threshold(baseline_->whole());
  baseline_->halve();
  baseline_->detect();
  const auto blobs = baseline_->blobs();
  const auto place = [&](int i) {
    return baseline_->raw_pixel(blobs[static_cast<std::size_t>(i)].centre_px);
  };
  const int found = nearest(static_cast<int>(blobs.size()), truth_px, place);
  if (found < 0) return std::nullopt;
  return place(found);
}

}  // namespace glint

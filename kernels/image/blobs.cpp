#include "kernels/image/blobs.hpp"

#include <algorithm>

#include "kernels/image/centroid.hpp"
#include "kernels/image/components.hpp"

namespace glint {
namespace {

using Index = std::uint16_t;

// The predictions in half pixels. As small whole numbers they stay exact in float, which every
// vector unit multiplies; far outside the frame the order among them is of no interest.
struct Predictions {
  std::array<float, k_predictions_max> x{}, y{};
  int count = 0;
};

Predictions in_half_pixels(std::span<const Vector2> predicted_px) {
  Predictions out;
  for (const Vector2& pixel : predicted_px) {
    if (out.count == k_predictions_max) break;
    if (!(pixel.squaredNorm() < 1e12)) continue;
    const auto at = static_cast<std::size_t>(out.count++);
    out.x[at] = static_cast<float>(std::clamp(static_cast<int>(2 * pixel.x()), -512, 1536));
    out.y[at] = static_cast<float>(std::clamp(static_cast<int>(2 * pixel.y()), -512, 1536));
  }
  return out;
}

// Squared, in half pixels, from the middle of the component's box; 0 where nothing is predicted.
std::uint32_t nearest(const Component& component, const Predictions& predictions) {
  if (predictions.count == 0) return 0;
  const auto x = static_cast<float>(component.x0 + component.x1);
  const auto y = static_cast<float>(component.y0 + component.y1);
  float least = 1e9f;
  for (int i = 0; i < predictions.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float dx = x - predictions.x[at], dy = y - predictions.y[at];
    least = std::min(least, dx * dx + dy * dy);
  }
  return static_cast<std::uint32_t>(least);
}

// Keeps the best k_blobs_max candidates, in the components' order.
void keep_best(std::span<const Vector2> predicted_px, BlobScratch& scratch, int& candidates) {
  const Predictions predictions = in_half_pixels(predicted_px);
  for (int i = 0; i < candidates; ++i) {
    const Index index = scratch.candidate[static_cast<std::size_t>(i)];
    scratch.distance[index] = nearest(scratch.components[index], predictions);
  }
  const auto first = scratch.candidate.begin();
  std::partial_sort(first, first + k_blobs_max, first + candidates, [&](Index a, Index b) {
    const std::uint32_t da = scratch.distance[a], db = scratch.distance[b];
    return da != db ? da < db : a < b;
  });
  candidates = k_blobs_max;
  std::sort(first, first + candidates);
}

Blob blob_of(const Frame& frame, const BlobScratch& scratch, const Component& component,
             const BlobSettings& settings) {
  const Centroid centroid = grown_centroid(frame, scratch, component, settings.threshold);
  Blob blob;
  blob.centroid_px = centroid.position_px;
  blob.area_px = component.area_px;
  blob.x0 = component.x0;
  blob.y0 = component.y0;
  blob.x1 = component.x1;
  blob.y1 = component.y1;
  blob.peak = centroid.peak;
  const bool cut =
      blob.x0 == 0 || blob.y0 == 0 || blob.x1 >= frame.width() || blob.y1 >= frame.height();
  if (cut) blob.flags |= k_blob_touches_edge;
  if (blob.peak >= settings.saturated_from) blob.flags |= k_blob_saturated;
  return blob;
}

bool before(const Blob& a, const Blob& b) {
  if (a.y0 != b.y0) return a.y0 < b.y0;
  if (a.x0 != b.x0) return a.x0 < b.x0;
  if (a.centroid_px.x() != b.centroid_px.x()) return a.centroid_px.x() < b.centroid_px.x();
  return a.centroid_px.y() < b.centroid_px.y();
}

}  // namespace

void find_blobs(const Frame& frame, std::span<const Runs* const> bands,
                const BlobSettings& settings, std::span<const Vector2> predicted_px,
                BlobScratch& scratch, Blobs& out) noexcept {
  out.count = 0;
  out.dropped = 0;
  out.reason = Reason::none;
  for (const Runs* band : bands) {
    if (band->reason != Reason::none) out.reason = band->reason;
  }
  find_components(bands, scratch);
  int candidates = 0;
  for (int i = 0; i < scratch.component_count; ++i) {
    const std::uint32_t area = scratch.components[static_cast<std::size_t>(i)].area_px;
    if (area < settings.min_area_px || area > settings.max_area_px) continue;
    scratch.candidate[static_cast<std::size_t>(candidates++)] = static_cast<Index>(i);
  }
  out.dropped = static_cast<std::uint32_t>(scratch.component_count - candidates);
  if (candidates > k_blobs_max) {
    out.dropped += static_cast<std::uint32_t>(candidates - k_blobs_max);
    out.reason = Reason::blobs_full;
    keep_best(predicted_px, scratch, candidates);
  }
  for (int i = 0; i < candidates; ++i) {
    const Index index = scratch.candidate[static_cast<std::size_t>(i)];
    out.items[static_cast<std::size_t>(out.count++)] =
        blob_of(frame, scratch, scratch.components[index], settings);
  }
  std::sort(out.items.begin(), out.items.begin() + out.count, before);
}

}  // namespace glint

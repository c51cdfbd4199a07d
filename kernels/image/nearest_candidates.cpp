#include "kernels/image/nearest_candidates.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "kernels/image/marker_misfit.hpp"
#include "kernels/image/pair_products.hpp"

namespace glint {
namespace {

// In half pixels. A centre is inside the frame. Predictions are clamped to a quarter of the frame
// outside it: further out their order does not matter.
constexpr int k_frame = 2 * std::max(k_width_max, k_height_max);
constexpr int k_coordinate_min = -k_frame / 4, k_coordinate_max = k_frame + k_frame / 4;
static_assert(k_coordinate_max <= INT16_MAX && 2 * k_coordinate_max * k_coordinate_max < 1 << 24);
constexpr std::int32_t k_distance_max = (1 << 23) - 1;  // upper limit of a squared distance
constexpr int k_distances_per_round = 16;               // distances compared in one round
// Each step of misfit doubles a distance; these are squared.
constexpr int k_bits_a_misfit = 2;
constexpr std::int32_t k_padding_distance = INT32_MAX;
static_assert((std::int64_t{k_distance_max} << k_bits_a_misfit * k_misfit_max) + 1 <
              k_padding_distance);
constexpr std::uint8_t k_already_kept = 0x80;  // value of a misfit: already kept

// Minimum of k_distance_max and numbers below 2^24, by lanes. Added to the bits of the float 2^23
// they are floats in the same order, for which every x86-64 has a minimum instruction.
class LaneMinimum {
 public:
  void update(Sums other) {
#ifdef GLINT_SSE2
    minimum_ = _mm_min_ps(minimum_, reinterpret_cast<__m128>(other + k_exponent));
#else
    minimum_ = other < minimum_ ? other : minimum_;
#endif
  }
#ifdef GLINT_SSE2
  [[nodiscard]] Sums value() const { return reinterpret_cast<Sums>(minimum_) - k_exponent; }

 private:
  static constexpr Sums k_exponent = Sums{} + 0x4B000000;  // of 2^23
  __m128 minimum_ = reinterpret_cast<__m128>((Sums{} + k_distance_max) + k_exponent);
#else
  [[nodiscard]] Sums value() const { return minimum_; }

 private:
  Sums minimum_ = Sums{} + k_distance_max;
#endif
};

// Points in half pixels, as pairs (x, y) repeated over all lanes.
struct Points {
  std::array<Words, k_predictions_max> at;
  int count = 0;
};

constexpr std::int32_t pair_of(int x, int y) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(x & 0xFFFF) |
                                   static_cast<std::uint32_t>(y & 0xFFFF) << 16);
}

Points in_half_pixels(std::span<const Vector2> predicted_px) {
  Points out;
  for (const Vector2& pixel : predicted_px) {
    if (out.count == k_predictions_max) break;
    if (!(pixel.squaredNorm() < 1e12)) continue;
    const int x = std::clamp(static_cast<int>(2 * pixel.x()), k_coordinate_min, k_coordinate_max);
    const int y = std::clamp(static_cast<int>(2 * pixel.y()), k_coordinate_min, k_coordinate_max);
    out.at[static_cast<std::size_t>(out.count++)] = reinterpret_cast<Words>(Sums{} + pair_of(x, y));
  }
  return out;
}

std::int32_t middle_of(const Component& component) {
  return pair_of(component.x0 + component.x1, component.y0 + component.y1);
}

// Squared distances, in half pixels, of four centres to their nearest points.
Sums nearest(Words middles, const Points& points) {
  LaneMinimum minimum;
  for (int i = 0; i < points.count; ++i) {
    const Words apart = middles - points.at[static_cast<std::size_t>(i)];
    minimum.update(pair_products(apart, apart));
  }
  return minimum.value();
}

struct Cut {
  std::int32_t distance = 0;  // all candidates below it stay,
  int equal = 0;              // and this many of those at it
};

// The order statistic `budget` of the distances, by bisection bit by bit. The padding up to
// k_distances_per_round has the largest distance.
Cut find_cut(const BlobScratch& scratch, int candidates, int budget) {
  const int padded =
      (candidates + k_distances_per_round - 1) / k_distances_per_round * k_distances_per_round;
  const auto at = [&](int i) {
    Sums four;
    std::memcpy(&four, &scratch.distance[static_cast<std::size_t>(i)], sizeof four);
    return four;
  };
  Cut cut{0, budget};
  for (std::int32_t bit = k_padding_distance / 2 + 1; bit > 0; bit /= 2) {
    const Sums last_below = Sums{} + (cut.distance + (bit - 1));
    Sums even{}, odd{};  // negative counts of the distances not below
    for (int i = 0; i < padded; i += k_distances_per_round) {
      even += at(i) > last_below;
      odd += at(i + 4) > last_below;
      even += at(i + 8) > last_below;
      odd += at(i + 12) > last_below;
    }
    const int below = padded + static_cast<int>(sum_of(even + odd));
    if (below < budget) {
      cut.distance += bit;
      cut.equal = budget - below;
    }
  }
  return cut;
}

// Computes the distance of each candidate's centre to the nearest point, multiplied by its misfit;
// 0 for a candidate already kept, and k_padding_distance in the padding.
void measure_distances(const Points& points, BlobScratch& scratch, int candidates) {
  for (int i = 0; i < candidates; i += 4) {
    const auto middle = [&](int lane) {
      const auto at = static_cast<std::size_t>(std::min(i + lane, candidates - 1));
      return middle_of(scratch.components[scratch.candidate[at]]);
    };
    const Sums middles = {middle(0), middle(1), middle(2), middle(3)};
    const Sums distances = nearest(reinterpret_cast<Words>(middles), points);
    std::memcpy(&scratch.distance[static_cast<std::size_t>(i)], &distances, sizeof distances);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(candidates); ++i) {
    const std::uint8_t misfit = scratch.misfit[i];
    const std::int32_t grown = (scratch.distance[i] << k_bits_a_misfit * (misfit & 7)) + 1;
    scratch.distance[i] = misfit == k_already_kept ? 0 : grown;
  }
  static_assert(k_runs_max % k_distances_per_round == 0);
  for (int i = candidates; i % k_distances_per_round != 0; ++i) {
    scratch.distance[static_cast<std::size_t>(i)] = k_padding_distance;
  }
}

// Calls visit(index, true if it is one of the `budget` nearest) for each candidate.
template <class Visit>
void for_each_selected(const BlobScratch& scratch, int candidates, int budget, Visit visit) {
  Cut cut = find_cut(scratch, candidates, budget);
  for (std::size_t i = 0; i < static_cast<std::size_t>(candidates); ++i) {
    const std::int32_t distance = scratch.distance[i];
    const bool tie_kept = distance == cut.distance && cut.equal > 0;
    cut.equal -= tie_kept ? 1 : 0;
    visit(i, distance < cut.distance || tie_kept);
  }
}

// Centre of the focus candidate of this turn.
Points focus_of(const BlobScratch& scratch, int candidates, std::uint32_t turn) {
  constexpr std::uint32_t golden = 0x9E3779B9;  // 2^32 / phi
  const std::uint64_t part = static_cast<std::uint32_t>(turn * golden);
  const auto at = static_cast<std::size_t>(part * static_cast<std::uint64_t>(candidates) >> 32);
  const std::int32_t middle = middle_of(scratch.components[scratch.candidate[at]]);
  Points focus;
  focus.at[0] = reinterpret_cast<Words>(Sums{} + middle);
  focus.count = 1;
  return focus;
}

}  // namespace

int select_nearest(const BlobSearch& search, BlobScratch& scratch, int candidates,
                   int budget) noexcept {
  const int fours = (candidates + 3) / 4;
  const Points predictions = in_half_pixels(search.predicted_px);
  const int near = budget_near_predictions(search, predictions.count, budget);
  if (near > 0) measure_distances(predictions, scratch, candidates);
  if (near > 0 && near < budget) {
    for_each_selected(scratch, candidates, near, [&](std::size_t i, bool stays) {
      if (stays) scratch.misfit[i] = k_already_kept;
    });
  }
  if (near < budget)
    measure_distances(focus_of(scratch, candidates, search.turn), scratch, candidates);
  std::size_t out = 0;
  for_each_selected(scratch, candidates, budget, [&](std::size_t i, bool stays) {
    scratch.candidate[out] = scratch.candidate[i];
    out += stays ? 1 : 0;
  });
  return fours * (predictions.count + (near < budget ? 1 : 0));
}

}  // namespace glint

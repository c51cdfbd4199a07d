#include "kernels/image/nearest_kept.hpp"

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
constexpr int k_nearest = -k_frame / 4, k_farthest = k_frame + k_frame / 4;
static_assert(k_farthest <= INT16_MAX && 2 * k_farthest * k_farthest < 1 << 24);
constexpr std::int32_t k_far = (1 << 23) - 1;  // upper limit of a squared distance
constexpr int k_at_once = 16;                  // distances compared in one round
// Each step of misfit doubles a distance; these are squared.
constexpr int k_bits_a_misfit = 2;
constexpr std::int32_t k_last = INT32_MAX;
static_assert((std::int64_t{k_far} << k_bits_a_misfit * k_misfit_max) + 1 < k_last);
constexpr std::uint8_t k_stays = 0x80;  // value of a misfit: already kept

// Minimum of k_far and numbers below 2^24, by lanes. Added to the bits of the float 2^23 they are
// floats in the same order, for which every x86-64 has a minimum instruction.
class Least {
 public:
  void see(Sums other) {
#ifdef GLINT_SSE2
    least_ = _mm_min_ps(least_, reinterpret_cast<__m128>(other + k_exponent));
#else
    least_ = other < least_ ? other : least_;
#endif
  }
#ifdef GLINT_SSE2
  [[nodiscard]] Sums value() const { return reinterpret_cast<Sums>(least_) - k_exponent; }

 private:
  static constexpr Sums k_exponent = Sums{} + 0x4B000000;  // of 2^23
  __m128 least_ = reinterpret_cast<__m128>((Sums{} + k_far) + k_exponent);
#else
  [[nodiscard]] Sums value() const { return least_; }

 private:
  Sums least_ = Sums{} + k_far;
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
    const int x = std::clamp(static_cast<int>(2 * pixel.x()), k_nearest, k_farthest);
    const int y = std::clamp(static_cast<int>(2 * pixel.y()), k_nearest, k_farthest);
    out.at[static_cast<std::size_t>(out.count++)] = reinterpret_cast<Words>(Sums{} + pair_of(x, y));
  }
  return out;
}

std::int32_t middle_of(const Component& component) {
  return pair_of(component.x0 + component.x1, component.y0 + component.y1);
}

// Squared distances, in half pixels, of four centres to their nearest points.
Sums nearest(Words middles, const Points& points) {
  Least least;
  for (int i = 0; i < points.count; ++i) {
    const Words apart = middles - points.at[static_cast<std::size_t>(i)];
    least.see(pair_products(apart, apart));
  }
  return least.value();
}

struct Cut {
  std::int32_t distance = 0;  // all candidates below it stay,
  int equal = 0;              // and this many of those at it
};

// The order statistic `kept` of the distances, by bisection bit by bit. The padding up to k_at_once
// has the largest distance.
Cut find_cut(const BlobScratch& scratch, int candidates, int kept) {
  const int padded = (candidates + k_at_once - 1) / k_at_once * k_at_once;
  const auto at = [&](int i) {
    Sums four;
    std::memcpy(&four, &scratch.distance[static_cast<std::size_t>(i)], sizeof four);
    return four;
  };
  Cut cut{0, kept};
  for (std::int32_t bit = k_last / 2 + 1; bit > 0; bit /= 2) {
    const Sums last_below = Sums{} + (cut.distance + (bit - 1));
    Sums even{}, odd{};  // negative counts of the distances not below
    for (int i = 0; i < padded; i += k_at_once) {
      even += at(i) > last_below;
      odd += at(i + 4) > last_below;
      even += at(i + 8) > last_below;
      odd += at(i + 12) > last_below;
    }
    const int below = padded + static_cast<int>(sum_of(even + odd));
    if (below < kept) {
      cut.distance += bit;
      cut.equal = kept - below;
    }
  }
  return cut;
}

// Computes the distance of each candidate's centre to the nearest point, multiplied by its misfit;
// 0 for a candidate already kept, and k_last in the padding.
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
    scratch.distance[i] = misfit == k_stays ? 0 : grown;
  }
  static_assert(k_runs_max % k_at_once == 0);
  for (int i = candidates; i % k_at_once != 0; ++i) {
    scratch.distance[static_cast<std::size_t>(i)] = k_last;
  }
}

// Calls visit(index, true if it is one of the `kept` nearest) for each candidate.
template <class Visit>
void for_each_judged(const BlobScratch& scratch, int candidates, int kept, Visit visit) {
  Cut cut = find_cut(scratch, candidates, kept);
  for (std::size_t i = 0; i < static_cast<std::size_t>(candidates); ++i) {
    const std::int32_t distance = scratch.distance[i];
    const bool last_place = distance == cut.distance && cut.equal > 0;
    cut.equal -= last_place ? 1 : 0;
    visit(i, distance < cut.distance || last_place);
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

int keep_nearest(const BlobSearch& search, BlobScratch& scratch, int candidates,
                 int kept) noexcept {
  const int fours = (candidates + 3) / 4;
  const Points predictions = in_half_pixels(search.predicted_px);
  const int near = kept_near_predictions(search, predictions.count, kept);
  if (near > 0) measure_distances(predictions, scratch, candidates);
  if (near > 0 && near < kept) {
    for_each_judged(scratch, candidates, near, [&](std::size_t i, bool stays) {
      if (stays) scratch.misfit[i] = k_stays;
    });
  }
  if (near < kept)
    measure_distances(focus_of(scratch, candidates, search.turn), scratch, candidates);
  std::size_t out = 0;
  for_each_judged(scratch, candidates, kept, [&](std::size_t i, bool stays) {
    scratch.candidate[out] = scratch.candidate[i];
    out += stays ? 1 : 0;
  });
  return fours * (predictions.count + (near < kept ? 1 : 0));
}

}  // namespace glint

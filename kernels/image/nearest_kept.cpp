#include "kernels/image/nearest_kept.hpp"

#include <algorithm>
#include <array>

namespace glint {
namespace {

using Lanes = float __attribute__((vector_size(16)));

// The predictions in half pixels, four at a time, the last one repeated. As small whole numbers
// they stay exact in float, which every vector unit multiplies; far outside the frame the order
// among them is of no interest.
struct Predictions {
  std::array<Lanes, k_predictions_max / 4> x, y;
  int fours = 0;
};

Predictions in_half_pixels(std::span<const Vector2> predicted_px) {
  Predictions out;
  int count = 0;
  const auto put = [&](int at, float x, float y) {
    out.x[static_cast<std::size_t>(at / 4)][at % 4] = x;
    out.y[static_cast<std::size_t>(at / 4)][at % 4] = y;
  };
  float x = 0, y = 0;
  for (const Vector2& pixel : predicted_px) {
    if (count == k_predictions_max) break;
    if (!(pixel.squaredNorm() < 1e12)) continue;
    x = static_cast<float>(std::clamp(static_cast<int>(2 * pixel.x()), -512, 1536));
    y = static_cast<float>(std::clamp(static_cast<int>(2 * pixel.y()), -512, 1536));
    put(count++, x, y);
  }
  for (; count % 4 != 0; ++count) put(count, x, y);
  out.fours = count / 4;
  return out;
}

// Squared, in half pixels, from the middle of the component's box.
std::uint32_t nearest(const Component& component, const Predictions& predictions) {
  const Lanes x = Lanes{} + static_cast<float>(component.x0 + component.x1);
  const Lanes y = Lanes{} + static_cast<float>(component.y0 + component.y1);
  Lanes least = Lanes{} + 1e9f;
  for (int i = 0; i < predictions.fours; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Lanes dx = x - predictions.x[at], dy = y - predictions.y[at];
    const Lanes square = dx * dx + dy * dy;
    least = square < least ? square : least;
  }
  return static_cast<std::uint32_t>(std::min({least[0], least[1], least[2], least[3]}));
}

constexpr int k_digit_bits = 8;
constexpr int k_digits = 3;
constexpr std::uint32_t k_digit_values = 1u << k_digit_bits;

struct Cut {
  std::uint32_t distance = 0;  // all below it stay,
  int equal = 0;               // and so many of those that have it
};

// The distance of place `kept` in the order.
Cut find_cut(const BlobScratch& scratch, int candidates, int kept) {
  Cut cut{0, kept};
  for (int digit = k_digits - 1; digit >= 0; --digit) {
    const int shift = digit * k_digit_bits;
    std::array<std::uint16_t, k_digit_values + 1> histogram{};  // the last: other upper digits
    for (int i = 0; i < candidates; ++i) {
      const std::uint32_t upper = scratch.distance[static_cast<std::size_t>(i)] >> shift;
      const bool same = upper >> k_digit_bits == cut.distance;
      ++histogram[same ? upper & (k_digit_values - 1) : k_digit_values];
    }
    std::uint32_t value = 0;
    for (; value + 1 < k_digit_values && histogram[value] < cut.equal; ++value) {
      cut.equal -= histogram[value];
    }
    cut.distance = cut.distance << k_digit_bits | value;
  }
  return cut;
}

}  // namespace

int keep_nearest(std::span<const Vector2> predicted_px, BlobScratch& scratch, int candidates,
                 int kept) noexcept {
  const Predictions predictions = in_half_pixels(predicted_px);
  if (predictions.fours == 0) return 0;  // the first ones stand where they should
  for (int i = 0; i < candidates; ++i) {
    const auto at = static_cast<std::size_t>(i);
    scratch.distance[at] = nearest(scratch.components[scratch.candidate[at]], predictions);
  }
  Cut cut = find_cut(scratch, candidates, kept);
  std::size_t out = 0;
  for (int i = 0; i < candidates; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::uint32_t distance = scratch.distance[at];
    const bool last_place = distance == cut.distance && cut.equal > 0;
    scratch.candidate[out] = scratch.candidate[at];
    cut.equal -= last_place ? 1 : 0;
    out += distance < cut.distance || last_place ? 1 : 0;
  }
  return candidates * predictions.fours;
}

}  // namespace glint

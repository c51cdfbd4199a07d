#include "kernels/pose/pair_matches.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr float k_too_far_m2 = 1e6F;

struct ToolPair {
  float distance_m = 0;
  int row = 0;  // of the first candidate as marker i, at the set for marker j
};

// The tool's distances in order of their bins.
struct ToolPairs {
  std::array<ToolPair, k_tool_pairs_max> pair;
  std::array<std::uint8_t, k_distance_bins + 2> before{};  // pairs in lower bins
  float bins_a_metre = 0;
};

// A distance's bin; what is longer than all of the tool's gets the one after the last.
std::int32_t bin_of(float distance_m, float bins_a_metre) {
  const float bin = distance_m * bins_a_metre;
  const float low = bin > 0 ? bin : 0.0F;
  return static_cast<std::int32_t>(low < 1.0F * k_distance_bins ? low : 1.0F * k_distance_bins);
}

float distance_of(const Tool& tool, int i, int j) {
  return static_cast<float>(tool.distance_m[i][j]);
}

ToolPairs pairs_of(const Tool& tool, const PairMatches& matches) {
  ToolPairs pairs;
  float longest = 0;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      longest = std::max(longest, distance_of(tool, i, j));
    }
  }
  // The longest itself stays inside the last bin.
  pairs.bins_a_metre = k_distance_bins / longest * (1 - 1e-6F);
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      ++pairs.before[bin_of(distance_of(tool, i, j), pairs.bins_a_metre) + 1];
    }
  }
  for (int bin = 0; bin <= k_distance_bins; ++bin) {
    pairs.before[bin + 1] = static_cast<std::uint8_t>(pairs.before[bin + 1] + pairs.before[bin]);
  }
  std::array<std::uint8_t, k_distance_bins + 2> next = pairs.before;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      const float distance = distance_of(tool, i, j);
      pairs.pair[next[bin_of(distance, pairs.bins_a_metre)]++] = {distance,
                                                                  matches.set_of(i, 0, j)};
    }
  }
  return pairs;
}

// Coordinates side by side, so that one pass handles several candidates at a time; single precision
// holds them to 0.1 um, and a gate is a millimetre at least.
struct Columns {
  std::array<float, k_blobs_max> x, y, z, ray_x, ray_y, ray_z, variance;
};

Columns columns_of(const Candidates& candidates) {
  Columns columns;
  for (int a = 0; a < candidates.count; ++a) {
    columns.x[a] = static_cast<float>(candidates.point_m[a].x());
    columns.y[a] = static_cast<float>(candidates.point_m[a].y());
    columns.z[a] = static_cast<float>(candidates.point_m[a].z());
    columns.ray_x[a] = static_cast<float>(candidates.ray[a].x());
    columns.ray_y[a] = static_cast<float>(candidates.ray[a].y());
    columns.ray_z[a] = static_cast<float>(candidates.ray[a].z());
    columns.variance[a] = static_cast<float>(candidates.across_variance_m2[a]);
  }
  return columns;
}

// Of one candidate with each one before it.
struct Gates {
  std::array<float, k_blobs_max> distance_m, delta_m;
  std::array<std::int32_t, k_blobs_max> bin_low, bin_high;  // of the tool's distances within
};

// Candidate a's distance to each one before it, and how far the true one may be from that.
void gates_of(const Columns& __restrict c, int a, float bins_a_metre,
              const CorrespondSettings& settings, Gates& __restrict gates) {
  const auto sigma = static_cast<float>(settings.range_sigma_m);
  const float range_variance = sigma * sigma;
  const auto k = static_cast<float>(settings.gate_sigmas);
  const auto least = static_cast<float>(settings.delta_min_m);
  const float x = c.x[a], y = c.y[a], z = c.z[a];
  const float ray_x = c.ray_x[a], ray_y = c.ray_y[a], ray_z = c.ray_z[a];
  const float variance = c.variance[a];
  for (int b = 0; b < a; ++b) {
    const float dx = x - c.x[b], dy = y - c.y[b], dz = z - c.z[b];
    const float square = dx * dx + dy * dy + dz * dz;
    // Two blobs in one place have no direction, and no distance that a tool has.
    const float apart = square > 0 ? square : k_too_far_m2;
    const float inverse = 1.0F / apart;
    const float distance = std::sqrt(apart);
    const float along_a = dx * ray_x + dy * ray_y + dz * ray_z;
    const float along_b = dx * c.ray_x[b] + dy * c.ray_y[b] + dz * c.ray_z[b];
    const float both = variance + c.variance[b];
    const float along = both + ((range_variance - variance) * (along_a * along_a) +
                                (range_variance - c.variance[b]) * (along_b * along_b)) *
                                   inverse;
    const float across = 2 * (range_variance + both) - along;
    const float delta = k * std::sqrt(along) + k * k * 0.5F * across * (distance * inverse);
    const float gate = delta > least ? delta : least;
    gates.distance_m[b] = distance;
    gates.delta_m[b] = gate;
    gates.bin_low[b] = bin_of(distance - gate, bins_a_metre);
    gates.bin_high[b] = bin_of(distance + gate, bins_a_metre);
  }
}

}  // namespace

PairWork match_pairs(const Candidates& candidates, const Tool& tool,
                     const CorrespondSettings& settings, PairMatches& matches) noexcept {
  PairWork work;
  matches.candidates = candidates.count;
  matches.markers = tool.marker_count;
  matches.words = candidates.words;
  work.words_cleared = tool.marker_count * candidates.count * matches.words_a_row();
  std::fill_n(matches.word.begin(), work.words_cleared, std::uint64_t{0});
  const ToolPairs pairs = pairs_of(tool, matches);
  const Columns columns = columns_of(candidates);
  const int row_words = matches.words_a_row();
  Gates gates;
  for (int a = 1; a < candidates.count; ++a) {
    gates_of(columns, a, pairs.bins_a_metre, settings, gates);
    work.pairs += a;
    std::uint64_t* const rows_of_a = &matches.word[a * row_words];
    for (int b = 0; b < a; ++b) {
      const int first = pairs.before[gates.bin_low[b]];
      const int last = pairs.before[gates.bin_high[b] + 1];
      if (first >= last) continue;
      const float distance = gates.distance_m[b];
      const float delta = gates.delta_m[b];
      const int left = settings.pair_tests_max - work.tests;
      if (last - first > left) work.full = true;
      const int end = std::min(last, first + left);
      work.tests += end - first;
      std::uint64_t* const with_b = rows_of_a + b / 64;
      std::uint64_t* const with_a = &matches.word[b * row_words + a / 64];
      for (int p = first; p < end; ++p) {
        const ToolPair& pair = pairs.pair[p];
        const std::uint64_t fits = std::abs(distance - pair.distance_m) < delta ? 1 : 0;
        with_b[pair.row] |= fits << (b % 64);
        with_a[pair.row] |= fits << (a % 64);
      }
    }
  }
  return work;
}

}  // namespace glint

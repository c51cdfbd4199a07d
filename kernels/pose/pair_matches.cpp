#include "kernels/pose/pair_matches.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

struct ToolPair {
  double distance_m = 0;
  int i = 0, j = 0;
};

// The tool's distances in order of their bins.
struct ToolPairs {
  std::array<ToolPair, k_tool_pairs_max> pair;
  std::array<std::uint8_t, k_distance_bins + 2> before{};  // pairs in lower bins
  double bins_a_metre = 0;
};

// A distance's bin; what is longer than all of the tool's gets the one after the last.
int bin_of(double distance_m, double bins_a_metre) {
  return static_cast<int>(std::clamp(distance_m * bins_a_metre, 0.0, 1.0 * k_distance_bins));
}

ToolPairs pairs_of(const Tool& tool) {
  ToolPairs pairs;
  double longest = 0;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      longest = std::max(longest, tool.distance_m[i][j]);
    }
  }
  // The longest itself stays inside the last bin.
  pairs.bins_a_metre = k_distance_bins / longest * (1 - 1e-9);
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      ++pairs.before[bin_of(tool.distance_m[i][j], pairs.bins_a_metre) + 1];
    }
  }
  for (int bin = 0; bin <= k_distance_bins; ++bin) {
    pairs.before[bin + 1] = static_cast<std::uint8_t>(pairs.before[bin + 1] + pairs.before[bin]);
  }
  std::array<std::uint8_t, k_distance_bins + 2> next = pairs.before;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      const double distance = tool.distance_m[i][j];
      pairs.pair[next[bin_of(distance, pairs.bins_a_metre)]++] = {distance, i, j};
    }
  }
  return pairs;
}

// Coordinates side by side, so that one pass handles several candidates at a time.
struct Columns {
  std::array<double, k_blobs_max> x, y, z, ray_x, ray_y, ray_z, variance;
};

Columns columns_of(const Candidates& candidates) {
  Columns columns;
  for (int a = 0; a < candidates.count; ++a) {
    columns.x[a] = candidates.point_m[a].x();
    columns.y[a] = candidates.point_m[a].y();
    columns.z[a] = candidates.point_m[a].z();
    columns.ray_x[a] = candidates.ray[a].x();
    columns.ray_y[a] = candidates.ray[a].y();
    columns.ray_z[a] = candidates.ray[a].z();
    columns.variance[a] = candidates.across_variance_m2[a];
  }
  return columns;
}

struct Gates {
  std::array<double, k_blobs_max> distance_m, delta_m;
};

// Candidate a's distance to each one before it, and how far the true one may be from that.
void gates_of(const Columns& c, int a, const CorrespondSettings& settings, Gates& gates) {
  const double range_variance = settings.range_sigma_m * settings.range_sigma_m;
  const double k = settings.gate_sigmas;
  const double least = settings.delta_min_m;
  const double x = c.x[a], y = c.y[a], z = c.z[a];
  const double ray_x = c.ray_x[a], ray_y = c.ray_y[a], ray_z = c.ray_z[a];
  const double variance = c.variance[a];
  for (int b = 0; b < a; ++b) {
    const double dx = x - c.x[b], dy = y - c.y[b], dz = z - c.z[b];
    const double square = dx * dx + dy * dy + dz * dz;
    const double inverse = 1.0 / square;
    const double distance = std::sqrt(square);
    const double along_a = dx * ray_x + dy * ray_y + dz * ray_z;
    const double along_b = dx * c.ray_x[b] + dy * c.ray_y[b] + dz * c.ray_z[b];
    const double both = variance + c.variance[b];
    const double along = both + ((range_variance - variance) * (along_a * along_a) +
                                 (range_variance - c.variance[b]) * (along_b * along_b)) *
                                    inverse;
    const double across = 2 * (range_variance + both) - along;
    const double delta = k * std::sqrt(along) + k * k * 0.5 * across * (distance * inverse);
    gates.distance_m[b] = distance;
    gates.delta_m[b] = delta > least ? delta : least;
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
  const ToolPairs pairs = pairs_of(tool);
  const Columns columns = columns_of(candidates);
  Gates gates;
  for (int a = 1; a < candidates.count; ++a) {
    gates_of(columns, a, settings, gates);
    work.pairs += a;
    for (int b = 0; b < a; ++b) {
      const double distance = gates.distance_m[b];
      const double delta = gates.delta_m[b];
      // Two blobs in one place have no direction: their gate is not a number, and holds nothing.
      if (!(distance > 0)) continue;
      const int first = pairs.before[bin_of(distance - delta, pairs.bins_a_metre)];
      const int last = pairs.before[bin_of(distance + delta, pairs.bins_a_metre) + 1];
      const int left = settings.pair_tests_max - work.tests;
      if (last - first > left) work.full = true;
      const int end = std::min(last, first + left);
      work.tests += end - first;
      for (int p = first; p < end; ++p) {
        const ToolPair& pair = pairs.pair[p];
        const std::uint64_t fits = std::abs(distance - pair.distance_m) < delta ? 1 : 0;
        const int at = pair.j * candidates.words;
        matches.row(pair.i, a)[at + b / 64] |= fits << (b % 64);
        matches.row(pair.i, b)[at + a / 64] |= fits << (a % 64);
      }
    }
  }
  return work;
}

}  // namespace glint

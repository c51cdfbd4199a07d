#include "kernels/pose/pair_matches.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/near_distances.hpp"

namespace glint {
namespace {

constexpr float k_too_far_m = 1e3F;
constexpr float k_too_far_m2 = k_too_far_m * k_too_far_m;

static_assert(k_blobs_max % k_lanes == 0);

// Rounds up to whole lanes.
int round_up_to_lanes(int count) { return (count + k_lanes - 1) / k_lanes * k_lanes; }

// The tool's distances, each in all lanes, and the start of the rows for its two markers.
struct ToolPairs {
  std::array<FloatLanes, k_tool_pairs_max> distance_m;
  std::array<int, k_tool_pairs_max> row;  // set for j of the first candidate as marker i
  std::array<int, k_tool_pairs_max> i, j;
  int count = 0;
};

ToolPairs pairs_of(const Tool& tool, const PairMatches& matches) {
  ToolPairs pairs;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      pairs.distance_m[pairs.count] = FloatLanes{} + static_cast<float>(tool.distance_m[i][j]);
      pairs.row[pairs.count] = matches.set_of(i, 0, j);
      pairs.i[pairs.count] = i;
      pairs.j[pairs.count] = j;
      ++pairs.count;
    }
  }
  return pairs;
}

// Coordinates as a structure of arrays, so that one pass processes several candidates at a time.
// Single precision represents them to 0.1 um, and a gate is at least a millimetre.
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
  for (int a = candidates.count; a < round_up_to_lanes(candidates.count); ++a) {
    columns.x[a] = columns.y[a] = columns.z[a] = k_too_far_m;
    columns.ray_x[a] = columns.ray_y[a] = columns.ray_z[a] = 0;
    columns.variance[a] = 0;
  }
  return columns;
}

// Distances of one candidate to the others, and their gates.
struct Gates {
  std::array<float, k_blobs_max> distance_m, delta_m;
};

// Candidate a's distance to each of the first `end`, and how far the true one may be from that.
void gates_of(const Columns& __restrict c, int a, int end, const CorrespondSettings& settings,
              Gates& __restrict gates) {
  const auto sigma = static_cast<float>(settings.range_sigma_m);
  const float range_variance = sigma * sigma;
  const auto k = static_cast<float>(settings.gate_sigmas);
  const auto least = static_cast<float>(settings.delta_min_m);
  const float x = c.x[a], y = c.y[a], z = c.z[a];
  const float ray_x = c.ray_x[a], ray_y = c.ray_y[a], ray_z = c.ray_z[a];
  const float variance = c.variance[a];
  for (int b = 0; b < end; ++b) {
    const float dx = x - c.x[b], dy = y - c.y[b], dz = z - c.z[b];
    const float square = dx * dx + dy * dy + dz * dz;
    // Two candidates at one position have no direction; they get a distance that no tool has.
    const float apart = square + (square > 0 ? 0.0F : k_too_far_m2);
    const float inverse = 1.0F / apart;
    const float distance = std::sqrt(apart);
    const float along_a = dx * ray_x + dy * ray_y + dz * ray_z;
    const float along_b = dx * c.ray_x[b] + dy * c.ray_y[b] + dz * c.ray_z[b];
    const float both = variance + c.variance[b];
    const float along = both + ((range_variance - variance) * (along_a * along_a) +
                                (range_variance - c.variance[b]) * (along_b * along_b)) *
                                   inverse;
    const float across = 2 * (range_variance + both) - along;
    const float bias = 0.5F * across * (distance * inverse);
    const float delta = k * std::sqrt(along + 2 * bias * bias) + bias;
    gates.distance_m[b] = distance;
    gates.delta_m[b] = delta > least ? delta : least;
  }
}

// Matches of a block's candidates with earlier ones, for the rows of the earlier ones: bit a -
// block of [b / k_lanes][p], lane b % k_lanes, is set if a and b have the distance of the tool's
// pair p.
constexpr int k_block = 32;
using Found = std::array<std::array<BitLanes, k_tool_pairs_max>, k_blobs_max / k_lanes>;

// Compares candidate a's distances to at most 64 others with the tool's.
void compare(const Gates& gates, const ToolPairs& pairs, int begin, int end, std::uint32_t mark,
             Found& found, std::uint64_t* row) {
  std::array<std::uint64_t, k_tool_pairs_max> near_a{};
  for (int b = begin; b < end; b += k_lanes) {
    const FloatLanes distance = lanes_at(&gates.distance_m[b]);
    const FloatLanes gate = lanes_at(&gates.delta_m[b]);
    std::array<BitLanes, k_tool_pairs_max>& found_b = found[b / k_lanes];
    for (int p = 0; p < pairs.count; ++p) {
      const BitLanes lanes = near(distance, pairs.distance_m[p], gate);
      near_a[p] |= gathered(lanes) << (b - begin);
      found_b[p] |= lanes & mark;
    }
  }
  for (int p = 0; p < pairs.count; ++p) row[pairs.row[p]] = near_a[p];
}

// For each of the tool's distances, the candidates that have a partner at that distance.
using Partnered = std::array<CandidateSet, k_tool_pairs_max>;

// Adds the partners in word w of candidate a's row, and a itself if there are any.
void add_partners(const ToolPairs& pairs, const std::uint64_t* row, int a, int w,
                  Partnered& partnered) {
  for (int p = 0; p < pairs.count; ++p) {
    const std::uint64_t near_a = row[pairs.row[p]];
    partnered[p].word[w] |= near_a;
    partnered[p].word[a / 64] |= static_cast<std::uint64_t>(near_a != 0) << (a % 64);
  }
}

// Copies a block's matches into the rows of the matched candidates, all before `end`.
void copy_to_matched_rows(const ToolPairs& pairs, const Found& found, int block, int end,
                          PairMatches& matches) {
  const int row_words = matches.words_a_row();
  for (int b = 0; b < end; ++b) {
    std::uint64_t* const row = &matches.word[b * row_words + block / 64];
    for (int p = 0; p < pairs.count; ++p) {
      const std::uint64_t near_b = found[b / k_lanes][p][b % k_lanes];
      row[pairs.row[p]] |= near_b << (block % 64);
    }
  }
}

}  // namespace

PairWork match_pairs(const Candidates& candidates, const Tool& tool,
                     const CorrespondSettings& settings, PairMatches& matches) noexcept {
  matches.candidates = candidates.count;
  matches.markers = tool.marker_count;
  matches.words = candidates.words;
  const ToolPairs pairs = pairs_of(tool, matches);
  PairWork work;
  work.pairs = candidates.count * (candidates.count - 1) / 2;
  work.tests = work.pairs * pairs.count;
  work.words_written = pairs.count * candidates.count * matches.words;
  const Columns columns = columns_of(candidates);
  Gates gates;
  Found found;
  Partnered partnered{};
  for (int block = 0; block < candidates.count; block += k_block) {
    const int end = std::min(block + k_block, candidates.count);
    for (int b = 0; b < end; b += k_lanes)
      std::fill_n(found[b / k_lanes].begin(), pairs.count, BitLanes{});
    for (int a = block; a < end; ++a) {
      // Pad to whole lanes. Candidate a cannot match itself; matches of those after a are valid.
      const int others = round_up_to_lanes(a);
      gates_of(columns, a, others, settings, gates);
      for (int w = 0; w < matches.words; ++w) {
        compare(gates, pairs, 64 * w, std::min(others, 64 * (w + 1)),
                std::uint32_t{1} << (a - block), found,
                &matches.word[a * matches.words_a_row() + w]);
        add_partners(pairs, &matches.word[a * matches.words_a_row() + w], a, w, partnered);
      }
    }
    copy_to_matched_rows(pairs, found, block, end, matches);
  }
  for (int p = 0; p < pairs.count; ++p) {
    matches.partnered[pairs.i[p]][pairs.j[p]] = partnered[p];
    matches.partnered[pairs.j[p]][pairs.i[p]] = partnered[p];
  }
  return work;
}

}  // namespace glint

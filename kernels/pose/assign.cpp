#include "kernels/pose/assign.hpp"

#include <algorithm>
#include <array>
#include <bitset>

#include "kernels/pose/choose_hypothesis.hpp"

namespace glint {
namespace {

using MarkerSet = std::bitset<k_blobs_max>;

// Tests all markers without an early exit: the cost is data independent.
bool is_idle(const Labeling& labeling, const MarkerSet& taken) {
  unsigned hits = 0;
  for (const std::int16_t marker : labeling.marker) {
    const unsigned known = marker >= 0 ? 1 : 0;
    hits |= known & static_cast<unsigned>(taken[static_cast<std::size_t>(marker) % k_blobs_max]);
  }
  return hits == 0;
}

// Advances `at` to the tool's best free labeling, or to the end. Returns the number of tests.
int advance_to_free(const Labelings& labelings, const MarkerSet& taken, int& at) {
  const int count = std::min(labelings.count, k_labelings_max);
  int tests = 0;
  for (; at < count; ++at) {
    ++tests;
    if (is_idle(labelings.items[static_cast<std::size_t>(at)], taken)) break;
  }
  return tests;
}

bool is_better(const Labeling& a, const Labeling& b) {
  if (a.count != b.count) return a.count > b.count;
  return a.count * a.rms_m * a.rms_m - a.log_prior_ratio_m2 <
         b.count * b.rms_m * b.rms_m - b.log_prior_ratio_m2;
}

}  // namespace

AssignWork assign_markers(std::span<const Labelings> per_tool, std::span<int> chosen,
                          std::span<Reason> reasons) noexcept {
  AssignWork work;
  const std::size_t tools = std::min(
      {per_tool.size(), chosen.size(), reasons.size(), static_cast<std::size_t>(k_tools_max)});
  for (std::size_t t = 0; t < tools; ++t) {
    chosen[t] = -1;
    reasons[t] = per_tool[t].count > 0                ? Reason::markers_assigned_elsewhere
                 : per_tool[t].reason == Reason::none ? Reason::no_labeling
                                                      : per_tool[t].reason;
  }
  MarkerSet taken;
  std::array<int, k_tools_max> at{};  // each tool's first labeling that was free when last tested
  for (std::size_t round = 0; round < tools; ++round) {
    const Labeling* best = nullptr;
    std::size_t best_tool = 0;
    for (std::size_t t = 0; t < tools; ++t) {
      if (chosen[t] >= 0) continue;
      work.tests += advance_to_free(per_tool[t], taken, at[t]);
      if (at[t] >= std::min(per_tool[t].count, k_labelings_max)) continue;
      const Labeling& labeling = per_tool[t].items[static_cast<std::size_t>(at[t])];
      if (best == nullptr || is_better(labeling, *best)) {
        best = &labeling;
        best_tool = t;
      }
    }
    if (best == nullptr) return work;
    ++work.rounds;
    chosen[best_tool] = at[best_tool];
    reasons[best_tool] = Reason::none;
    for (const std::int16_t marker : best->marker) {
      if (marker >= 0) taken[static_cast<std::size_t>(marker) % k_blobs_max] = true;
    }
  }
  return work;
}

int alternative_of(const Labelings& labelings, int chosen, int tool, const MarkerOwners& owners,
                   const Vector3& tip_m, int& tests) noexcept {
  const int count = std::min(labelings.count, k_labelings_max);
  const Labeling& own = labelings.items[static_cast<std::size_t>(chosen)];
  int rival = -1;
  for (int k = 0; k < count; ++k) {
    const Labeling& other = labelings.items[static_cast<std::size_t>(k)];
    if (k == chosen || other.count != own.count) continue;
    if (rival >= 0 && other.log_prior_ratio_m2 == 0) continue;
    ++tests;
    bool free = true;
    for (const std::int16_t marker : other.marker) {
      if (marker < 0) continue;
      const int owner = owners[static_cast<std::size_t>(marker) % k_blobs_max];
      free = free && (owner < 0 || owner == tool);
    }
    if (!free || !are_apart(own.T_camera_tool, other.T_camera_tool, tip_m)) continue;
    rival = k;
    if (other.log_prior_ratio_m2 > 0) break;
  }
  return rival;
}

}  // namespace glint

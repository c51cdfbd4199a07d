#include "kernels/pose/assign.hpp"

#include <algorithm>
#include <bitset>

namespace glint {
namespace {

using MarkerSet = std::bitset<k_blobs_max>;

bool is_free(const Labeling& labeling, const MarkerSet& taken) {
  return std::none_of(labeling.marker.begin(), labeling.marker.end(), [&](std::int16_t marker) {
    return marker >= 0 && taken.test(static_cast<std::size_t>(marker));
  });
}

// The tool's best labeling that is still free, or -1.
int best_free(const Labelings& labelings, const MarkerSet& taken) {
  const int count = std::min(labelings.count, k_labelings_max);
  for (int i = 0; i < count; ++i) {
    if (is_free(labelings.items[static_cast<std::size_t>(i)], taken)) return i;
  }
  return -1;
}

bool is_better(const Labeling& a, const Labeling& b) {
  if (a.count != b.count) return a.count > b.count;
  return a.rms_m < b.rms_m;
}

}  // namespace

void assign_markers(std::span<const Labelings> per_tool, std::span<int> chosen,
                    std::span<Reason> reasons) noexcept {
  const std::size_t tools = std::min(
      {per_tool.size(), chosen.size(), reasons.size(), static_cast<std::size_t>(k_tools_max)});
  for (std::size_t t = 0; t < tools; ++t) {
    chosen[t] = -1;
    reasons[t] = per_tool[t].count > 0                ? Reason::taken_by_other
                 : per_tool[t].reason == Reason::none ? Reason::no_labeling
                                                      : per_tool[t].reason;
  }
  MarkerSet taken;
  for (std::size_t round = 0; round < tools; ++round) {
    const Labeling* best = nullptr;
    std::size_t best_tool = 0;
    int best_index = -1;
    for (std::size_t t = 0; t < tools; ++t) {
      if (chosen[t] >= 0) continue;
      const int i = best_free(per_tool[t], taken);
      if (i < 0) continue;
      const Labeling& labeling = per_tool[t].items[static_cast<std::size_t>(i)];
      if (best == nullptr || is_better(labeling, *best)) {
        best = &labeling;
        best_tool = t;
        best_index = i;
      }
    }
    if (best == nullptr) return;
    chosen[best_tool] = best_index;
    reasons[best_tool] = Reason::none;
    for (const std::int16_t marker : best->marker) {
      if (marker >= 0) taken.set(static_cast<std::size_t>(marker));
    }
  }
}

}  // namespace glint

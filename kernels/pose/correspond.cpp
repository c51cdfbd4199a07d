#include "kernels/pose/correspond.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"

namespace glint {
namespace {

// Searches from `count_max` to `count_min` markers; ends fewer_markers_max markers below the best
// labeling found.
void run_levels(LabelingSearch& search, const CandidateSets& allowed,
                const CorrespondSettings& settings, int count_max, int count_min,
                const Labelings& found) {
  for (int target = count_max; target >= count_min && !search.full(); --target) {
    const int best = found.count > 0 ? found.items[0].count : 0;
    if (target < best - settings.fewer_markers_max) return;
    search.run(allowed, target);
  }
}

CandidateSets all_of(const Candidates& candidates) {
  CandidateSet all{};
  for (int a = 0; a < candidates.count; ++a) all.insert(a);
  CandidateSets sets;
  sets.fill(all);
  return sets;
}

// Candidates of a labeling, each allowed as any of the tool's markers.
CandidateSets candidates_of(const Labeling& labeling, const Candidates& candidates) {
  CandidateSet named{};
  for (int a = 0; a < candidates.count; ++a) {
    const std::int16_t marker = candidates.marker[static_cast<std::size_t>(a)];
    if (std::find(labeling.marker.begin(), labeling.marker.end(), marker) != labeling.marker.end())
      named.insert(a);
  }
  CandidateSets sets;
  sets.fill(named);
  return sets;
}

bool is_within_gate(const Labeling& labeling, const Tool& tool, const Pose& prior, double gate_m) {
  for (int j = 0; j < tool.marker_count; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    if (labeling.marker[slot] < 0) continue;
    const Vector3 away =
        labeling.T_camera_tool * tool.markers_m[slot] - prior * tool.markers_m[slot];
    if (!(away.squaredNorm() <= gate_m * gate_m)) return false;
  }
  return true;
}

// Log prior ratio of the predicted position to any position in the workspace, in units of
// chi-square: twice the logarithm of the two densities' ratio, at least 1. Tools that claim the
// same markers share the workspace, so its size only has to be larger than any prediction's sigma.
double log_prior_ratio(const Labeling& labeling, const Tool& tool,
                       const CorrespondSettings& settings, const Pose& prior) {
  constexpr double k_workplace_m = 1;
  const double sigma = std::max(settings.prior_sigma_m, settings.range_sigma_m);
  const Vector3 middle = tool.middle_m();
  const Vector3 away = labeling.T_camera_tool * middle - prior * middle;
  return std::max(1.0, 6 * logarithm(k_workplace_m / sigma) - away.squaredNorm() / (sigma * sigma));
}

// Rule 3 of the header.
void prefer_predicted(Labelings& found, const Tool& tool, const CorrespondSettings& settings,
                      const Pose& prior) {
  if (found.count == 0) return;
  const double noise_m2 = settings.range_sigma_m * settings.range_sigma_m;
  for (int k = 0; k < found.count; ++k) {
    Labeling& labeling = found.items[static_cast<std::size_t>(k)];
    if (is_within_gate(labeling, tool, prior, settings.prior_gate_m))
      labeling.log_prior_ratio_m2 = noise_m2 * log_prior_ratio(labeling, tool, settings, prior);
  }
  const Labeling best = found.items[0];
  const double slack = 9 * noise_m2 / best.count;
  for (int k = 0; k < found.count; ++k) {
    const Labeling candidate = found.items[static_cast<std::size_t>(k)];
    if (candidate.count != best.count) return;
    if (!(candidate.rms_m * candidate.rms_m - best.rms_m * best.rms_m <= slack)) return;
    if (candidate.log_prior_ratio_m2 == 0) continue;
    for (int m = k; m > 0; --m) {
      found.items[static_cast<std::size_t>(m)] = found.items[static_cast<std::size_t>(m - 1)];
    }
    found.items[0] = candidate;
    return;
  }
}

}  // namespace

CorrespondWork propose_labelings(const Markers& markers, const Tool& tool,
                                 const CorrespondSettings& settings,
                                 const Pose* prior_T_camera_tool, CorrespondScratch& scratch,
                                 Labelings& labelings) noexcept {
  CorrespondWork work;
  labelings.count = 0;
  labelings.hypotheses = 0;
  labelings.reason = Reason::none;
  if (tool.marker_count < 3 || tool.marker_count > k_markers_per_tool_max ||
      !(tool.distance_m[0][1] > 0)) {
    labelings.reason = Reason::not_prepared;
    return work;
  }
  Candidates& candidates = scratch.candidates;
  work.markers = select_candidates(markers, tool, settings, prior_T_camera_tool, candidates);
  const bool predicted = prior_T_camera_tool != nullptr;
  const int most = std::min(tool.marker_count, candidates.count);
  const int least_alone =
      std::clamp(settings.min_markers_without_prior, 3, std::max(3, tool.marker_count));
  const int least_predicted = std::clamp(settings.min_markers_with_prior, 3, tool.marker_count);
  if (most < (predicted ? std::min(least_alone, least_predicted) : least_alone)) {
    labelings.reason = Reason::too_few_markers;
    return work;
  }
  work.pairs = match_pairs(candidates, tool, settings, scratch.matches);
  LabelingSearch search(tool, settings, candidates, scratch.matches, labelings);
  if (predicted) {
    run_levels(search, candidates.in_prior_gate, settings, most, least_alone, labelings);
    run_levels(search, candidates.in_partial_gate, settings, std::min(most, least_alone - 1),
               least_predicted, labelings);
  }
  if (!predicted || !settings.only_near) {
    run_levels(search, all_of(candidates), settings, most, least_alone, labelings);
  }
  if (predicted && labelings.count > 0) {
    search.run(candidates_of(labelings.items[0], candidates), labelings.items[0].count);
  }
  if (predicted) prefer_predicted(labelings, tool, settings, *prior_T_camera_tool);
  if (search.full()) {
    labelings.reason = Reason::search_full;
  } else if (labelings.count == 0) {
    labelings.reason = search.rejected_a_fit() ? Reason::bad_fit : Reason::no_labeling;
  }
  work.search = search.work();
  return work;
}

}  // namespace glint

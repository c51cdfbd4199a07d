#include "kernels/pose/correspond.hpp"

#include <algorithm>
#include <bit>

#include "kernels/pose/candidates.hpp"
#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

// What each of the tool's markers may still be.
using Allowed = std::array<CandidateSet, k_markers_per_tool_max>;

bool stands_before(const Labeling& a, const Labeling& b) {
  if (a.count != b.count) return a.count > b.count;
  if (a.rms_m != b.rms_m) return a.rms_m < b.rms_m;
  return a.marker < b.marker;
}

class Search {
 public:
  Search(const Tool& tool, const CorrespondSettings& settings, const Candidates& candidates,
         const PairMatches& matches, Labelings& found)
      : tool_(tool),
        settings_(settings),
        candidates_(candidates),
        matches_(matches),
        found_(found) {
    chosen_.fill(-1);
  }

  // Tries all labelings with `target` markers within `allowed`.
  void run(const Allowed& allowed, int target) { grow(allowed, 0, 0, target); }

  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] bool rejected_a_fit() const { return rejected_a_fit_; }

 private:
  [[nodiscard]] bool is_empty(const CandidateSet& set) const {
    std::uint64_t any = 0;
    for (int w = 0; w < candidates_.words; ++w) any |= set.word[static_cast<std::size_t>(w)];
    return any == 0;
  }

  [[nodiscard]] int still_possible(const Allowed& allowed, int from) const {
    int possible = 0;
    for (int j = from; j < tool_.marker_count; ++j) {
      if (!is_empty(allowed[static_cast<std::size_t>(j)])) ++possible;
    }
    return possible;
  }

  // Depth is the tool's marker count at most; each call names tool marker i or leaves it out.
  void grow(const Allowed& allowed, int i, int named, int target) {
    if (named == target) {
      judge(target);
      return;
    }
    if (named + still_possible(allowed, i) < target) return;
    const auto slot = static_cast<std::size_t>(i);
    for (int w = 0; w < candidates_.words; ++w) {
      std::uint64_t rest = allowed[slot].word[static_cast<std::size_t>(w)];
      while (rest != 0) {
        const int a = w * 64 + std::countr_zero(rest);
        rest &= rest - 1;
        if (found_.hypotheses >= static_cast<std::uint32_t>(settings_.hypotheses_max)) full_ = true;
        if (full_) return;
        ++found_.hypotheses;
        chosen_[slot] = static_cast<std::int16_t>(a);
        grow(narrowed(allowed, i, a), i + 1, named + 1, target);
        chosen_[slot] = -1;
      }
    }
    grow(allowed, i + 1, named, target);
  }

  [[nodiscard]] Allowed narrowed(const Allowed& allowed, int i, int a) const {
    Allowed next;
    for (int j = i + 1; j < tool_.marker_count; ++j) {
      const CandidateSet& from = allowed[static_cast<std::size_t>(j)];
      const CandidateSet& match = matches_.of(i, j, a);
      CandidateSet& to = next[static_cast<std::size_t>(j)];
      for (int w = 0; w < candidates_.words; ++w) {
        const auto iw = static_cast<std::size_t>(w);
        to.word[iw] = from.word[iw] & match.word[iw];
      }
    }
    return next;
  }

  // Fits a complete labeling and keeps it if it is among the best.
  void judge(int target) {
    Labeling labeling;
    labeling.count = target;
    std::array<Vector3, k_markers_per_tool_max> model;
    std::array<Vector3, k_markers_per_tool_max> measured;
    std::size_t n = 0;
    for (std::size_t j = 0; j < chosen_.size(); ++j) {
      labeling.marker[j] = -1;
      if (chosen_[j] < 0) continue;
      const auto a = static_cast<std::size_t>(chosen_[j]);
      labeling.marker[j] = candidates_.marker[a];
      model[n] = tool_.markers_m[j];
      measured[n] = candidates_.point_m[a];
      ++n;
    }
    for (int k = 0; k < found_.count; ++k) {
      if (found_.items[static_cast<std::size_t>(k)].marker == labeling.marker) return;
    }
    if (fits_ >= settings_.fits_max) full_ = true;
    if (full_) return;
    ++fits_;
    const RigidFit fit = fit_rigid({model.data(), n}, {measured.data(), n});
    if (fit.reason != Reason::none) return;
    if (!(fit.rms_m <= settings_.max_rms_m)) {
      rejected_a_fit_ = true;
      return;
    }
    labeling.rms_m = fit.rms_m;
    labeling.T_camera_tool = fit.transform;
    keep(labeling);
  }

  void keep(const Labeling& labeling) {
    int place = found_.count;
    while (place > 0 &&
           stands_before(labeling, found_.items[static_cast<std::size_t>(place - 1)])) {
      --place;
    }
    if (place == k_labelings_max) return;
    found_.count = std::min(found_.count + 1, k_labelings_max);
    for (int k = found_.count - 1; k > place; --k) {
      found_.items[static_cast<std::size_t>(k)] = found_.items[static_cast<std::size_t>(k - 1)];
    }
    found_.items[static_cast<std::size_t>(place)] = labeling;
  }

  const Tool& tool_;
  const CorrespondSettings& settings_;
  const Candidates& candidates_;
  const PairMatches& matches_;
  Labelings& found_;
  std::array<std::int16_t, k_markers_per_tool_max> chosen_{};
  int fits_ = 0;
  bool full_ = false;
  bool rejected_a_fit_ = false;
};

// Most markers first; once some are found, only fewer_kept steps further down.
void run_levels(Search& search, const Allowed& allowed, const CorrespondSettings& settings,
                int most, int least, const Labelings& found) {
  for (int target = most; target >= least && !search.full(); --target) {
    const int best = found.count > 0 ? found.items[0].count : 0;
    if (target < best - settings.fewer_kept) return;
    search.run(allowed, target);
  }
}

Allowed near_prediction(const Tool& tool, const Candidates& candidates, const Pose& prior,
                        double gate_m) {
  Allowed allowed{};
  for (int j = 0; j < tool.marker_count; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    const Vector3 place = prior * tool.markers_m[slot];
    for (int a = 0; a < candidates.count; ++a) {
      const Vector3 away = candidates.point_m[static_cast<std::size_t>(a)] - place;
      if (away.squaredNorm() <= gate_m * gate_m) allowed[slot].insert(a);
    }
  }
  return allowed;
}

bool agrees(const Labeling& labeling, const Tool& tool, const Pose& prior, double gate_m) {
  for (int j = 0; j < tool.marker_count; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    if (labeling.marker[slot] < 0) continue;
    const Vector3 away =
        labeling.T_camera_tool * tool.markers_m[slot] - prior * tool.markers_m[slot];
    if (!(away.squaredNorm() <= gate_m * gate_m)) return false;
  }
  return true;
}

// Rule 3 of the header.
void prefer_predicted(Labelings& found, const Tool& tool, const CorrespondSettings& settings,
                      const Pose& prior) {
  if (found.count == 0) return;
  const Labeling best = found.items[0];
  const double slack = 9 * settings.range_sigma_m * settings.range_sigma_m / best.count;
  for (int k = 0; k < found.count; ++k) {
    const Labeling candidate = found.items[static_cast<std::size_t>(k)];
    if (candidate.count != best.count) return;
    if (!(candidate.rms_m * candidate.rms_m - best.rms_m * best.rms_m <= slack)) return;
    if (!agrees(candidate, tool, prior, settings.prior_gate_m)) continue;
    for (int m = k; m > 0; --m) {
      found.items[static_cast<std::size_t>(m)] = found.items[static_cast<std::size_t>(m - 1)];
    }
    found.items[0] = candidate;
    return;
  }
}

}  // namespace

void propose_labelings(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                       const Pose* prior_T_camera_tool, Labelings& labelings) noexcept {
  labelings.count = 0;
  labelings.hypotheses = 0;
  labelings.reason = Reason::none;
  if (tool.marker_count < 3 || tool.marker_count > k_markers_per_tool_max ||
      !(tool.distance_m[0][1] > 0)) {
    labelings.reason = Reason::not_prepared;
    return;
  }
  Candidates candidates;
  select_candidates(markers, tool, settings, candidates);
  const int most = std::min(tool.marker_count, candidates.count);
  const int least_alone =
      std::clamp(settings.min_markers_without_prior, 3, std::max(3, tool.marker_count));
  const int least_predicted = std::clamp(settings.min_markers_with_prior, 3, tool.marker_count);
  if (most <
      (prior_T_camera_tool != nullptr ? std::min(least_alone, least_predicted) : least_alone)) {
    labelings.reason = Reason::too_few_markers;
    return;
  }
  PairMatches matches;
  match_pairs(candidates, tool, settings, matches);
  Search search(tool, settings, candidates, matches, labelings);
  if (prior_T_camera_tool != nullptr) {
    run_levels(search,
               near_prediction(tool, candidates, *prior_T_camera_tool, settings.prior_gate_m),
               settings, most, least_predicted, labelings);
  }
  Allowed all{};
  for (int j = 0; j < tool.marker_count; ++j) {
    for (int a = 0; a < candidates.count; ++a) all[static_cast<std::size_t>(j)].insert(a);
  }
  run_levels(search, all, settings, most, least_alone, labelings);
  if (prior_T_camera_tool != nullptr) {
    prefer_predicted(labelings, tool, settings, *prior_T_camera_tool);
  }
  if (search.full()) {
    labelings.reason = Reason::search_full;
  } else if (labelings.count == 0) {
    labelings.reason = search.rejected_a_fit() ? Reason::bad_fit : Reason::no_labeling;
  }
}

}  // namespace glint

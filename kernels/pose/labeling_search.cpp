#include "kernels/pose/labeling_search.hpp"

#include <algorithm>
#include <bit>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

bool precedes(const Labeling& a, const Labeling& b) {
  if (a.count != b.count) return a.count > b.count;
  if (a.rms_m != b.rms_m) return a.rms_m < b.rms_m;
  return a.marker < b.marker;
}

}  // namespace

LabelingSearch::LabelingSearch(const Tool& tool, const CorrespondSettings& settings,
                               const Candidates& candidates, const PairMatches& matches,
                               Labelings& found) noexcept
    : tool_(tool),
      settings_(settings),
      candidates_(candidates),
      matches_(matches),
      found_(found),
      partners_(matches) {
  chosen_.fill(-1);
}

bool LabelingSearch::use_steps(int steps) {
  if (work_.steps + steps > settings_.search_steps_max) full_ = true;
  if (!full_) work_.steps += steps;
  return !full_;
}

std::uint64_t LabelingSearch::word_at(int level, int i, int w) const {
  return sets_[level].word[i * candidates_.words + w];
}

// The next candidate for marker i, or -1.
int LabelingSearch::next_candidate(int i) {
  MarkerState& state = states_[i];
  while (state.rest == 0) {
    if (++state.word >= candidates_.words) return -1;
    state.rest = word_at(state.assigned, i, state.word);
  }
  const int a = state.word * 64 + std::countr_zero(state.rest);
  state.rest &= state.rest - 1;
  return a;
}

// Computes the next level's sets. Returns how many later markers may still be assigned.
int LabelingSearch::narrow(int level, int i, int a) {
  const std::uint64_t* const row = &matches_.word[matches_.set_of(i, a, 0)];
  const std::uint64_t* const from = sets_[level].word.data();
  std::uint64_t* const to = sets_[level + 1].word.data();
  const int words = candidates_.words;
  work_.words_narrowed += matches_.words_a_row();
  int assignable = 0;
  if (words == 1) {  // the usual case, without the inner loop
    for (int j = i + 1; j < tool_.marker_count; ++j) {
      const std::uint64_t both = from[j] & row[j];
      to[j] = both;
      assignable += both != 0 ? 1 : 0;
    }
    return assignable;
  }
  for (int j = i + 1, at = (i + 1) * words; j < tool_.marker_count; ++j) {
    std::uint64_t any = 0;
    for (int w = 0; w < words; ++w, ++at) {
      to[at] = from[at] & row[at];
      any |= to[at];
    }
    assignable += any != 0 ? 1 : 0;
  }
  return assignable;
}

void LabelingSearch::run(const CandidateSets& allowed, int target) noexcept {
  const int markers = tool_.marker_count;
  const int words = candidates_.words;
  MarkerState& root = states_[0];
  root = {};
  for (int j = 0; j < markers; ++j) {
    std::uint64_t any = 0;
    for (int w = 0; w < words; ++w) {
      const std::uint64_t viable = allowed[j].word[w] & partners_.with_at_least(target - 1, j, w);
      sets_[0].word[j * words + w] = viable;
      any |= viable;
    }
    root.assignable += any != 0 ? 1 : 0;
  }
  if (root.assignable < target) return;
  root.rest = word_at(0, 0, 0);
  // Each iteration tries one assignment or goes back by one marker. An assignment is a step, so the
  // step budget ends the loop.
  for (int i = 0; i >= 0;) {
    MarkerState& state = states_[i];
    MarkerState& next = states_[i + 1];
    if (state.skipped) {
      --i;
      continue;
    }
    const int a = next_candidate(i);
    if (a < 0) {
      chosen_[i] = -1;
      state.skipped = true;
      next.assigned = state.assigned;
      std::uint64_t any = 0;
      for (int w = 0; w < words; ++w) any |= word_at(state.assigned, i, w);
      next.assignable = state.assignable - (any != 0 ? 1 : 0);
    } else {
      if (!use_steps(1)) break;
      ++found_.hypotheses;
      chosen_[i] = static_cast<std::int16_t>(a);
      next.assigned = state.assigned + 1;
      next.assignable = narrow(state.assigned, i, a);
    }
    if (next.assigned == target) {
      fit_and_keep(target);
      if (full_) break;
    } else if (i + 1 < markers && next.assigned + next.assignable >= target) {
      ++i;
      next.word = 0;
      next.rest = word_at(next.assigned, i, 0);
      next.skipped = false;
    }
  }
  chosen_.fill(-1);
}

// Fits a complete labeling and keeps it if it is among the best.
void LabelingSearch::fit_and_keep(int target) {
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
    if (found_.items[k].marker == labeling.marker) return;
  }
  if (!use_steps(k_fit_steps)) return;
  const RigidFit fit = fit_rigid({model.data(), n}, {measured.data(), n});
  if (fit.reason != Reason::none) return;
  if (!(fit.rms_m <= settings_.max_rms_m)) {
    rejected_a_fit_ = true;
    return;
  }
  labeling.rms_m = fit.rms_m;
  labeling.T_camera_tool = fit.transform;
  insert(labeling);
}

void LabelingSearch::insert(const Labeling& labeling) {
  int slot = found_.count;
  while (slot > 0 && precedes(labeling, found_.items[slot - 1])) --slot;
  if (slot == k_labelings_max) return;
  found_.count = std::min(found_.count + 1, k_labelings_max);
  for (int k = found_.count - 1; k > slot; --k) found_.items[k] = found_.items[k - 1];
  found_.items[slot] = labeling;
}

}  // namespace glint

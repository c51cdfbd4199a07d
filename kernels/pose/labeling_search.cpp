#include "kernels/pose/labeling_search.hpp"

#include <algorithm>
#include <bit>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

bool stands_before(const Labeling& a, const Labeling& b) {
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

bool LabelingSearch::spend(int steps) {
  if (work_.steps + steps > settings_.search_steps_max) full_ = true;
  if (!full_) work_.steps += steps;
  return !full_;
}

std::uint64_t LabelingSearch::word_at(int level, int i, int w) const {
  return sets_[level].word[i * candidates_.words + w];
}

// The next candidate for marker i, or -1.
int LabelingSearch::next_candidate(int i) {
  Place& place = place_[i];
  while (place.rest == 0) {
    if (++place.word >= candidates_.words) return -1;
    place.rest = word_at(place.named, i, place.word);
  }
  const int a = place.word * 64 + std::countr_zero(place.rest);
  place.rest &= place.rest - 1;
  return a;
}

// Computes the next level's sets. Returns how many later markers may still be assigned.
int LabelingSearch::narrow(int level, int i, int a) {
  const std::uint64_t* const row = &matches_.word[matches_.set_of(i, a, 0)];
  const std::uint64_t* const from = sets_[level].word.data();
  std::uint64_t* const to = sets_[level + 1].word.data();
  const int words = candidates_.words;
  work_.words_narrowed += matches_.words_a_row();
  int possible = 0;
  if (words == 1) {  // the usual case, without the inner loop
    for (int j = i + 1; j < tool_.marker_count; ++j) {
      const std::uint64_t both = from[j] & row[j];
      to[j] = both;
      possible += both != 0 ? 1 : 0;
    }
    return possible;
  }
  for (int j = i + 1, at = (i + 1) * words; j < tool_.marker_count; ++j) {
    std::uint64_t any = 0;
    for (int w = 0; w < words; ++w, ++at) {
      to[at] = from[at] & row[at];
      any |= to[at];
    }
    possible += any != 0 ? 1 : 0;
  }
  return possible;
}

void LabelingSearch::run(const CandidateSets& allowed, int target) noexcept {
  const int markers = tool_.marker_count;
  const int words = candidates_.words;
  Place& root = place_[0];
  root = {};
  for (int j = 0; j < markers; ++j) {
    std::uint64_t any = 0;
    for (int w = 0; w < words; ++w) {
      const std::uint64_t viable = allowed[j].word[w] & partners_.with_at_least(target - 1, j, w);
      sets_[0].word[j * words + w] = viable;
      any |= viable;
    }
    root.possible += any != 0 ? 1 : 0;
  }
  if (root.possible < target) return;
  root.rest = word_at(0, 0, 0);
  // Each iteration tries one assignment or goes back by one marker. An assignment is a step, so the
  // step budget ends the loop.
  for (int i = 0; i >= 0;) {
    Place& place = place_[i];
    Place& next = place_[i + 1];
    if (place.left_out) {
      --i;
      continue;
    }
    const int a = next_candidate(i);
    if (a < 0) {
      chosen_[i] = -1;
      place.left_out = true;
      next.named = place.named;
      std::uint64_t any = 0;
      for (int w = 0; w < words; ++w) any |= word_at(place.named, i, w);
      next.possible = place.possible - (any != 0 ? 1 : 0);
    } else {
      if (!spend(1)) break;
      ++found_.hypotheses;
      chosen_[i] = static_cast<std::int16_t>(a);
      next.named = place.named + 1;
      next.possible = narrow(place.named, i, a);
    }
    if (next.named == target) {
      judge(target);
      if (full_) break;
    } else if (i + 1 < markers && next.named + next.possible >= target) {
      ++i;
      next.word = 0;
      next.rest = word_at(next.named, i, 0);
      next.left_out = false;
    }
  }
  chosen_.fill(-1);
}

// Fits a complete labeling and keeps it if it is among the best.
void LabelingSearch::judge(int target) {
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
  if (!spend(k_fit_steps)) return;
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

void LabelingSearch::keep(const Labeling& labeling) {
  int place = found_.count;
  while (place > 0 && stands_before(labeling, found_.items[place - 1])) --place;
  if (place == k_labelings_max) return;
  found_.count = std::min(found_.count + 1, k_labelings_max);
  for (int k = found_.count - 1; k > place; --k) found_.items[k] = found_.items[k - 1];
  found_.items[place] = labeling;
}

}  // namespace glint

// Depth-first search for labelings in the table of pair matches; keeps the best ones.
//
// What:     assigns a candidate to one tool marker after another. Each assignment restricts the
//           candidates of later markers to those at the right distance. Labelings of the target
//           size are tested by the rigid fit. A candidate with too few partners for that size is
//           never assigned.
// Cost:     one step for each assignment tried, which intersects the sets of all later markers, and
//           k_fit_steps for each fit.
// Worst:    the step budget is exhausted: `full`, and the labelings found so far remain.
// Accuracy: complete within the step budget.
// Source:   clique search in the association graph by intersecting compatible sets (Bron and
//           Kerbosch 1973), bounded in depth; no recursion, so that the stack size is known.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/labeling.hpp"
#include "kernels/pose/pair_matches.hpp"
#include "kernels/pose/partner_counts.hpp"

namespace glint {

struct SearchWork {
  int steps = 0;
  int words_narrowed = 0;
};

class LabelingSearch {
 public:
  LabelingSearch(const Tool& tool, const CorrespondSettings& settings, const Candidates& candidates,
                 const PairMatches& matches, Labelings& found) noexcept GLINT_NONBLOCKING;

  // Tries all labelings with `target` markers within `allowed`.
  void run(const CandidateSets& allowed, int target) noexcept GLINT_NONBLOCKING;

  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] bool rejected_a_fit() const { return rejected_a_fit_; }
  [[nodiscard]] const SearchWork& work() const { return work_; }

 private:
  // Candidate sets after some assignments, marker by marker, `words` words each.
  struct Sets {
    std::array<std::uint64_t, k_markers_per_tool_max*(k_blobs_max / 64)> word;
  };
  // State of the search at one tool marker.
  struct MarkerState {
    int assigned = 0;        // markers assigned before this one: the level of the sets in force
    int assignable = 0;      // markers from this one on that may still be assigned
    int word = 0;            // index of the set's current word
    std::uint64_t rest = 0;  // candidates left in that word
    bool skipped = false;    // every candidate was tried; now the marker stays unassigned
  };

  [[nodiscard]] bool use_steps(int steps);
  [[nodiscard]] std::uint64_t word_at(int level, int i, int w) const;
  [[nodiscard]] int next_candidate(int i);
  [[nodiscard]] int narrow(int level, int i, int a);
  void fit_and_keep(int target);
  void insert(const Labeling& labeling);

  const Tool& tool_;
  const CorrespondSettings& settings_;
  const Candidates& candidates_;
  const PairMatches& matches_;
  Labelings& found_;
  PartnerCounts partners_;
  std::array<Sets, k_markers_per_tool_max + 1> sets_;
  std::array<MarkerState, k_markers_per_tool_max + 1> states_;
  std::array<std::int16_t, k_markers_per_tool_max> chosen_{};
  SearchWork work_;
  bool full_ = false;
  bool rejected_a_fit_ = false;
};

}  // namespace glint

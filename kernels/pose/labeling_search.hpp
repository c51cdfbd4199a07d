// Walks the table of pair matches for ways to name the tool's markers, and keeps the best.
//
// What:     names tool marker after tool marker; each name narrows what the later ones may still be
//           to those at the right distance. Where enough are named, the rigid fit judges. Who has
//           too few partners for a labeling of the wanted size is never named.
// Cost:     one step for each name tried, in which the sets of all markers are narrowed, and
//           k_fit_steps for each fit.
// Worst:    the steps are used up: `full`, and what was found so far stands.
// Accuracy: complete within the steps.
// Source:   clique search in the association graph by intersecting compatible sets (Bron and
//           Kerbosch 1973), bounded in depth; no recursion, so that the stack is known.
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
  // The sets after some names, marker by marker, `words` words each.
  struct Sets {
    std::array<std::uint64_t, k_markers_per_tool_max*(k_blobs_max / 64)> word;
  };
  // Where the walk stands at one tool marker.
  struct Place {
    int named = 0;           // markers named before this one, and so the level of sets in force
    int possible = 0;        // later ones, this one included, that may still be named
    int word = 0;            // the set's word that is being read ...
    std::uint64_t rest = 0;  // ... and what is left of it
    bool left_out = false;   // every candidate was tried; now the marker is left out
  };

  [[nodiscard]] bool spend(int steps);
  [[nodiscard]] std::uint64_t word_at(int level, int i, int w) const;
  [[nodiscard]] int next_candidate(int i);
  [[nodiscard]] int narrow(int level, int i, int a);
  void judge(int target);
  void keep(const Labeling& labeling);

  const Tool& tool_;
  const CorrespondSettings& settings_;
  const Candidates& candidates_;
  const PairMatches& matches_;
  Labelings& found_;
  PartnerCounts partners_;
  std::array<Sets, k_markers_per_tool_max + 1> sets_;
  std::array<Place, k_markers_per_tool_max + 1> place_;
  std::array<std::int16_t, k_markers_per_tool_max> chosen_{};
  SearchWork work_;
  bool full_ = false;
  bool rejected_a_fit_ = false;
};

}  // namespace glint

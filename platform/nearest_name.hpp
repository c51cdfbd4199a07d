// Spelling suggestion for error messages: the known name nearest to a misspelt one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Restricted Damerau-Levenshtein distance: insertions, deletions, substitutions and transpositions
// of adjacent letters (Boytsov 2011, section 2.2.1). Cost: the product of the lengths.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t differs = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + differs});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

// Returns the first of the nearest names; "" if more than a third of the letters (at least one)
// differ, or if the text is longer than k_text_max.
[[nodiscard]] inline std::string nearest_name(std::string_view text,
                                              const std::vector<std::string>& known) {
  constexpr std::size_t k_text_max = 64;
  if (text.empty() || text.size() > k_text_max) return "";
  std::size_t distance_max = std::max<std::size_t>(1, text.size() / 3);
  std::string nearest;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(text, name);
    if (distance > distance_max || (!nearest.empty() && distance == distance_max)) continue;
    distance_max = distance;
    nearest = name;
  }
  return nearest;
}

// Returns "; did you mean NAME?", or "" if no name is near enough.
[[nodiscard]] inline std::string nearest_name_text(std::string_view text,
                                                   const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(text, known);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace glint

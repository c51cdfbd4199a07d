// Sorting network for up to 64 doubles; data independent.
//
// What:     ascending. The values form rows of two; both columns are sorted at once, then merged.
// Cost:     for n values, padded to 2 r, r the next of 4, 8, 16, 32: r / 4 (lg^2 r - lg r + 4) - 1
//           exchanges of rows, then 2 r + r / 2 lg r more.
// Worst:    one value more than 8, 16 or 32.
// Accuracy: exact; requires a total order, so no NaN.
// Source:   Knuth, "The Art of Computer Programming", vol. 3, section 5.2.2, algorithm M; Batcher,
//           AFIPS 32 (1968): the smaller halves of two sorted lists, one reversed, are bitonic.
#pragma once

#include <limits>

#include "kernels/two_doubles.hpp"

namespace glint {

namespace detail {

// Row a receives the smaller, row b the larger value of each column.
inline void exchange(TwoDoubles& a, TwoDoubles& b) {
  const TwoDoubles low = minimum(a, b), high = maximum(a, b);
  a = low;
  b = high;
}

// Exchanges of algorithm M for one p and d, then the following ones: each pass has constant bounds.
template <int rows, int p = rows / 2, int q = rows / 2, int r = 0, int d = p>
[[gnu::always_inline]] inline void sort_columns(TwoDoubles* row) {
  for (int from = r; from < rows - d; from += 2 * p) {
    for (int i = from; i < from + p; ++i) exchange(row[i], row[i + d]);
  }
  if constexpr (q != p) {
    sort_columns<rows, p, q / 2, p, q - p>(row);
  } else if constexpr (p > 1) {
    sort_columns<rows, p / 2>(row);
  }
}

template <int rows, int d = rows / 2>
[[gnu::always_inline]] inline void sort_bitonic(TwoDoubles* row) {
  for (int from = 0; from < rows; from += 2 * d) {
    for (int i = from; i < from + d; ++i) exchange(row[i], row[i + d]);
  }
  if constexpr (d > 1) sort_bitonic<rows, d / 2>(row);
}

// Moves the smaller half of two sorted columns to the first, the larger half to the second.
template <int rows>
void merge_columns(TwoDoubles* row) {
  for (int i = 0; i < rows / 2; ++i) {
    const int last = rows - 1 - i;
    const TwoDoubles a = row[i], b = row[last];
    const TwoDoubles a_reversed{a[1], a[0]}, b_reversed{b[1], b[0]};
    const TwoDoubles low = minimum(a, b_reversed), high = maximum(a, b_reversed);
    const TwoDoubles low_too = minimum(b, a_reversed), high_too = maximum(b, a_reversed);
    row[i] = TwoDoubles{low[0], high[1]};
    row[last] = TwoDoubles{low_too[0], high_too[1]};
  }
  sort_bitonic<rows>(row);
}

template <int rows>
void sort_rows(double* values, int count) {
  TwoDoubles row[rows];
  for (int i = count; i < 2 * rows; ++i) values[i] = std::numeric_limits<double>::infinity();
  for (int i = 0; i < rows; ++i) row[i] = load_two(values + 2 * i);
  sort_columns<rows>(row);
  merge_columns<rows>(row);
  for (int i = 0; i < rows; i += 2) {
    store_two(TwoDoubles{row[i][0], row[i + 1][0]}, values + i);
    store_two(TwoDoubles{row[i][1], row[i + 1][1]}, values + rows + i);
  }
}

}  // namespace detail

inline constexpr int k_sort_pairs_max = 64;

// Sorts the first `count` values; count <= k_sort_pairs_max, the size that `values` must have.
// Overwrites some values behind `count` with infinity.
inline void sort_pairs(double* values, int count) noexcept {
  if (count <= 8) return detail::sort_rows<4>(values, count);
  if (count <= 16) return detail::sort_rows<8>(values, count);
  if (count <= 32) return detail::sort_rows<16>(values, count);
  detail::sort_rows<32>(values, count);
}

}  // namespace glint

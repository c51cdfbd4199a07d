// Sorts a few values in a number of steps that depends on how many there are, and on nothing else.
//
// What:     ascending by <, equal values in their order.
// Cost:     count x ceil(log2 count) steps, each the same: a comparison chooses without a branch.
// Worst:    none is worse than another.
// Accuracy: exact; values must have a total order, so no NaN.
// Source:   Knuth, "The Art of Computer Programming", vol. 3, section 5.2.4, straight merge sort.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace glint {

// Sorts the first `count` values, with `spare` to write to in between.
template <class T, std::size_t N>
void merge_sort(std::array<T, N>& values, std::array<T, N>& spare, int count) noexcept {
  T* from = values.data();
  T* to = spare.data();
  for (int width = 1; width < count; width *= 2) {
    for (int begin = 0; begin < count; begin += 2 * width) {
      const int middle = std::min(begin + width, count), end = std::min(begin + 2 * width, count);
      int left = begin, right = middle, out = begin;
      while (left < middle && right < end) {
        const T a = from[left], b = from[right];
        const int take_right = b < a ? 1 : 0;
        to[out++] = b < a ? b : a;
        right += take_right;
        left += 1 - take_right;
      }
      while (left < middle) to[out++] = from[left++];
      while (right < end) to[out++] = from[right++];
    }
    std::swap(from, to);
  }
  if (from != values.data()) std::copy_n(from, count, values.data());
}

}  // namespace glint

// Branch-free merge sort of a short array. The number of steps depends on the count only.
//
// What:     ascending by <; equal values in any order.
// Cost:     count x ceil(log2 count) equal steps: a comparison selects without a branch; groups of
//           four by a network of five exchanges.
// Worst:    data independent.
// Accuracy: exact; requires a total order, so no NaN.
// Source:   Knuth, "The Art of Computer Programming", vol. 3, section 5.2.4, straight merge sort.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace glint {

// Sorts values[0] to values[3] by a sorting network.
template <class T>
void sort_four(T* values) noexcept {
  const auto exchange = [](T& a, T& b) {
    const T low = b < a ? b : a, high = b < a ? a : b;
    a = low;
    b = high;
  };
  T a = values[0], b = values[1], c = values[2], d = values[3];
  exchange(a, b);
  exchange(c, d);
  exchange(a, c);
  exchange(b, d);
  exchange(b, c);
  values[0] = a, values[1] = b, values[2] = c, values[3] = d;
}

// Sorts the first `count` values; overwrites `scratch`.
template <class T, std::size_t N>
void merge_sort(std::array<T, N>& values, std::array<T, N>& scratch, int count) noexcept {
  T* from = values.data();
  T* to = scratch.data();
  const int fours = count >= 8 ? count / 4 * 4 : 0;
  for (int begin = 0; begin < fours; begin += 4) sort_four(from + begin);
  // Insertion sort: the remainder after the groups of four, or the whole array if count < 8.
  for (int i = fours + 1; i < count; ++i) {
    for (int j = i; j > fours && from[j] < from[j - 1]; --j) std::swap(from[j], from[j - 1]);
  }
  for (int width = fours == 0 ? count : 4; width < count; width *= 2) {
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

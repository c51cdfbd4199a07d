// Port types of the dataflow language: graph inputs and outputs, and the parameter types by which a
// node declares what it reads and writes.
//
//   const T&            this activation's token
//   T&                  the token that this node writes completely at every activation
//   const Previous<T>&  the last activation's token (T{} before the first)
//   const Latest<T>&    the newest version from another rate group (graph/latest.hpp)
//   const Parts<T, N>&  the output of the N copies of a Split, in index order
//   Partition               index of this copy and number of copies; only under Split
#pragma once

#include <cassert>
#include <cstddef>

namespace glint::graph {

// Alignment that keeps data written by two cores on separate cache lines: 64 bytes on x86-64 and on
// the arm64 companion computers.
inline constexpr std::size_t k_cache_line = 64;

// Tokens that the caller writes before an activation, and tokens that it may read after it.
template <class... T>
struct Inputs {};
template <class... T>
struct Outputs {};

// The last activation's token: explicit feedback.
template <class T>
class Previous {
 public:
  explicit Previous(const T& value) noexcept : value_(&value) {}
  explicit Previous(const T&& value) = delete;
  [[nodiscard]] const T& value() const noexcept { return *value_; }

 private:
  const T* value_;
};

// Partition of the data that a copy processes: index of count, 0 <= index < count.
struct Partition {
  int index = 0;
  int count = 1;
};

// N copies of a node that may run in parallel. Copy i writes part i of each of its outputs. N is a
// property of the graph, independent of the number of workers: the result depends on it.
template <class Node, int N>
struct Split {
  static_assert(N >= 1, "a split needs at least one copy");
};

// The parts of a token, in index order.
template <class T, int N>
class Parts {
 public:
  static_assert(N >= 1, "a split has at least one part");
  [[nodiscard]] const T& operator[](int index) const noexcept {
    assert(index >= 0 && index < N);
    return cells_[index].value;
  }
  [[nodiscard]] T& operator[](int index) noexcept {
    assert(index >= 0 && index < N);
    return cells_[index].value;
  }
  [[nodiscard]] static constexpr int size() noexcept { return N; }

 private:
  struct alignas(k_cache_line) Cell {
    T value{};
  };
  Cell cells_[N]{};
};

}  // namespace glint::graph
